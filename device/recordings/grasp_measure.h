// SPDX-License-Identifier: MIT
// Measures one grasp of a recorded session in the paper's terms. docs/session.md has every definition.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/result.h"
#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand::device {

constexpr double RESPONSE_SPEED = 2e-3;         // m/s: a slower gap has come to rest,
constexpr double RESPONSE_CALM = 50e-3;         // s: if it stays so for this long
constexpr double SPEED_WINDOW = 20e-3;          // s: window of the line fit whose slope is the gap's speed
constexpr double COURSE_WINDOW = 0.2;           // s: averaging window of forces before their courses are compared
constexpr double EQUAL_FORCE = 0.1;             // N: a smaller difference counts as none
constexpr double LEAST_ANALYZED = radians(30);  // a grasp that is tilted less is not analyzed
constexpr double MAINTAIN_CHANGE = radians(5);  // a tilt that changes less counts as maintained

struct MeanDeviation {
  double mean = Tick::NONE, deviation = Tick::NONE;  // deviation: of a sample, NaN for fewer than two
  std::size_t count = 0;
};

// Adds up numbers and skips those that are not finite.
class MeanSum {
 public:
  void add(double value);
  MeanDeviation result() const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0;  // squares: of the differences from the mean
};

// The course of the user's grip force over a tilt, compared with the rise of the normal force.
enum class GripCourse : std::uint8_t { not_analyzed, equal, more, less, complex };
constexpr int GRIP_COURSES = 5;
extern const std::array<const char*, GRIP_COURSES> GRIP_COURSE_NAMES;  // "", "G1", .. "G4"

enum class GraspOutcome : std::uint8_t { let_go, lost, released, recording_ends };
extern const std::array<const char*, 4> GRASP_OUTCOME_NAMES;

// How the vessel slid in the fingers; all NaN where sliding is off.
struct SlipReport {
  double slips = Tick::NONE;         // times that it began to slide
  double distance = Tick::NONE;      // of the contacts along the surface, m
  double turned = Tick::NONE;        // in the fingers, with its sign, rad
  double below_hold = Tick::NONE;    // time with less grip than holding takes, s
  double least_margin = Tick::NONE;  // of the grip force over what holding takes, N; minus infinity where nothing holds

  bool is_measured() const { return slips >= 0; }
};

// NaN: there is none. `grip` is computed as if the hand were a right one: azimuth, roll and offset of a left hand are mirrored, which does not change
// their deviations.
struct GraspReport {
  int vessel = -1;
  double start = 0, end = 0;            // of the grasp since the session's start, s; the end is that of its last tick's period
  std::array<double, 3> duration{};     // in lift, tilt and maintain, s
  double response_time = Tick::NONE;    // from the step of F_base until the gap is at rest, s
  double tightened = Tick::NONE;        // grip force when it came to rest, N
  MeanDeviation before, during, after;  // grip force in lift from then on, over the tilt, and while it is maintained, N
  double after_at_first = Tick::NONE;   // its mean over the first COURSE_WINDOW / 2 of the maintained tilt, N
  double largest_tilt = 0;              // rad
  double tilt_start = Tick::NONE;       // of the way to the maintained tilt, s
  double tilt_time = Tick::NONE;        // duration of that way, s
  double normal_increase = Tick::NONE;  // of the normal force over it, N
  double grip_change = Tick::NONE;      // of the user's grip force over it, N
  double turning_back = Tick::NONE;     // how far the grip force goes both up and down, beyond what the normal force does, N
  double saturated = 0;                 // time with the feedback at F_max, s; while tilted: the course is not analyzed
  GripCourse course = GripCourse::not_analyzed;
  GraspOutcome outcome = GraspOutcome::let_go;
  double guidance_distance = Tick::NONE;  // m
  int guidance = -1;                      // number of the guidance point that was shown; -1: none
  std::optional<GripInput> grip;          // absent: a number is not finite, or the line of the tips runs along the axis
  SlipReport slip;
  double poured = 0;                // over the lip during the grasp, m3
  double arrived = 0, spilled = 0;  // until the vessel's next grasp, m3
};

// The results that the ticks of one grasp (held, of one vessel, at least one) give by themselves: all but outcome, arrived and spilled. `rate` in Hz.
GraspReport measure_grasp(std::span<const Tick> held, double rate, bool is_lost);

// How long a tick counts, in periods: until the next one.
std::int64_t periods_of(std::span<const Tick> ticks, std::size_t k);

// The smaller of the largest rise and the largest fall between two values, in order: 0 if they only go one way.
double turning_back(std::span<const double> values);

}  // namespace wholehand::device
