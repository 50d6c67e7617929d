// SPDX-License-Identifier: MIT
// Statistics of a recorded session: for each grasp, each vessel and all. docs/session.md has every definition.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "device/recordings/grasp_measure.h"
#include "device/recordings/grip_scatter.h"
#include "device/recordings/recording.h"

namespace wholehand::device {

// A stretch of ticks in one state, of one vessel.
struct StateRun {
  SessionState state = SessionState::free;
  int vessel = -1;
  double start = 0, duration = 0;  // s
};

// Statistics of several grasps: of a vessel, or all. Means and deviations are over grasps, not over ticks.
struct GraspSummary {
  std::string name;  // of the vessel; "all"
  int grasps = 0, lost = 0;
  std::array<int, GRIP_COURSES> courses{};  // by GripCourse; grasps of the first are not analyzed
  // response in s, forces in N; the last three only for analyzed grasps
  MeanDeviation response_time, tightened, before, during, after, normal_increase, grip_change, tilt_time;
};

struct PouredAmount {
  std::string liquid;
  double wanted = Tick::NONE;       // m3; NaN: the task does not ask for it
  double arrived = 0, spilled = 0;  // m3
  bool is_within = false;           // the task's tolerance
};

struct SessionReport {
  RecordingInfo info;
  std::string note;  // about the file's end
  std::size_t ticks = 0;
  double duration = 0;                                 // s
  Fault fault = Fault::none;                           // the first
  std::array<double, SESSION_STATES> time_in_state{};  // s
  std::vector<StateRun> runs;
  std::vector<GraspReport> grasps;
  std::vector<GraspSummary> vessels;  // one each, and one for all
  GripScatter scatter;
  int lost = 0, destinations = 0;  // as the session counted
  bool task_done = false;
  std::vector<PouredAmount> amounts;  // by liquid
  Percentiles period, step, latency;  // over the recorded ticks, s
  std::int64_t missed = 0;            // numbers without a tick
};

// Without ticks: all empty.
SessionReport report_session(const Recording& recording);

// For people, in mm, degrees, mL and ms.
std::string session_table(const SessionReport& report);
// One object in one line, SI units; null for a missing number.
std::string session_json(const SessionReport& report);
// The measures of a grasp as cells of a CSV file, and their columns.
extern const char* const GRASP_COLUMNS;
std::string grasp_cells(const GraspReport& grasp);
// A row each.
std::string grasps_csv(const SessionReport& report);
std::string states_csv(const SessionReport& report);

}  // namespace wholehand::device
