// SPDX-License-Identifier: MIT
#include "device/loop/grip_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/text/text.h"
#include "core/loop.h"
#include "core/scene.h"
#include "device/loop/wall.h"

namespace wholehand::device {
namespace {

constexpr double TO_GRASP = 2, TO_SETTLE = 2, LAST = 0.5;  // s
constexpr double STILL_SPEED = 2e-3, STILL_TIME = 0.05;    // m/s, s: the paper gives no criterion; docs/evidence.md
constexpr double FLIES_APART = 1;                          // m: no hand is that wide
constexpr double LINEAR_TIME = 20;                         // s: a hundred reactions

core_f64::Plant held_plant(const GripLoop& loop) {
  return {loop.device_mass + loop.finger_mass, loop.device_damping + loop.finger_damping, loop.finger_stiffness};
}

// Gripper and user, a sample at a time.
class Held {
 public:
  explicit Held(const GripLoop& loop)
      : loop_(loop),
        by_(core_f64::propagator(held_plant(loop), 1 / loop.rate)),
        felt_(static_cast<std::size_t>(std::lround(loop.reaction * loop.rate)) + 1, loop.base + loop.excess) {}

  // `added`: what the torque adds to the feedback. Returns the feedback.
  double step(double added) {
    const double unclamped = loop_.base + added + loop_.k_open * motion.place;
    const double force = is_linear ? unclamped : std::clamp(unclamped, 0.0, loop_.max);
    felt_[sample_ % felt_.size()] = force - added;
    ++sample_;
    // what was felt a reaction ago; nothing to react to before the first
    const double reacted_to = felt_[sample_ % felt_.size()];
    muscle_ += (loop_.base + loop_.excess - reacted_to) / (loop_.response * loop_.rate);
    if (!is_linear) muscle_ = std::max(muscle_, 0.0);
    motion = core_f64::advance(by_, motion, muscle_ - force);
    return force;
  }

  core_f64::Motion motion;
  bool is_linear = false;

 private:
  const GripLoop& loop_;
  core_f64::Propagator by_;
  std::vector<double> felt_;  // of the samples before, as a ring
  std::size_t sample_ = 0;
  double muscle_ = 0;
};

// The gripper's spring under a finger, as a wall's: what the user does is slow beside a sample.
WallDevice gripper_of(const GripLoop& loop) {
  WallDevice device;
  device.mass = loop.device_mass;
  device.damping = loop.device_damping;
  device.rate = loop.rate;
  device.finger_mass = loop.finger_mass;
  device.finger_damping = loop.finger_damping;
  device.finger_stiffness = loop.finger_stiffness;
  return device;
}

// Every parameter that the report varies.
struct Varied {
  const char* name;
  double GripLoop::*value;
  std::vector<double> values;
};
const std::vector<Varied>& varied() {
  static const std::vector<Varied> list{
      {"base_N", &GripLoop::base, {0.4, 0.8, 1.2, 1.6, 2.4}},
      {"range_N", &GripLoop::range, {0, 1, 2, 3, 4, 6}},
      {"k_open_Npm", &GripLoop::k_open, {50, 100, 200, 400, 600, 800, 1600, 3200, 6400, 9000, 12800}},
      {"reaction_s", &GripLoop::reaction, {0.02, 0.06, 0.075, 0.09, 0.15, 0.25, 0.4, 0.6}},
      {"response_s", &GripLoop::response, {0.03, 0.06, 0.1, 0.15, 0.2, 0.4}},
      {"finger_stiffness_Npm", &GripLoop::finger_stiffness, {100, 200, 500, 800, 1600}},
      {"finger_damping_Nspm", &GripLoop::finger_damping, {0.5, 1, 4, 8}},
      {"finger_mass_kg", &GripLoop::finger_mass, {0.004, 0.012, 0.02}},
      {"tilt_speed_radps", &GripLoop::tilt_speed, {0.1, 0.43, 1, 3, 10, 30}},
      {"rate_Hz", &GripLoop::rate, {250, 500, 1000, 2000, 4000, 8000}},
  };
  return list;
}

}  // namespace

const char* const GRIP_OUTCOME_NAMES[GRIP_OUTCOMES] = {"settles", "creeps", "oscillates", "saturates", "lost"};

GripLoopResult hold_and_tilt(const GripLoop& loop) {
  const int tilt_begins = static_cast<int>(TO_GRASP * loop.rate);
  const double tilting = loop.tilt > 0 ? loop.tilt / loop.tilt_speed : 0;
  const int samples = tilt_begins + static_cast<int>((tilting + TO_SETTLE + 10 * loop.reaction) * loop.rate);
  const int last = samples - static_cast<int>(std::max(LAST, 5 * loop.reaction) * loop.rate),
            still = std::max(1, static_cast<int>(STILL_TIME * loop.rate));
  constexpr double NONE = std::numeric_limits<double>::infinity();
  double highest = 0, begin = 0, least = NONE;
  double low = NONE, high = -NONE, rise = 0, fall = 0;  // of the end
  int slow = 0, slow_since = -1;
  bool is_lost = false, is_saturated = true;
  Held held(loop);
  GripLoopResult result;
  result.response_time = std::numeric_limits<double>::quiet_NaN();
  for (int sample = 0; sample < samples; ++sample) {
    const double time = sample / loop.rate;
    const double angle = std::min(loop.tilt, std::max(0.0, time - TO_GRASP) * loop.tilt_speed);
    const double force = held.step(loop.range * std::sin(angle));
    const double x = held.motion.place;
    is_lost = is_lost || x < -loop.band;
    if (!(std::abs(x) < FLIES_APART)) {
      result.outcome = is_lost ? GripOutcome::lost : GripOutcome::oscillates;
      result.swing = FLIES_APART;
      return result;
    }
    if (sample < tilt_begins) {
      highest = std::max(highest, x);
      begin = x;
      slow = std::abs(held.motion.speed) < STILL_SPEED ? slow + 1 : 0;
      if (slow == 0) slow_since = -1;
      // before the first reaction the fingers only yield
      if (slow >= still && slow_since < 0 && time > loop.reaction + STILL_TIME) slow_since = sample - still + 1;
    } else {
      least = std::min(least, x);
    }
    if (sample >= last) {
      low = std::min(low, x);
      high = std::max(high, x);
      rise = std::max(rise, x - low);
      fall = std::max(fall, high - x);
      is_saturated = is_saturated && force >= loop.max;
    }
  }
  if (slow_since >= 0) result.response_time = slow_since / loop.rate;
  result.overshoot = std::max(0.0, highest - begin);
  result.opened = std::max(0.0, begin - least);
  result.swing = high - low;
  if (is_lost) {
    result.outcome = GripOutcome::lost;
  } else if (is_saturated) {
    result.outcome = GripOutcome::saturates;
  } else if (std::min(rise, fall) > GRIP_SWING) {
    result.outcome = GripOutcome::oscillates;
  } else if (result.swing > GRIP_SWING) {
    result.outcome = GripOutcome::creeps;
  }
  return result;
}

// Linear about the grasp: larger in the last quarter than in the second is growth.
bool decays(const GripLoop& asked) {
  GripLoop loop = asked;
  loop.excess = 0;
  const int samples = static_cast<int>(LINEAR_TIME * loop.rate);
  Held held(loop);
  held.is_linear = true;
  double early = 0, late = 0;
  for (int sample = 0; sample < samples; ++sample) {
    held.step(0);
    const double x = std::abs(held.motion.place);
    if (!(x < FLIES_APART)) return false;
    if (sample >= samples / 4 && sample < samples / 2) early = std::max(early, x);
    if (sample >= samples - samples / 4) late = std::max(late, x);
  }
  return late <= early;
}

double largest_k_open(const GripLoop& asked) {
  GripLoop loop = asked;
  return largest_stable([&loop](double k_open) {
    loop.k_open = k_open;
    return decays(loop);
  });
}

double sampled_k_open(const GripLoop& loop) { return wall_theory(gripper_of(loop)).linear; }

double reaction_k_open(const GripLoop& loop) {
  const double share = 0.5 * PI * loop.response / loop.reaction;  // of k_open in k_f + k_open
  return share >= 1 ? std::numeric_limits<double>::infinity() : loop.finger_stiffness * share / (1 - share);
}

std::vector<GripLoopRow> grip_loop_rows(bool quick) {
  std::vector<GripLoopRow> rows;
  for (const Varied& axis : varied())
    for (const double value : axis.values) {
      GripLoop loop;
      loop.*axis.value = value;
      rows.push_back({axis.name, loop, {}});
    }
  // the products: how the force is rendered, against the user
  const int step = quick ? 2 : 1;
  const std::vector<Varied>& list = varied();
  const auto every = [step](const std::vector<double>& values) {
    std::vector<double> some;
    for (std::size_t k = 0; k < values.size(); k += step) some.push_back(values[k]);
    return some;
  };
  for (const double base : every(list[0].values))
    for (const double range : every(list[1].values))
      for (const double k_open : every(list[2].values))
        for (const double reaction : every(list[3].values))
          for (const double stiffness : every(list[5].values))
            for (const double speed : every(list[8].values)) {
              GripLoop loop;
              loop.base = base;
              loop.range = range;
              loop.k_open = k_open;
              loop.reaction = reaction;
              loop.finger_stiffness = stiffness;
              loop.tilt_speed = speed;
              rows.push_back({"products", loop, {}});
            }
  for (GripLoopRow& row : rows) row.result = hold_and_tilt(row.loop);
  return rows;
}

std::string grip_loop_csv(const std::vector<GripLoopRow>& rows, const std::string& run) {
  std::string csv =
      "varied,base_N,range_N,k_open_Npm,max_N,rate_Hz,device_kg,device_Nspm,finger_kg,finger_Nspm,finger_Npm,reaction_s,response_s,"
      "excess_N,tilt_rad,tilt_speed_radps,band_mm,outcome,response_time_s,overshoot_mm,opened_mm,swing_mm,sampled_k_open_Npm,"
      "reaction_k_open_Npm,device,driver,version,seed\n";
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string(); };
  GripLoop last;
  double sampled = sampled_k_open(last);
  for (const GripLoopRow& row : rows) {
    const GripLoop& l = row.loop;
    const bool is_same = l.rate == last.rate && l.finger_mass == last.finger_mass && l.finger_damping == last.finger_damping &&
                         l.finger_stiffness == last.finger_stiffness;
    if (!is_same) sampled = sampled_k_open(l);
    last = l;
    const GripLoopResult& r = row.result;
    append_formatted(
        csv, "{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:.5g},{:g},{:g},{},{},{},{},{},{},{},{}\n",
        row.varied, l.base, l.range, l.k_open, l.max, l.rate, l.device_mass, l.device_damping, l.finger_mass, l.finger_damping,
        l.finger_stiffness, l.reaction, l.response, l.excess, l.tilt, l.tilt_speed, l.band * 1e3,
        GRIP_OUTCOME_NAMES[static_cast<int>(r.outcome)], number(r.response_time), number(r.overshoot * 1e3), number(r.opened * 1e3),
        number(r.swing * 1e3), number(sampled), number(reaction_k_open(l)), run);
  }
  return csv;
}

}  // namespace wholehand::device
