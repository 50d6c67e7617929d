// SPDX-License-Identifier: MIT
// A function's parameters are read from a row in their order, and its results written in theirs, as the probe shaders do: a leaf of
// plain parameters needs but its name in a table. Those whose rows hold something else have a function of their own here.
#include "tests/support/leaf_facade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "core/body.h"
#include "core/closure.h"
#include "core/contact.h"
#include "core/contacts.h"
#include "core/effort.h"
#include "core/force.h"
#include "core/liquid.h"
#include "core/load.h"
#include "core/prepare.h"
#include "core/projection.h"
#include "core/score.h"
#include "core/table.h"
#include "core/touch.h"
#include "core/trig.h"
#include "core/wrist.h"
#include "shaders/layout.h"
#include "tests/shaders/probe_table.h"
#ifndef MAKE_LEAVES
#define MAKE_LEAVES make_double_leaves
#endif

namespace CORE_NS {
namespace {

// What no row holds: the shaders have it as buffers and constants.
struct Context {
  Hand hand;
  Vessel vessel;
};

// A parameter through which a function answers.
template <class T>
struct Out {
  T value{};
  operator T&() { return value; }
};

// How a parameter is held until the call: context by reference, an answer until it is written, all else by value.
template <class T>
constexpr bool IS_CONTEXT = std::is_same_v<T, Hand> || std::is_same_v<T, Vessel> || std::is_same_v<T, Lattice>;
template <class T>
struct Holder {
  using Type = T;
};
template <class T>
struct Holder<const T&> {
  using Type = std::conditional_t<IS_CONTEXT<T>, const T&, T>;
};
template <class T>
struct Holder<T&> {
  using Type = Out<T>;
};
template <class T>
using Held = typename Holder<T>::Type;

struct Row {
  const Context& context;
  const double* next;

  template <class T>
  T take() {
    if constexpr (std::is_same_v<T, const Hand&>) {
      return context.hand;
    } else if constexpr (std::is_same_v<T, const Vessel&>) {
      return context.vessel;
    } else if constexpr (std::is_same_v<T, const Lattice&>) {
      return context.vessel.lattice;
    } else {
      T value{};
      read(value);
      return value;
    }
  }

 private:
  template <class... Ts>
  void read_all(Ts&... values) {
    (read(values), ...);
  }
  template <class T>
  void read(Out<T>&) {}
  void read(Real& value) { value = static_cast<Real>(*next++); }
  void read(int& value) { value = static_cast<int>(std::nearbyint(*next++)); }
  void read(bool& value) { value = std::nearbyint(*next++) != 0; }
  void read(Vec2& value) { read_all(value.x, value.y); }
  void read(Vec3& value) { read_all(value.x, value.y, value.z); }
  void read(std::array<Real, 6>& six) {
    for (Real& value : six) read(value);
  }
  void read(std::array<Real, 4>& four) {
    for (Real& value : four) read(value);
  }
  void read(FingerFrame& value) { read_all(value.base, value.forward, value.palmward); }
  void read(Finger& value) { read_all(value.frame, value.mcp, value.lengths, value.radii); }
  void read(FingerPoints& value) { read_all(value.pip, value.dip, value.tip); }
  void read(Element& value) {
    int code = 0;
    read_all(value.a, value.b, value.center, value.radius, code);
    value.supports = SUPPORTS_OF(code);
    value.side = SIDE_OF(code);
  }
  void read(Support& value) {
    read_all(value.distance, value.other, value.normal, value.planar);
    value.element = 0;
  }
  void read(Ball& value) { read_all(value.place, value.radius); }
  void read(Grip& value) { read_all(value.height, value.azimuth, value.obliquity, value.roll, value.offset, value.hand_scale); }
  void read(FingerMotion& value) {
    read_all(value.origin, value.rates, value.joint, value.at, value.end, value.steps, value.blocked, value.unsettled);
  }
  void read(PaperAxis& value) {
    read(value.direction);
    value.exists = true;
  }
  void read(Load& value) {
    value.mass = 1;
    read_all(value.fixed, value.lean, value.height);
  }
};

struct Answer {
  double* next;

  template <class... Ts>
  void put_all(const Ts&... values) {
    (put(values), ...);
  }
  template <class T>
  void put_out(const T&) {}
  template <class T>
  void put_out(const Out<T>& answer) {
    put(answer.value);
  }
  void put(Real value) { *next++ = static_cast<double>(value); }
  void put(int value) { *next++ = value; }
  void put(bool value) { *next++ = value ? 1 : 0; }
  void put(Vec2 value) { put_all(value.x, value.y); }
  void put(Vec3 value) { put_all(value.x, value.y, value.z); }
  void put(const std::array<Real, 6>& six) {
    for (const Real value : six) put(value);
  }
  void put(const Mat3& value) { put_all(value[0], value[1], value[2]); }
  void put(const FingerPoints& value) { put_all(value.pip, value.dip, value.tip); }
  void put(const FingerFrame& value) { put_all(value.base, value.forward, value.palmward); }
  void put(const Support& value) { put_all(value.distance, value.other, value.normal, value.element, value.planar); }
  void put(const Contact& value) { put_all(value.separation, value.proxy, value.settled); }
  void put(const Cell& value) { put_all(value.i, value.j, value.k, value.fraction, value.outside); }
  void put(const Trace& value) { put_all(value.t, value.reason, value.normal, value.element); }
  void put(const Placement& value) { put_all(value.rotation, value.translation); }
  // 0 where the reason leaves a value open
  void put(Closing value) {
    const bool reached = value.reason == REASON_NONE || value.reason >= REASON_TOO_WIDE;
    if (!reached) value.t_index = value.t_thumb = value.gap = 0, value.midpoint = Vec3(0);
    if (value.reason != REASON_NONE) {
      value.closure = value.thumb_angle = value.index_angle = 0;
      value.grazing = false;
      value.placement = {Mat3(0), Vec3(0), 0};
    }
    put_all(value.reason, value.direction, value.t_index, value.t_thumb, value.gap, value.midpoint, value.closure,
            value.thumb_angle, value.index_angle, value.grazing, value.placement, value.placement.scale);
  }
  void put(const FingerMotion& value) {
    put_all(value.origin, value.rates, value.joint, value.at, value.end, value.steps, value.blocked, value.unsettled);
  }
  void put(const PaperAxis& value) { put_all(value.direction, value.exists); }
  void put(const Place& value) { put_all(value.ball, value.velocity, value.acceleration, value.speed, value.bend, value.jerk); }
  void put(const Ball& value) { put_all(value.place, value.radius); }
  void put(const ArmReach& value) { put_all(value.along, value.low, value.aside, value.straight, value.bent); }
  void put(const Wrist& value) { put_all(value.flexion, value.deviation, value.pronation, value.share); }
  template <class... Ts>
  void put(const std::tuple<Ts...>& values) {
    std::apply([this](const auto&... each) { this->put_all(each...); }, values);
  }
};

template <class Result, class... Parameters>
void answer_one(Result (*function)(Parameters...), Row row, Answer& answer) {
  std::tuple<Held<Parameters>...> given{row.take<Held<Parameters>>()...};
  if constexpr (std::is_void_v<Result>) {
    std::apply(function, given);
  } else {
    answer.put(std::apply(function, given));
  }
  std::apply([&](const auto&... held) { (answer.put_out(held), ...); }, given);
}

// Functions of the same row, whose answers follow each other.
template <auto... FUNCTIONS>
void answers_of(const Context& context, const double* given, double* to) {
  Answer answer{to};
  (answer_one(FUNCTIONS, Row{context, given}, answer), ...);
}

// ---- rows that are not a function's parameters ----

Real closure_to_tolerance(const Hand& hand, Real gap) { return closure_of_gap(hand, gap, STOP_TOLERANCE); }

std::tuple<Real, bool, bool, bool, bool, Vec2> element_facts(const Element& element, Vec2 q, Real sign) {
  return {std::sqrt(element_distance_squared(element, q)),
          element_crosses(element, q),
          element_spans(element, q),
          element_convex(element, q),
          element_supports(element, q),
          element_outward(element, q, sign)};
}

Trace trace_along(const Vessel& vessel, Vec3 origin, Real azimuth, Real obliquity, Real heading, Real radius) {
  return trace_tip(vessel, origin, grip_direction(azimuth, obliquity), heading, radius);
}

std::tuple<Placement, Real, FingerFrame> placed_hand(const Hand& hand, Real closure, Real azimuth, Real obliquity, Real roll,
                                                     Vec3 midpoint, Real scale) {
  Real e1_x = 0;
  const Placement placement = place_hand(hand, closure, grip_direction(azimuth, obliquity), roll, midpoint, scale, e1_x);
  return {placement, e1_x, placed_frame(placement, hand.frame[1])};
}

Placement placed(const Hand& hand, Real closure, Real azimuth, Real obliquity, Real roll, Vec3 midpoint, Real scale) {
  Real e1_x = 0;
  return place_hand(hand, closure, grip_direction(azimuth, obliquity), roll, midpoint, scale, e1_x);
}

Wrist eased_wrist(const Hand& hand, const Vessel& vessel, Real closure, Real azimuth, Real obliquity, Real roll, Vec3 midpoint,
                  Real scale, Vec3 shoulder, Real turn, Real raised) {
  const Placement placement = placed(hand, closure, azimuth, obliquity, roll, midpoint, scale);
  const ArmReach reach = reach_wrist(vessel, placement.translation, shoulder, Vec3(cosine(turn), 0, sine(turn)));
  Wrist best;
  ease_wrist(vessel, placement.rotation, placement.translation, reach, raised, best);
  return best;
}

Real least_share(const Hand& hand, const Vessel& vessel, Real closure, Real azimuth, Real obliquity, Real roll, Vec3 midpoint,
                 Real scale) {
  return find_wrist(vessel, placed(hand, closure, azimuth, obliquity, roll, midpoint, scale), azimuth).share;
}

Closing close_widened(const Hand& hand, const Vessel& vessel, Grip grip, Real index_more, Real thumb_more) {
  Hand wider = hand;
  wider.radius[1][4] += index_more / (hand.scale * grip.hand_scale);
  wider.radius[0][3] += thumb_more / (hand.scale * grip.hand_scale);
  return close_fingers(wider, vessel, grip);
}

Place place_of_finger(const Hand& hand, Finger finger, Vec3 angles, Vec3 rates, int number) {
  return watched_place(hand, finger, bend_finger(finger.lengths, chain_sums(angles)), rates, number);
}

Real step_of_place(const Hand& hand, const Vessel& vessel, Finger finger, Vec3 angles, Vec3 rates, int number) {
  const Place place = place_of_finger(hand, finger, angles, rates, number);
  const Support support = support_at(vessel, place.ball.place);
  return place_step(support, support.distance - place.ball.radius, place, finger.frame);
}

std::tuple<Vec3, bool, bool> whole_motion(const Hand& hand, const Vessel& vessel, Finger finger, Real limit) {
  const RestingFinger resting = rest_finger(hand, vessel, finger, limit);
  return {resting.angles, resting.blocked, resting.unsettled};
}

std::tuple<Vec3, Vec3> directions(Vec3 direction, Real sense, Real sine, Real cosine) {
  const Vec3 pour = pour_direction(direction, sense);
  return {pour, up_direction(pour, sine, cosine)};
}

std::tuple<Real, Real> forces(Real base, Real range, Real torque, Real reference, Real opening, Real max) {
  const Real normal = normal_force(base, range, torque, reference);
  return {normal, feedback_force(normal, opening, max)};
}

std::tuple<Real, Real, Real, Real, Real, Real, Real> score_terms(int fingers, int points, Real phalanx, Real palm, Real closure,
                                                                 Real feedback, Real max, Real hold, Real strength, Real wrist) {
  const Real posture = posture_term(closure);
  return {fingers_term(fingers),     contacts_term(points),     depth_term(phalanx, palm), posture,
          force_term(feedback, max), hold_term(hold, strength), wrist_term(posture, wrist)};
}

// ---- the table ----

struct LeafEntry {
  int probe;
  void (*evaluate)(const Context&, const double* given, double* answer);
};

constexpr LeafEntry LEAVES[] = {
    // trig
    {PROBE_SINE_COSINE, answers_of<sine_cosine>},
    {PROBE_ARC_COSINE, answers_of<arc_cosine>},
    {PROBE_ANGLE_BETWEEN, answers_of<angle_between>},
    {PROBE_DIRECTION_ANGLE, answers_of<direction_angle>},
    // hand
    {PROBE_TRAJECTORY, answers_of<thumb_angles, finger_angles>},
    {PROBE_FINGER_POINTS, answers_of<finger_points>},
    {PROBE_THUMB_POINTS, answers_of<thumb_points>},
    {PROBE_SEGMENT_END, answers_of<segment_end>},
    {PROBE_TIP_TO_TIP, answers_of<tip_to_tip, gap_at>},
    {PROBE_CLOSURE_OF_GAP, answers_of<closure_to_tolerance>},
    // sdf and contact
    {PROBE_SIGNED_DISTANCE, answers_of<signed_distance>},
    {PROBE_GRADIENT, answers_of<distance_gradient>},
    {PROBE_SUPPORT, answers_of<support_at>},
    {PROBE_SAFE_STEP, answers_of<safe_step>},
    {PROBE_CONTACT, answers_of<contact_at>},
    {PROBE_ELEMENT, answers_of<element_facts>},
    {PROBE_PROXY, answers_of<proxy_of>},
    {PROBE_LOCATE_CELL, answers_of<locate_cell>},
    {PROBE_LATTICE_SAMPLE, answers_of<lattice_sample>},
    {PROBE_DISTANCE_BEYOND, answers_of<distance_beyond>},
    {PROBE_MIX_REALS, answers_of<mix_reals>},
    // closure
    {PROBE_TRACE_TIP, answers_of<trace_along>},
    {PROBE_PLACE_HAND, answers_of<placed_hand>},
    {PROBE_CLOSE_FINGERS, answers_of<close_widened>},
    // wrist
    {PROBE_REACH_WRIST, answers_of<reach_wrist>},
    {PROBE_EASE_WRIST, answers_of<eased_wrist>},
    {PROBE_FIND_WRIST, answers_of<least_share>},
    // projection
    {PROBE_CHAIN_SUMS, answers_of<chain_sums>},
    {PROBE_WATCHED_PLACE, answers_of<place_of_finger>},
    {PROBE_NEAREST_POINT, answers_of<nearest_point>},
    {PROBE_PLACE_STEP, answers_of<step_of_place>},
    {PROBE_FINGER_MOTION, answers_of<whole_motion>},
    {PROBE_PAPER_AXIS, answers_of<paper_axis>},
    {PROBE_TURNED_POINT, answers_of<turned_point>},
    {PROBE_PROJECT_POINT, answers_of<project_point>},
    {PROBE_TURN_JOINT, answers_of<turn_joint>},
    {PROBE_PROJECTION_ROLE, answers_of<projection_role>},
    // force and score
    {PROBE_DIRECTIONS, answers_of<directions>},
    {PROBE_LOAD_CENTER, answers_of<load_center>},
    {PROBE_REFERENCE, answers_of<grip_reference>},
    {PROBE_FORCES, answers_of<forces>},
    {PROBE_STRENGTH_AT, answers_of<strength_at>},
    {PROBE_SCORE, answers_of<score_terms>},
    // body and table
    {PROBE_BALL_BETWEEN, answers_of<ball_between>},
    {PROBE_AROUND_BONE, answers_of<around_bone>},
    {PROBE_OVERLAP_MORE, answers_of<overlap_more>},
    {PROBE_NEAREST_SHARE, answers_of<nearest_share>},
    {PROBE_BONES_OVERLAP, answers_of<bones_overlap>},
    {PROBE_DEPTH_IN_TABLE, answers_of<depth_in_table>},
    {PROBE_FINGER_IN_TABLE, answers_of<finger_in_table>},
    // effort
    {PROBE_PRESS, answers_of<press, pressed>},
};

class CoreLeaves final : public wholehand::Leaves {
 public:
  CoreLeaves(const wholehand::Scene& scene, std::size_t v, int lattice_samples, int lattice_bits)
      : context_{load_hand(wholehand::prepare_hand(scene.hand), scene.hand), {}} {
    const wholehand::VesselData& data = scene.vessels[v];
    const wholehand::PreparedVessel prepared = wholehand::prepare_vessel(data, data.wall > 0);
    Vessel& vessel = context_.vessel;
    vessel = load_vessel(prepared, data, load_quadrature(wholehand::prepare_quadrature(wholehand::QUADRATURE_POINTS)),
                         scene.liquid.has_value(), scene.hand.handedness);
    vessel.on_table = scene.table.has_value();
    if (scene.table) vessel.table_top = Real(wholehand::table_top(scene, data));
    vessel.arm = load_arm(scene, data);
    if (lattice_samples == 0) return;
    const double margin = wholehand::lattice_margin(scene);
    use_lattice(vessel, load_lattice(wholehand::prepare_lattice(prepared, lattice_samples, lattice_bits == 16, margin)));
  }

  void evaluate(int probe, const double* given, double* answer) const override {
    const auto leaf = std::ranges::find(LEAVES, probe, &LeafEntry::probe);
    if (leaf == std::end(LEAVES)) throw std::logic_error("no such probe");
    leaf->evaluate(context_, given, answer);
  }

 private:
  Context context_;
};

}  // namespace
}  // namespace CORE_NS

namespace wholehand {

std::unique_ptr<Leaves> MAKE_LEAVES(const Scene& scene, std::size_t vessel, int lattice_samples, int lattice_bits) {
  return std::make_unique<CORE_NS::CoreLeaves>(scene, vessel, lattice_samples, lattice_bits);
}

}  // namespace wholehand
