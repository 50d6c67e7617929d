// SPDX-License-Identifier: MIT
#include "device/recordings/session_report.h"

#include <algorithm>
#include <cmath>

#include "device/recordings/grasp_collector.h"

namespace wholehand::device {
namespace {

// Nearest rank: the smallest value that the wanted share of all do not exceed. `values` in any order; none: zeros.
Percentiles percentiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto rank = [&values](double share) {
    const double at = std::ceil(share * static_cast<double>(values.size())) - 1;
    return values[static_cast<std::size_t>(std::max(0.0, at))];
  };
  return {rank(0.5), rank(0.99), rank(0.999), values.back()};
}

// [first, end) of ticks that belong together.
struct TickRange {
  std::size_t first, end;
};

// Splits the ticks where `is_same` says that one does not go on from the one before.
template <class IsSame>
std::vector<TickRange> split(const std::vector<Tick>& ticks, IsSame is_same) {
  std::vector<TickRange> ranges;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 0 || !is_same(ticks[k - 1], ticks[k])) ranges.push_back({k, k});
    ranges.back().end = k + 1;
  }
  return ranges;
}

// `vessel` -1: all.
GraspSummary summarize(const std::vector<GraspReport>& grasps, int vessel, const std::string& name) {
  GraspSummary summary;
  summary.name = name;
  MeanSum response, tightened, before, during, after, normal, change, time;
  for (const GraspReport& grasp : grasps) {
    if (vessel >= 0 && grasp.vessel != vessel) continue;
    ++summary.grasps;
    summary.lost += grasp.outcome == GraspOutcome::lost;
    ++summary.courses[static_cast<std::size_t>(grasp.course)];
    response.add(grasp.response_time);
    tightened.add(grasp.tightened);
    before.add(grasp.before.mean);
    during.add(grasp.during.mean);
    after.add(grasp.after.mean);
    if (grasp.course == GripCourse::not_analyzed) continue;
    normal.add(grasp.normal_increase);
    change.add(grasp.grip_change);
    time.add(grasp.tilt_time);
  }
  summary.response_time = response.result();
  summary.tightened = tightened.result();
  summary.before = before.result();
  summary.during = during.result();
  summary.after = after.result();
  summary.normal_increase = normal.result();
  summary.grip_change = change.result();
  summary.tilt_time = time.result();
  return summary;
}

// By liquid, in the order of the vessels; then what the task asks for and no vessel holds.
std::vector<PouredAmount> amounts_of(const RecordingInfo& info, const Tick& last) {
  std::vector<PouredAmount> amounts;
  const auto of = [&amounts](const std::string& liquid) -> PouredAmount& {
    const auto found = std::find_if(amounts.begin(), amounts.end(), [&](const PouredAmount& a) { return a.liquid == liquid; });
    if (found != amounts.end()) return *found;
    amounts.emplace_back().liquid = liquid;
    return amounts.back();
  };
  for (std::size_t v = 0; v < info.vessels.size(); ++v) {
    if (info.vessels[v].liquid.empty() && last.arrived[v] == 0 && last.spilled[v] == 0) continue;
    PouredAmount& amount = of(info.vessels[v].liquid);
    amount.arrived += last.arrived[v];
    amount.spilled += last.spilled[v];
  }
  for (const RecordedAmount& wanted : info.amounts) of(wanted.liquid).wanted = wanted.volume;
  for (PouredAmount& amount : amounts) amount.is_within = std::abs(amount.arrived - amount.wanted) <= info.tolerance;
  return amounts;
}

void measure_timing(SessionReport& report, const std::vector<Tick>& ticks) {
  const double rate = report.info.rate;
  std::vector<double> periods, steps, latencies;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    steps.push_back(ticks[k].step_time);
    latencies.push_back(ticks[k].latency);
    if (k == 0) continue;
    const auto numbers = static_cast<double>(ticks[k].number - ticks[k - 1].number);
    periods.push_back(numbers / rate + ticks[k].latency - ticks[k - 1].latency);
  }
  report.period = percentiles_of(std::move(periods));
  report.step = percentiles_of(std::move(steps));
  report.latency = percentiles_of(std::move(latencies));
  report.missed = ticks.back().number - ticks.front().number + 1 - static_cast<std::int64_t>(ticks.size());
}

void measure_states(SessionReport& report, const std::vector<Tick>& ticks) {
  const double rate = report.info.rate;
  std::array<std::int64_t, SESSION_STATES> periods{};
  for (std::size_t k = 0; k < ticks.size(); ++k) periods[static_cast<std::size_t>(ticks[k].state)] += periods_of(ticks, k);
  for (std::size_t k = 0; k < periods.size(); ++k) report.time_in_state[k] = static_cast<double>(periods[k]) / rate;
  const auto runs = split(ticks, [](const Tick& a, const Tick& b) { return a.state == b.state && a.vessel == b.vessel; });
  for (const TickRange& run : runs) {
    const std::int64_t end = run.end < ticks.size() ? ticks[run.end].number : ticks.back().number + 1;
    report.runs.push_back({ticks[run.first].state, ticks[run.first].vessel, static_cast<double>(ticks[run.first].number) / rate,
                           static_cast<double>(end - ticks[run.first].number) / rate});
  }
}

}  // namespace

SessionReport report_session(const Recording& recording) {
  const std::vector<Tick>& ticks = recording.ticks;
  SessionReport report;
  report.info = recording.info;
  report.note = recording.note;
  report.ticks = ticks.size();
  if (!ticks.empty()) {
    report.duration = static_cast<double>(ticks.back().number - ticks.front().number + 1) / recording.info.rate;
    const auto fault = std::find_if(ticks.begin(), ticks.end(), [](const Tick& tick) { return tick.fault != Fault::none; });
    if (fault != ticks.end()) report.fault = fault->fault;
    measure_states(report, ticks);
    measure_timing(report, ticks);
    report.grasps = grasps_of(recording);
    report.scatter.add(report.grasps);
    report.lost = ticks.back().lost;
    report.destinations = ticks.back().destinations;
    report.task_done = ticks.back().task_done;
    report.amounts = amounts_of(recording.info, ticks.back());
  }
  for (std::size_t v = 0; v < recording.info.vessels.size(); ++v)
    report.vessels.push_back(summarize(report.grasps, static_cast<int>(v), recording.info.vessels[v].name));
  report.vessels.push_back(summarize(report.grasps, -1, "all"));
  return report;
}

}  // namespace wholehand::device
