// SPDX-License-Identifier: MIT
#include "app/viewer/frame.h"

#include <cmath>
#include <utility>

#include "base/text/text.h"
#include "core/quaternion.h"
#include "core/vectors.h"
#include "device/advice/words.h"
#include "device/session/amounts.h"
#include "sweeps/grips/hand_nodes.h"

namespace wholehand {
namespace {

// Writes JSON directly: a frame is made sixty times a second, and a tree of values would cost more than its contents.
class Writer {
 public:
  Writer() { out_.reserve(4096); }
  void text(std::string_view value) { out_.append(value); }
  void number(double value) {
    if (std::isfinite(value)) {
      append_formatted(out_, "{}", static_cast<float>(value));
    } else {
      text("null");
    }
  }
  void exact(double value) { append_formatted(out_, "{}", value); }
  void whole(std::int64_t value) { append_formatted(out_, "{}", value); }
  template <typename Numbers>
  void numbers(const Numbers& values) {
    text("[");
    bool is_first = true;
    for (const double value : values) {
      if (!is_first) text(",");
      is_first = false;
      number(value);
    }
    text("]");
  }
  // `name` includes its quotes, its colon and the preceding comma.
  void number(std::string_view name, double value) {
    text(name);
    number(value);
  }
  template <typename Numbers>
  void numbers(std::string_view name, const Numbers& values) {
    text(name);
    numbers(values);
  }
  void points(std::string_view name, const std::array<Triple, JOINT_COUNT>& values) {
    text(name);
    for (int j = 0; j < JOINT_COUNT; ++j) {
      text(j == 0 ? "[" : ",");
      numbers(values[j]);
    }
    text("]");
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

char letter(device::PointContact contact) {
  constexpr char LETTERS[] = {'.', 't', 'p', 'k', 'K'};
  return LETTERS[static_cast<std::size_t>(contact)];
}

void write_vessel(Writer& out, const ViewFrame::Vessel& vessel) {
  if (!vessel.is_shown) {
    out.text("null");
    return;
  }
  out.numbers("{\"place\":", vessel.pose.place);
  out.numbers(",\"rotation\":", quaternion_of(vessel.pose.rotation));
  out.number(",\"volume\":", vessel.volume);
  const Rotation& r = vessel.pose.rotation;
  out.numbers(",\"up\":", vessel.surface ? vessel.surface->up : Triple{r[3], r[4], r[5]});
  out.number(",\"level\":", vessel.surface ? vessel.surface->level : device::Tick::NONE);
  out.text("}");
}

void write_forces(Writer& out, const ViewFrame& frame) {
  out.number(",\"forces\":{\"feedback\":", frame.feedback);
  out.number(",\"written\":", frame.written);
  out.number(",\"base\":", frame.base);
  out.number(",\"normal\":", frame.normal);
  out.number(",\"opening\":", frame.opening);
  out.number(",\"user\":", frame.user);
  out.number(",\"hold\":", frame.hold);
  if (std::isinf(frame.hold)) out.text(",\"hold_infinite\":true");
  out.number(",\"weight\":", frame.weight);
  out.number(",\"torque\":", frame.torque);
  out.text("}");
}

// A margin of minus infinity, where nothing holds, is null there.
void write_slip(Writer& out, const ViewFrame::Slip& slip) {
  out.number(",\"slip\":{\"margin\":", slip.margin);
  out.number(",\"distance\":", slip.distance);
  out.number(",\"angle\":", slip.angle);
  out.number(",\"speed\":", slip.speed);
  out.text("}");
}

void write_presses(Writer& out, const std::vector<device::HandPress>& presses) {
  bool is_first = true;
  for (const device::HandPress& press : presses) {
    out.text(is_first ? "{\"digit\":" : ",{\"digit\":");
    is_first = false;
    out.whole(press.digit);
    out.numbers(",\"place\":", press.place);
    out.numbers(",\"normal\":", press.normal);
    out.numbers(",\"force\":", press.force);
    out.text("}");
  }
}

// What is infinite is null there.
void write_holding(Writer& out, const device::HandHold& hold) {
  out.number(",\"holding\":{\"effort\":", hold.effort);
  out.number(",\"effort_low\":", hold.low);
  out.number(",\"tips_effort\":", hold.tips);
  out.number(",\"tips_hold\":", hold.tips_force());
  out.text(",\"contacts\":[");
  write_presses(out, hold.presses);
  out.text("]}");
}

// The words are ours and need no escape.
void write_advice(Writer& out, const FrameAdvice& advice) {
  out.text(",\"advice\":{\"vessel\":");
  out.whole(advice.vessel);
  out.text(",\"words\":\"");
  out.text(advice.words);
  out.number("\",\"from\":", advice.from);
  out.number(",\"to\":", advice.to);
  if (advice.ghost) {
    std::array<Triple, JOINT_COUNT> joints;
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = advice.ghost->joints[j].place;
    out.points(",\"joints\":", joints);
    out.numbers(",\"wrist\":", advice.ghost->wrist.place);
  }
  out.text("}");
}

}  // namespace

FrameAdvice frame_advice(const Scene& scene, const device::Advice& advice, const device::VesselPoses& poses) {
  FrameAdvice shown{advice.vessel, device::advice_words(advice), device::Tick::NONE, device::Tick::NONE,
                    ghost_of(scene, advice, poses)};
  if (advice.present.is_possible) shown.from = advice.present.effort;
  if (advice.best && advice.best->is_possible) shown.to = advice.best->effort;
  return shown;
}

std::string frame_json(const ViewFrame& frame) {
  Writer out;
  out.text("{\"t\":");
  out.exact(frame.time);
  out.text(",\"tick\":");
  out.whole(frame.tick);
  out.text(",\"state\":\"");
  out.text(frame.state);
  out.text("\",\"vessel\":");
  out.whole(frame.vessel);
  out.points(",\"joints\":", frame.hand.proxies);
  out.points(",\"rigged\":", frame.hand.rigged);
  out.numbers(",\"wrist\":", frame.hand.wrist);
  out.numbers(",\"rigged_wrist\":", frame.hand.rigged_wrist);
  out.text(",\"rotation\":");
  if (frame.rotation) {
    out.numbers(quaternion_of(*frame.rotation));
  } else {
    out.text("null");
  }
  out.text(",\"contacts\":\"");
  for (const device::PointContact contact : frame.hand.contact) out.text({std::array{letter(contact)}.data(), 1});
  out.number("\",\"closure\":", frame.closure);
  out.number(",\"gap\":", frame.gap);
  out.number(",\"tilt\":", frame.tilt);
  out.text(",\"vessels\":[");
  for (std::size_t v = 0; v < frame.vessels.size(); ++v) {
    if (v > 0) out.text(",");
    write_vessel(out, frame.vessels[v]);
  }
  out.text("],\"stream\":");
  if (frame.stream) {
    out.numbers("{\"from\":", frame.stream->from);
    out.numbers(",\"to\":", frame.stream->to);
    out.number(",\"flow\":", frame.stream->flow);
    out.text("}");
  } else {
    out.text("null");
  }
  write_forces(out, frame);
  if (frame.slip) write_slip(out, *frame.slip);
  if (frame.hand.hold) write_holding(out, *frame.hand.hold);
  if (frame.advice) write_advice(out, *frame.advice);
  out.text(",\"amounts\":[");
  for (std::size_t k = 0; k < frame.arrived.size(); ++k) {
    out.number(k > 0 ? ",{\"arrived\":" : "{\"arrived\":", frame.arrived[k]);
    out.text("}");
  }
  out.number("],\"spilled\":", frame.spilled);
  out.number(",\"target_volume\":", frame.target_volume);
  out.text(",\"guidance\":");
  out.whole(frame.guidance);
  out.text(frame.is_done ? ",\"done\":true" : ",\"done\":false");
  out.number(",\"timing\":{\"rate\":", frame.timing.rate);
  out.number(",\"step\":", frame.timing.step);
  out.text(",\"missed\":");
  out.whole(frame.timing.missed);
  out.text("}}");
  return out.take();
}

FrameMaker::FrameMaker(const device::LiveScene& live)
    : live_(live), table_(device::table_height(live.scene)), rests_(live.vessels.size()) {}

ViewFrame FrameMaker::make(const device::Tick& tick, const device::VesselPoses& poses, const device::HandView& hand,
                           const device::DisplayTiming& timing) {
  const Scene& scene = live_.scene;
  ViewFrame frame;
  frame.time = static_cast<double>(tick.number) / scene.live.rate;
  frame.tick = tick.number;
  frame.state = device::SESSION_STATE_NAMES[static_cast<std::size_t>(tick.state)];
  frame.vessel = tick.vessel;
  frame.hand = hand;
  frame.rotation = tick.hand_rotation;
  frame.closure = tick.closure;
  frame.gap = tick.gap;
  frame.tilt = tick.tilt;
  for (std::size_t v = 0; v < rests_.size(); ++v) {
    Rest& rest = rests_[v];
    if (rest.volume != tick.volume[v] || rest.rotation != poses[v].rotation)
      rest = {tick.volume[v], poses[v].rotation,
              device::liquid_surface(live_.vessels[v].vessel, live_.quadrature, tick.volume[v], poses[v].rotation)};
    frame.vessels.push_back({true, poses[v], tick.volume[v], rest.surface});
  }
  frame.stream = device::pouring_stream(live_, tick, table_);
  frame.feedback = tick.feedback;
  frame.written = tick.written.grip;
  frame.base = device::is_held(tick.state) ? scene.force.base : 0;
  frame.normal = tick.normal_force;
  frame.opening = tick.opening_force;
  frame.user = tick.user_force;
  frame.hold = hand.hold ? hand.hold->force() : tick.hold_force;
  frame.weight = tick.weight;
  if (!std::isnan(tick.safety_margin))
    frame.slip = ViewFrame::Slip{tick.safety_margin, tick.slip_distance, tick.slip_angle, tick.slip_speed};
  frame.torque = tick.torque;
  for (const device::MixedAmount& amount : device::mixing_board(scene, tick)) frame.arrived.push_back(amount.arrived);
  frame.spilled = device::total_spilled(scene, tick);
  frame.target_volume = device::target_volume(scene, tick);
  frame.guidance = tick.guidance;
  frame.is_done = tick.task_done;
  frame.timing = timing;
  return frame;
}

std::optional<GhostHand> ghost_of(const Scene& scene, const device::Advice& advice, const device::VesselPoses& poses) {
  if (advice.vessel < 0 || !advice.best || !advice.is_better) return std::nullopt;
  const device::VesselPose& pose = poses[static_cast<std::size_t>(advice.vessel)];
  const glm::dmat3 turn = to_mat3(pose.rotation);
  const auto out = [&](const sweeps::HandNode& node) {
    return GhostNode{to_triple(to_vec3(pose.place) + turn * to_vec3(node.position)),
                     to_quaternion(to_quat(turn) * to_quat(node.rotation))};
  };
  const sweeps::HandNodes nodes = sweeps::hand_nodes(scene.hand, advice.best->grip, advice.posed);
  GhostHand ghost{out(nodes.wrist), {}};
  for (std::size_t j = 0; j < ghost.joints.size(); ++j) ghost.joints[j] = out(nodes.joints[j]);
  return ghost;
}

}  // namespace wholehand
