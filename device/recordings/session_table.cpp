// SPDX-License-Identifier: MIT
// A session's report as tables: for people, and as CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files/csv.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "device/recordings/session_report.h"

namespace wholehand::device {
namespace {

// "-" where there is none.
std::string shown(double value, double unit, int digits) { return std::isfinite(value) ? fixed_text(value / unit, digits) : "-"; }

std::string shown(const MeanDeviation& value, double unit, int digits) {
  if (value.count == 0) return "-";
  if (value.count == 1) return shown(value.mean, unit, digits);
  return fixed_text(value.mean / unit, digits) + " +- " + fixed_text(value.deviation / unit, digits);
}

const char* shown_course(GripCourse course) {
  return course == GripCourse::not_analyzed ? "-" : GRIP_COURSE_NAMES[static_cast<std::size_t>(course)];
}

// A table whose columns are as wide as what is in them; the first to the left, the others to the right. Only the last cells of a row may be
// empty.
class ColumnTable {
 public:
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  void write(std::string& out) const {
    std::vector<std::size_t> widths;
    for (const auto& cells : rows_) {
      widths.resize(std::max(widths.size(), cells.size()));
      for (std::size_t k = 0; k < cells.size(); ++k) widths[k] = std::max(widths[k], cells[k].size());
    }
    for (const auto& cells : rows_) {
      for (std::size_t k = 0; k < cells.size(); ++k) {
        if (k == 0) append_formatted(out, "  {:<{}}", cells[k], widths[k]);
        if (k > 0 && !cells[k].empty()) append_formatted(out, "  {:>{}}", cells[k], widths[k]);
      }
      append_formatted(out, "\n");
    }
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

void write_heading(std::string& out, const SessionReport& report) {
  const RecordingInfo& info = report.info;
  append_formatted(out, "Session of {} s in {}, on {}, {} Hz{}{}\n", fixed_text(report.duration, 3),
                   info.scene_name.empty() ? info.scene_file : info.scene_name, info.device.name, plain_text(info.rate),
                   info.start.empty() ? "" : ", ", info.start);
  if (report.fault != Fault::none)
    append_formatted(
        out, "  {}{}\n",
        report.fault == Fault::interrupted ? "ended by a signal, or because nobody read its output any more" : "ended by a fault: ",
        report.fault == Fault::interrupted ? "" : FAULT_NAMES[static_cast<std::size_t>(report.fault)]);
  ColumnTable states;
  states.row({"state", "s"});
  for (std::size_t k = 0; k < report.time_in_state.size(); ++k)
    states.row({SESSION_STATE_NAMES[k], shown(report.time_in_state[k], 1, 3)});
  states.write(out);
  append_formatted(out, "  grasps {}, lost {}, destinations {}{}\n", report.grasps.size(), report.lost, report.destinations,
                   report.task_done ? ", task done" : "");
}

void write_grasps(std::string& out, const SessionReport& report) {
  if (report.grasps.empty()) return;
  append_formatted(out, "\nGrasps: times in s, response in ms, forces in N, tilt in degrees, distance in mm, volumes in mL\n");
  ColumnTable table;
  table.row({"vessel", "start", "lift", "tilt", "maintain", "response", "stopped", "before", "during", "after", "largest tilt",
             "normal rise", "grip change", "type", "guidance", "poured", "arrived", "spilled", "end"});
  for (const GraspReport& grasp : report.grasps) {
    table.row({report.info.vessels[static_cast<std::size_t>(grasp.vessel)].name, shown(grasp.start, 1, 3),
               shown(grasp.duration[0], 1, 3), shown(grasp.duration[1], 1, 3), shown(grasp.duration[2], 1, 3),
               shown(grasp.response_time, 1e-3, 0), shown(grasp.tightened, 1, 2), shown(grasp.before, 1, 2),
               shown(grasp.during, 1, 2), shown(grasp.after, 1, 2), shown(degrees(grasp.largest_tilt), 1, 1),
               shown(grasp.normal_increase, 1, 2), shown(grasp.grip_change, 1, 2), shown_course(grasp.course),
               shown(grasp.guidance_distance, 1e-3, 1), shown(grasp.poured, 1e-6, 1), shown(grasp.arrived, 1e-6, 1),
               shown(grasp.spilled, 1e-6, 1), GRASP_OUTCOME_NAMES[static_cast<std::size_t>(grasp.outcome)]});
  }
  table.write(out);
  for (const GraspReport& grasp : report.grasps) {
    if (!(grasp.saturated > 0)) continue;
    append_formatted(out,
                     "  {} at {} s: the feedback was at F_max for {} s; at F_max the gripper renders neither torque nor grip\n",
                     report.info.vessels[static_cast<std::size_t>(grasp.vessel)].name, fixed_text(grasp.start, 3),
                     fixed_text(grasp.saturated, 3));
  }
  for (const GraspReport& grasp : report.grasps) {
    if (!(grasp.slip.slips > 0) && !(grasp.slip.below_hold > 0)) continue;
    append_formatted(out, "  {} at {} s: slid {} in the fingers, by {} mm and {} degrees; {} s with less grip than holding takes\n",
                     report.info.vessels[static_cast<std::size_t>(grasp.vessel)].name, fixed_text(grasp.start, 3),
                     counted(static_cast<std::size_t>(grasp.slip.slips), "time"), fixed_text(1e3 * grasp.slip.distance, 1),
                     fixed_text(degrees(grasp.slip.turned), 1), fixed_text(grasp.slip.below_hold, 3));
  }
  append_formatted(out, "\nBy vessel, mean +- deviation over grasps: times in s, forces in N\n");
  ColumnTable summary;
  summary.row({"vessel", "grasps", "lost", "G1", "G2", "G3", "G4", "response", "stopped", "before", "during", "after",
               "normal rise", "grip change", "tilting"});
  for (const GraspSummary& s : report.vessels) {
    std::vector<std::string> cells{s.name, fmt::format("{}", s.grasps), fmt::format("{}", s.lost)};
    for (std::size_t k = 1; k < s.courses.size(); ++k) cells.push_back(fmt::format("{}", s.courses[k]));
    for (const MeanDeviation& value :
         {s.response_time, s.tightened, s.before, s.during, s.after, s.normal_increase, s.grip_change, s.tilt_time})
      cells.push_back(shown(value, 1, 3));
    summary.row(cells);
  }
  summary.write(out);
}

void write_amounts(std::string& out, const SessionReport& report) {
  if (report.amounts.empty()) return;
  append_formatted(out, "\n");
  ColumnTable table;
  table.row({"liquid", "arrived mL", "spilled mL", "wanted mL", ""});
  for (const PouredAmount& amount : report.amounts) {
    const bool is_wanted = std::isfinite(amount.wanted);
    table.row({amount.liquid.empty() ? "(no name)" : amount.liquid, shown(amount.arrived, 1e-6, 2), shown(amount.spilled, 1e-6, 2),
               shown(amount.wanted, 1e-6, 2),
               !is_wanted         ? ""
               : amount.is_within ? "within tolerance"
                                  : "not within tolerance"});
  }
  table.write(out);
}

void write_timing(std::string& out, const SessionReport& report) {
  append_formatted(out, "\n");
  if (!report.info.has_clock) {
    append_formatted(out, "timing: none, as the session ran without a clock; ticks recorded {}\n", readable_number(report.ticks));
    return;
  }
  ColumnTable table;
  table.row({"timing, us", "median", "99 %", "99.9 %", "largest"});
  const auto row = [&table](const char* name, const Percentiles& p) {
    table.row({name, shown(p.p50, 1e-6, 1), shown(p.p99, 1e-6, 1), shown(p.p999, 1e-6, 1), shown(p.max, 1e-6, 1)});
  };
  row("period", report.period);
  row("step", report.step);
  row("latency", report.latency);
  table.write(out);
  append_formatted(out, "  periods missed {}, recorded {}\n", readable_count(static_cast<double>(report.missed)),
                   readable_number(report.ticks));
}

std::string csv_vessel(const SessionReport& report, int vessel) {
  return vessel < 0 ? std::string() : csv_text(report.info.vessels[static_cast<std::size_t>(vessel)].name);
}

}  // namespace

std::string session_table(const SessionReport& report) {
  std::string text;
  write_heading(text, report);
  write_grasps(text, report);
  write_amounts(text, report);
  if (report.ticks > 0) write_timing(text, report);
  if (!report.grasps.empty()) text += "\n" + report.scatter.table();
  return text;
}

const char* const GRASP_COLUMNS =
    "start_s,end_s,lift_s,tilt_s,maintain_s,response_time_s,grip_stopped_N,grip_before_N,grip_before_deviation_N,grip_during_N,"
    "grip_during_deviation_N,grip_after_N,grip_after_deviation_N,largest_tilt_deg,tilt_start_s,tilt_time_s,normal_increase_N,"
    "grip_change_N,turning_back_N,saturated_s,slips,slip_mm,slip_turned_deg,below_hold_s,least_margin_N,type,guidance_distance_mm,"
    "poured_ml,arrived_ml,spilled_ml,outcome";

std::string grasp_cells(const GraspReport& grasp) {
  std::string cells;
  for (const double value : {grasp.start,
                             grasp.end,
                             grasp.duration[0],
                             grasp.duration[1],
                             grasp.duration[2],
                             grasp.response_time,
                             grasp.tightened,
                             grasp.before.mean,
                             grasp.before.deviation,
                             grasp.during.mean,
                             grasp.during.deviation,
                             grasp.after.mean,
                             grasp.after.deviation,
                             degrees(grasp.largest_tilt),
                             grasp.tilt_start,
                             grasp.tilt_time,
                             grasp.normal_increase,
                             grasp.grip_change,
                             grasp.turning_back,
                             grasp.saturated})
    cells += csv_number(value) + ",";
  const SlipReport& slip = grasp.slip;
  for (const double value : {slip.slips, 1e3 * slip.distance, degrees(slip.turned), slip.below_hold, slip.least_margin})
    cells += csv_number(value) + ",";
  return cells + fmt::format("{},{},{},{},{},{}", GRIP_COURSE_NAMES[static_cast<std::size_t>(grasp.course)],
                             csv_number(grasp.guidance_distance, 1e-3), csv_number(grasp.poured, 1e-6),
                             csv_number(grasp.arrived, 1e-6), csv_number(grasp.spilled, 1e-6),
                             GRASP_OUTCOME_NAMES[static_cast<std::size_t>(grasp.outcome)]);
}

std::string grasps_csv(const SessionReport& report) {
  std::string csv = fmt::format("grasp,vessel,{}\n", GRASP_COLUMNS);
  for (std::size_t k = 0; k < report.grasps.size(); ++k)
    csv += fmt::format("{},{},{}\n", k + 1, csv_vessel(report, report.grasps[k].vessel), grasp_cells(report.grasps[k]));
  return csv;
}

std::string states_csv(const SessionReport& report) {
  std::string csv = "start_s,duration_s,state,vessel\n";
  for (const StateRun& run : report.runs) {
    csv += fmt::format("{},{},{},{}\n", csv_number(run.start), csv_number(run.duration),
                       SESSION_STATE_NAMES[static_cast<std::size_t>(run.state)], csv_vessel(report, run.vessel));
  }
  return csv;
}

}  // namespace wholehand::device
