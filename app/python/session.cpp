// SPDX-License-Identifier: MIT
// A live session: a gripper's measurement in, forces and the whole posed hand out.
#include "device/session/session.h"
#include "device/session/reach.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string_view>
#include <thread>

#include "app/python/bind.h"
#include "app/python/scene.h"
#include "base/text/error.h"
#include "core/vectors.h"
#include "device/session/hand_view.h"

namespace py = pybind11;

namespace wholehand {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Real numbers of any kind as doubles. Refuses texts, truth values and complex numbers, which NumPy would convert, and masked arrays, whose masks it
// would drop.
Numbers finite_doubles(const py::object& values, const char* name) {
  const py::array array = py::array::ensure(values);
  if (!array) throw usage_error(fmt::format("session: the {} is no array of numbers", name));
  const bool is_masked = std::string_view(Py_TYPE(values.ptr())->tp_name) == "MaskedArray";
  if (is_masked || std::string_view("fiu").find(array.dtype().kind()) == std::string_view::npos)
    throw usage_error(fmt::format("session: the {} is {}; allowed: real numbers", name,
                                  is_masked ? "a masked array" : std::string(py::str(array.dtype()))));
  return Numbers::ensure(array);
}

template <std::size_t N>
Numbers array_of(const std::array<double, N>& values) {
  return Numbers({static_cast<py::ssize_t>(N)}, values.data());
}

Numbers matrix_of(const Rotation& rotation) { return Numbers({3, 3}, rotation.data()); }

template <std::size_t N>
Numbers points_of(const std::array<Triple, N>& points) {
  return Numbers({static_cast<py::ssize_t>(N), py::ssize_t{3}}, points[0].data());
}

// A complete copy of a step's results, since the session may have continued.
struct Step {
  std::shared_ptr<const device::Session> session;
  device::Tick tick;
  device::VesselPoses poses;

  device::HandView hand() const { return device::hand_view(session->live(), tick, poses); }
  // The whole hand's results; NaN if nothing is held.
  double effort() const {
    const std::optional<device::HandHold> hold = hand().hold;
    return hold ? hold->effort : device::Tick::NONE;
  }
  // A number of each vessel.
  Numbers of_vessels(const std::array<double, device::LIVE_VESSELS>& values) const {
    return Numbers(static_cast<py::ssize_t>(session->live().scene.vessels.size()), values.data());
  }
  py::object vessel() const {
    if (tick.vessel < 0) return py::none();
    return py::str(session->live().scene.vessels[static_cast<std::size_t>(tick.vessel)].name);
  }
};

// The gaps between which the hand itself opens and closes: the default for a gripper that gives none.
std::array<double, 2> gap_range(const Scene& scene, const std::optional<std::array<double, 2>>& given) {
  if (given) return *given;
  if (scene.device.has_gap) return scene.device.gap;
  const device::LiveScene live(scene);
  return {live.hand.scale * live.hand.gap_closed, live.hand.scale * live.hand.gap_open};
}

class SessionHandle {
 public:
  SessionHandle(SceneHandle& scene, const std::optional<std::array<double, 2>>& gap) {
    for (const double one : gap.value_or(std::array<double, 2>{}))
      if (!std::isfinite(one)) throw usage_error("session: a gap of the gripper is not finite");
    session_ = std::make_shared<device::Session>(scene.whole(), gap_range(scene.whole(), gap));
    step_.session = session_;
  }

  // Throws Error (usage): closed, another thread's, a measurement that no gripper gives. Then the session stays as it was.
  const Step& step(const py::object& position, const py::object& rotation, double gap, std::uint32_t buttons,
                   std::optional<std::int64_t> tick) {
    enter();
    const device::GripperState state = state_of(position, rotation, gap, buttons);
    const std::int64_t number = tick.value_or(last_ + 1);  // fits: last_ is device::LAST_TICK at most
    if (number > device::LAST_TICK)
      throw usage_error(fmt::format("session: tick {}; allowed: up to {}", number, device::LAST_TICK));
    if (number <= last_) throw usage_error(fmt::format("session: tick {} after {}; allowed: a greater one", number, last_));
    last_ = number;
    session_->step(state, number, step_.tick);
    step_.poses = session_->poses();
    return step_;
  }

  // The last step.
  const Step& last() {
    enter();
    if (last_ < 0) throw usage_error("session: there is no hand before the first step");
    return step_;
  }

  void close() { session_.reset(); }
  bool is_closed() const { return !session_; }
  std::array<double, 2> gap() const { return is_closed() ? std::array<double, 2>{} : session_->workspace().device_gap(); }
  double period() const { return is_closed() ? 0 : 1 / session_->live().scene.live.rate; }

 private:
  // A session belongs to the thread of its first step: two threads in turns would each take the other's hand for its own.
  void enter() {
    if (is_closed()) throw usage_error("session: it is closed");
    const std::thread::id here = std::this_thread::get_id();
    if (owner_ == std::thread::id()) owner_ = here;
    if (owner_ != here) throw usage_error("session: it belongs to the thread of its first step, and this is another one");
  }

  static device::GripperState state_of(const py::object& given_position, const py::object& given_rotation, double gap,
                                       std::uint32_t buttons) {
    const Numbers position = finite_doubles(given_position, "position");
    if (position.ndim() != 1 || position.shape(0) != 3) throw usage_error("session: the position has another shape than (3,)");
    device::GripperState state;
    std::copy_n(position.data(), 3, state.position.begin());
    if (!given_rotation.is_none()) {
      const Numbers rotation = finite_doubles(given_rotation, "rotation");
      if (rotation.ndim() != 2 || rotation.shape(0) != 3 || rotation.shape(1) != 3)
        throw usage_error("session: the rotation has another shape than (3, 3)");
      std::copy_n(rotation.data(), 9, state.rotation.begin());
    }
    state.gap = gap;
    state.buttons = buttons;
    if (!device::is_finite(state)) throw usage_error("session: the measurement has a number that is not finite");
    if (!device::is_in_reach(state))
      throw usage_error(fmt::format("session: the measurement is out of reach; allowed: a position up to {} m, a gap up to {} m",
                                    device::FURTHEST_POSITION, device::WIDEST_GAP));
    if (!is_rotation(state.rotation, device::ROTATION_TOLERANCE))
      throw usage_error("session: the rotation is not a rotation; allowed: unit columns at right angles, right-handed");
    return state;
  }

  std::shared_ptr<device::Session> session_;
  Step step_;
  std::int64_t last_ = -1;
  std::thread::id owner_;
};

std::string step_text(const Step& step) {
  const std::string state = device::SESSION_STATE_NAMES[static_cast<std::size_t>(step.tick.state)];
  const int vessel = step.tick.vessel;
  const std::string of = vessel < 0 ? "" : " " + step.session->live().scene.vessels[static_cast<std::size_t>(vessel)].name;
  return fmt::format("<Step {}: {}{}, grip force {:.3g} N>", step.tick.number, state, of, step.tick.wanted.grip);
}

constexpr auto number = [](auto device::Tick::*member) { return [member](const Step& step) { return step.tick.*member; }; };
constexpr auto triple = [](auto device::Tick::*member) {
  return [member](const Step& step) { return array_of(step.tick.*member); };
};

// Forces, and how the hand holds.
void bind_hold(py::class_<Step>& type) {
  type.def_property_readonly(
          "arm_force", [](const Step& step) { return array_of(step.tick.wanted.arm); },
          "What the arm is to render, N, device frame, shape (3,). The caller limits it to what the gripper can do.")
      .def_property_readonly(
          "grip_force", [](const Step& step) { return step.tick.wanted.grip; }, "On each finger, N; positive opens.")
      .def_property_readonly("normal_force", number(&device::Tick::normal_force), "Normal force, N.")
      .def_property_readonly("feedback_force", number(&device::Tick::feedback), "The same within [0, F_max], N.")
      .def_property_readonly("user_force", number(&device::Tick::user_force),
                             "The user's grip force, N: the feedback less what the torque added since the grasp.")
      .def_property_readonly("hold_force", number(&device::Tick::hold_force),
                             "With what each of two tips must press to hold the vessel, N; NaN: nothing is held.")
      .def_property_readonly(
          "effort", &Step::effort,
          "Least share of the hand's strength that holds the vessel, with all contacts; inf: no force holds it;\n"
          "NaN: nothing is held, or [strength] says efforts = false.")
      .def_property_readonly("safety_margin", number(&device::Tick::safety_margin),
                             "The user's grip force less what holding takes now, N; NaN: nothing is held, or [live] slide is off.")
      .def_property_readonly("slip_distance", number(&device::Tick::slip_distance),
                             "Way of the contacts along the surface since the grasp, m.")
      .def_property_readonly("slip_angle", number(&device::Tick::slip_angle), "Turn in the fingers since the grasp, rad.")
      .def_property_readonly("slip_speed", number(&device::Tick::slip_speed), "Speed of the contacts along the surface, m/s.")
      .def_property_readonly("weight", number(&device::Tick::weight), "Weight of vessel and liquid, as far as it is lifted, N.")
      .def_property_readonly("torque", number(&device::Tick::torque), "Torque of the held vessel, N m.")
      .def_property_readonly("tilt", number(&device::Tick::tilt), "Between the vessel's axis and up, rad.")
      .def_property_readonly("closure", number(&device::Tick::closure), "Closure of the hand: 0 open, 1 closed.")
      .def_property_readonly("gap", number(&device::Tick::gap), "Gap of the hand, m.")
      .def_property_readonly("grasp_height", number(&device::Tick::grasp_height),
                             "Height of the middle of the tips at the grasp, m, vessel's frame; NaN: nothing is held.");
}

void bind_step(py::module_& module) {
  py::class_<Step> type(
      module, "Step",
      "One period of a live session: forces, states and the hand. Made by ``Session.step``.\n\n"
      "It stays as it is when the session goes on. SI units. Forces of arm_force are in the device frame, places in the\n"
      "world frame (+y up).");
  type.def_property_readonly("tick", number(&device::Tick::number), "Number of the period.")
      .def_property_readonly(
          "state", [](const Step& step) { return device::SESSION_STATE_NAMES[static_cast<std::size_t>(step.tick.state)]; },
          "\"free\", \"touching\", \"lift\", \"tilt\", \"maintain\", \"slipped\", \"let go\" or \"released\".")
      .def_property_readonly(
          "is_held", [](const Step& step) { return device::is_held(step.tick.state); }, "Whether a vessel is held.")
      .def_property_readonly("vessel", &Step::vessel,
                             "Name of the vessel that is touched, held or on its way back; None: there is none.");
  bind_hold(type);
  type.def_property_readonly("flow", number(&device::Tick::flow), "Over the held vessel's lip, m3/s.")
      .def_property_readonly(
          "volume", [](const Step& step) { return step.of_vessels(step.tick.volume); },
          "Liquid in each vessel, m3, in the order of scene.vessels.")
      .def_property_readonly(
          "arrived", [](const Step& step) { return step.of_vessels(step.tick.arrived); },
          "Liquid of each vessel that has arrived in the target, m3, in the order of scene.vessels.")
      .def_property_readonly(
          "spilled", [](const Step& step) { return step.of_vessels(step.tick.spilled); },
          "Liquid of each vessel that was spilled, m3, in the order of scene.vessels.")
      .def_property_readonly(
          "target_volume", [](const Step& step) { return device::target_volume(step.session->live().scene, step.tick); },
          "Liquid in the target of the task, of all vessels together, m3; 0 without a task.")
      .def_property_readonly("middle", triple(&device::Tick::middle), "Middle of the two tips, m, world frame, shape (3,).")
      .def_property_readonly(
          "hand_rotation", [](const Step& step) { return matrix_of(step.tick.hand_rotation); },
          "Rotation of the gripper's axes, world frame, shape (3, 3).")
      .def_property_readonly("vessel_place", triple(&device::Tick::vessel_place),
                             "Place of the vessel's origin, m, world frame, shape (3,).")
      .def_property_readonly(
          "vessel_rotation", [](const Step& step) { return matrix_of(step.tick.vessel_rotation); },
          "From the vessel's frame to the world's, shape (3, 3).")
      .def_property_readonly(
          "tips", [](const Step& step) { return points_of(step.tick.tips); }, "Thumb and index tip, m, world frame, shape (2, 3).")
      .def_property_readonly("touch_mask", number(&device::Tick::touch_mask), "Bit j: joint j touches.")
      .def_property_readonly("used_mask", number(&device::Tick::used_mask), "Bit f: finger f has a touching joint.")
      .def_property_readonly("grasps", number(&device::Tick::grasps), "Grasps since the start.")
      .def_property_readonly("lost", number(&device::Tick::lost), "Vessels lost since the start.")
      .def_property_readonly("destinations", number(&device::Tick::destinations),
                             "Vessels brought to their destination since the start.")
      .def_property_readonly("is_task_done", number(&device::Tick::task_done), "Whether the scene's task is done.")
      .def_property_readonly(
          "joints", [](const Step& step) { return points_of(step.hand().proxies); },
          "The whole hand as it is drawn, m, world frame, shape (24, 3).")
      .def("hand", &Step::hand, "The whole hand with its wrist.")
      .def("__repr__", &step_text);
}

std::vector<bool> touching(const device::HandView& hand) {
  std::vector<bool> found;
  for (const device::PointContact contact : hand.contact)
    found.push_back(contact == device::PointContact::touching || contact == device::PointContact::projected ||
                    contact == device::PointContact::tracked_touching);
  return found;
}

void bind_hand(py::module_& module) {
  py::class_<device::HandView>(
      module, "Hand", "The whole hand of one step: 24 joints, m, world frame (+y up). Made by ``Step.hand`` and ``Session.hand``.")
      .def_property_readonly(
          "joints", [](const device::HandView& hand) { return points_of(hand.proxies); },
          "As it is drawn, outside of all vessels, m, world frame, shape (24, 3).")
      .def_property_readonly(
          "posed", [](const device::HandView& hand) { return points_of(hand.posed); },
          "With its fingers on the glass, m, world frame, shape (24, 3).")
      .def_property_readonly(
          "rigged", [](const device::HandView& hand) { return points_of(hand.rigged); },
          "On its trajectory where the gripper has it, glass or no glass, m, world frame, shape (24, 3).")
      .def_property_readonly(
          "wrist", [](const device::HandView& hand) { return array_of(hand.wrist); },
          "Origin of the hand's frame, m, world frame, shape (3,).")
      .def_property_readonly(
          "rotation", [](const device::HandView& hand) { return matrix_of(hand.rotation); },
          "Rotation of the hand's frame, shape (3, 3).")
      .def_property_readonly("touching", &touching, "Whether each of the 24 joints touches the glass.");
}

}  // namespace

void bind_session(py::module_& module) {
  bind_hand(module);
  bind_step(module);
  py::class_<SessionHandle>(module, "Session")
      .def(py::init<SceneHandle&, const std::optional<std::array<double, 2>>&>(), py::arg("scene"), py::arg("gap"),
           py::call_guard<py::gil_scoped_release>())
      .def("step", &SessionHandle::step, py::arg("position"), py::arg("rotation"), py::arg("gap"), py::arg("buttons"),
           py::arg("tick"), py::return_value_policy::copy)
      .def("last", &SessionHandle::last, py::return_value_policy::copy)
      .def("close", &SessionHandle::close)
      .def_property_readonly("closed", &SessionHandle::is_closed)
      .def_property_readonly("gap", &SessionHandle::gap)
      .def_property_readonly("period", &SessionHandle::period);
}

}  // namespace wholehand
