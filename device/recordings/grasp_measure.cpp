// SPDX-License-Identifier: MIT
#include "device/recordings/grasp_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/reader/asked_grip.h"
#include "core/vectors.h"
#include "device/session/grip_of_tips.h"

namespace wholehand::device {

const std::array<const char*, GRIP_COURSES> GRIP_COURSE_NAMES{"", "G1", "G2", "G3", "G4"};
const std::array<const char*, 4> GRASP_OUTCOME_NAMES{"let go", "lost", "released", "recording ends"};

void MeanSum::add(double value) {
  if (!std::isfinite(value)) return;
  // Welford's update: no difference of large sums
  const double difference = value - mean_;
  mean_ += difference / static_cast<double>(++count_);
  squares_ += difference * (value - mean_);
}

MeanDeviation MeanSum::result() const {
  MeanDeviation result;
  result.count = count_;
  if (count_ > 0) result.mean = mean_;
  if (count_ > 1) result.deviation = std::sqrt(squares_ / static_cast<double>(count_ - 1));
  return result;
}

std::int64_t periods_of(std::span<const Tick> ticks, std::size_t k) {
  return k + 1 < ticks.size() ? ticks[k + 1].number - ticks[k].number : 1;
}

double turning_back(std::span<const double> values) {
  double lowest = INFINITY, highest = -INFINITY, rise = 0, fall = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    rise = std::max(rise, value - lowest);
    fall = std::max(fall, highest - value);
  }
  return std::min(rise, fall);
}

namespace {

// Half a window in periods.
std::int64_t half_window(double seconds, double rate) { return std::max<std::int64_t>(1, std::llround(seconds * rate / 2)); }

// Mean over a window about each tick, of what is finite; the window ends where the grasp does.
std::vector<double> smoothed(std::span<const Tick> held, double Tick::*member, std::int64_t half) {
  std::vector<double> means(held.size());
  double sum = 0;
  std::size_t first = 0, end = 0, count = 0;
  const auto add = [&](std::size_t k, double sign) {
    if (!std::isfinite(held[k].*member)) return;
    sum += sign * held[k].*member;
    count = sign > 0 ? count + 1 : count - 1;
  };
  for (std::size_t k = 0; k < held.size(); ++k) {
    for (; end < held.size() && held[end].number <= held[k].number + half; ++end) add(end, 1);
    for (; held[first].number < held[k].number - half; ++first) add(first, -1);
    means[k] = count > 0 ? sum / static_cast<double>(count) : Tick::NONE;
  }
  return means;
}

bool has_gap(const Tick& tick) { return tick.read == ReadOutcome::value && std::isfinite(tick.device.gap); }

// The gap's speed at a tick, m/s: the slope of the line through the gaps of a window about it by least squares (a Savitzky-Golay
// filter of the first order, whose delay is none); NaN where fewer than three are known.
double gap_speed(std::span<const Tick> held, std::size_t at, std::int64_t half, double rate) {
  double n = 0, t = 0, x = 0, tt = 0, tx = 0;
  const auto add = [&](const Tick& tick) {
    if (!has_gap(tick)) return;
    const double time = static_cast<double>(tick.number - held[at].number) / rate, gap = tick.device.gap - held[at].device.gap;
    n += 1;
    t += time;
    x += gap;
    tt += time * time;
    tx += time * gap;
  };
  if (!has_gap(held[at])) return Tick::NONE;
  for (std::size_t k = at; k < held.size() && held[k].number <= held[at].number + half; ++k) add(held[k]);
  for (std::size_t k = at; k > 0 && held[k - 1].number >= held[at].number - half; --k) add(held[k - 1]);
  return n < 3 ? Tick::NONE : (n * tx - t * x) / (n * tt - t * t);
}

// The first tick from which the gap is at rest; the count of ticks where it never is. Ticks without a measurement say nothing.
std::size_t first_at_rest(std::span<const Tick> held, double rate) {
  const std::int64_t half = half_window(SPEED_WINDOW, rate), calm = std::llround(RESPONSE_CALM * rate);
  const std::size_t never = held.size();
  std::size_t since = never;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double speed = gap_speed(held, k, half, rate);
    if (std::isnan(speed)) continue;
    if (std::abs(speed) >= RESPONSE_SPEED) {
      since = never;
    } else if (since == never) {
      since = k;
    }
    if (since != never && held[k].number - held[since].number >= calm) return since;
  }
  return never;
}

// The way from upright to the tilt that is maintained: [first, last], ticks of the grasp.
struct TiltWay {
  std::size_t first = 0, last = 0;
  bool is_there = false;
};

TiltWay tilt_way(std::span<const Tick> held, double largest) {
  const auto is_tilting = [](const Tick& tick) { return tick.state == SessionState::tilt; };
  const auto first = std::find_if(held.begin(), held.end(), is_tilting);
  if (first == held.end()) return {};
  // arrived: where it no longer turns, or turns back, within what counts as maintained of the largest tilt
  const auto near = std::find_if(first, held.end(), [largest](const Tick& tick) { return tick.tilt >= largest - MAINTAIN_CHANGE; });
  auto last = near;
  while (last != held.end() && is_tilting(*last) && last->tilt < largest) ++last;
  if (last == held.end()) --last;
  return {static_cast<std::size_t>(first - held.begin()), static_cast<std::size_t>(last - held.begin()), true};
}

// Mean of what lies between two numbers of ticks, both included.
double mean_between(std::span<const Tick> held, double Tick::*member, std::int64_t from, std::int64_t to) {
  MeanSum sum;
  const auto first = std::partition_point(held.begin(), held.end(), [from](const Tick& tick) { return tick.number < from; });
  for (auto tick = first; tick != held.end() && tick->number <= to; ++tick) sum.add((*tick).*member);
  return sum.result().mean;
}

// From the mean over half a window before the way to the mean over half a window after it: where the tilt rests, not while it changes.
double change_over(std::span<const Tick> held, double Tick::*member, const TiltWay& way, std::int64_t half) {
  const std::int64_t first = held[way.first].number, last = held[way.last].number;
  return mean_between(held, member, last, last + half) - mean_between(held, member, first - half, first);
}

GripCourse course_of(const GraspReport& grasp) {
  if (!(grasp.largest_tilt >= LEAST_ANALYZED) || !std::isfinite(grasp.grip_change) || !std::isfinite(grasp.normal_increase))
    return GripCourse::not_analyzed;
  if (grasp.turning_back > EQUAL_FORCE) return GripCourse::complex;
  const double difference = grasp.grip_change - grasp.normal_increase;
  if (std::abs(difference) < EQUAL_FORCE) return GripCourse::equal;
  return difference > 0 ? GripCourse::more : GripCourse::less;
}

void measure_tilt(GraspReport& grasp, std::span<const Tick> held, const TiltWay& way, double rate, bool is_lost) {
  const std::int64_t half = half_window(COURSE_WINDOW, rate);
  const auto of_way = [&way](const std::vector<double>& values) {
    return std::span(values).subspan(way.first, way.last - way.first + 1);
  };
  grasp.tilt_start = static_cast<double>(held[way.first].number) / rate;
  // a grip that was lost on the way has no end of it
  if (is_lost && way.last + 1 == held.size()) return;
  grasp.tilt_time = static_cast<double>(held[way.last].number - held[way.first].number) / rate;
  grasp.normal_increase = change_over(held, &Tick::normal_force, way, half);
  grasp.grip_change = change_over(held, &Tick::user_force, way, half);
  const auto grip = smoothed(held, &Tick::user_force, half), normal = smoothed(held, &Tick::normal_force, half);
  grasp.turning_back = std::max(0.0, turning_back(of_way(grip)) - turning_back(of_way(normal)));
  grasp.course = course_of(grasp);
}

// Mean grip force over half a window from the first tick on that is maintained.
double maintained_at_first(std::span<const Tick> held, const TiltWay& way, double rate) {
  const auto is_maintained = [](const Tick& tick) { return tick.state == SessionState::maintain; };
  const auto first = std::find_if(held.begin() + static_cast<std::ptrdiff_t>(way.last), held.end(), is_maintained);
  MeanSum sum;
  for (auto tick = first; tick != held.end() && tick->number - first->number <= half_window(COURSE_WINDOW, rate); ++tick)
    if (is_maintained(*tick)) sum.add(tick->user_force);
  return sum.result().mean;
}

// The grip force when the gap has come to rest, and before, during and after the tilt.
void measure_grip(GraspReport& grasp, std::span<const Tick> held, std::size_t at_rest, const TiltWay& way, double rate) {
  MeanSum settling, before, during, after;
  const std::int64_t calm = std::llround(RESPONSE_CALM * rate);
  const bool has_rest = at_rest < held.size();
  for (std::size_t k = has_rest ? at_rest : 0; k < held.size(); ++k) {
    const Tick& tick = held[k];
    if (has_rest && tick.number - held[at_rest].number <= calm) settling.add(tick.user_force);
    if (tick.state == SessionState::lift && (!way.is_there || k < way.first)) before.add(tick.user_force);
    if (tick.state == SessionState::maintain && way.is_there && k >= way.last) after.add(tick.user_force);
  }
  for (std::size_t k = way.first; way.is_there && k <= way.last; ++k) {
    if (held[k].state == SessionState::tilt) during.add(held[k].user_force);
  }
  grasp.tightened = settling.result().mean;
  grasp.before = before.result();
  grasp.during = during.result();
  grasp.after = after.result();
  if (way.is_there) grasp.after_at_first = maintained_at_first(held, way, rate);
}

// The grip of a tick that holds a vessel. The hand keeps it until it lets go.
std::optional<GripInput> grip_in(const Tick& tick) {
  const core_f64::Mat3 inward = glm::transpose(to_mat3(tick.vessel_rotation));
  const auto tip = [&](std::size_t k) { return inward * (to_vec3(tick.proxies[k]) - to_vec3(tick.vessel_place)); };
  const std::optional<GripInput> grip = grip_of_tips({tip(0), tip(1)}, inward * to_mat3(tick.hand_rotation));
  if (!grip) return std::nullopt;
  const auto numbers = grip_numbers(*grip);
  const bool is_finite = std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
  return is_finite ? grip : std::nullopt;
}

SlipReport slip_in(std::span<const Tick> held, double rate) {
  SlipReport slip;
  if (std::isnan(held.front().safety_margin)) return slip;
  slip.slips = slip.distance = 0;
  std::int64_t below = 0;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const Tick& tick = held[k];
    if (tick.slip_speed > 0 && (k == 0 || !(held[k - 1].slip_speed > 0))) ++slip.slips;
    if (tick.safety_margin < 0) below += periods_of(held, k);
    if (!(tick.safety_margin >= slip.least_margin)) slip.least_margin = tick.safety_margin;
    slip.distance = std::max(slip.distance, tick.slip_distance);
    slip.turned = tick.slip_angle;
  }
  slip.below_hold = static_cast<double>(below) / rate;
  return slip;
}

}  // namespace

GraspReport measure_grasp(std::span<const Tick> held, double rate, bool is_lost) {
  GraspReport grasp;
  grasp.vessel = held.front().vessel;
  grasp.guidance = held.front().guidance;
  grasp.start = static_cast<double>(held.front().number) / rate;
  grasp.end = static_cast<double>(held.back().number + 1) / rate;
  std::array<std::int64_t, 3> periods{};
  for (std::size_t k = 0; k < held.size(); ++k) {
    periods[static_cast<std::size_t>(held[k].state) - static_cast<std::size_t>(SessionState::lift)] += periods_of(held, k);
    if (held[k].tilt > grasp.largest_tilt) grasp.largest_tilt = held[k].tilt;
    if (std::isnan(grasp.guidance_distance)) grasp.guidance_distance = held[k].guidance_distance;
    if (!grasp.grip) grasp.grip = grip_in(held[k]);
  }
  for (std::size_t k = 0; k < periods.size(); ++k) grasp.duration[k] = static_cast<double>(periods[k]) / rate;
  grasp.slip = slip_in(held, rate);
  const TiltWay way = tilt_way(held, grasp.largest_tilt);
  // a gap that comes to rest only during the tilt is no response to F_base
  const auto before_tilt = way.is_there ? held.first(way.first) : held;
  std::size_t at_rest = first_at_rest(before_tilt, rate);
  if (at_rest == before_tilt.size()) at_rest = held.size();
  if (at_rest < held.size()) grasp.response_time = static_cast<double>(held[at_rest].number - held.front().number) / rate;
  measure_grip(grasp, held, at_rest, way, rate);
  if (way.is_there) measure_tilt(grasp, held, way, rate, is_lost);
  const auto vessel = static_cast<std::size_t>(std::max(0, grasp.vessel));
  grasp.poured = held.front().volume[vessel] - held.back().volume[vessel];
  return grasp;
}

}  // namespace wholehand::device
