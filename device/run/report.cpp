// SPDX-License-Identifier: MIT
#include "device/run/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "core/vectors.h"
#include "device/advice/words.h"

namespace wholehand::device {
namespace {

constexpr double ML = 1e6;  // a m3

std::string percentiles(const Histogram& times) {
  const auto microseconds = [](double seconds) { return fixed_text(seconds * 1e6, 1); };
  return fmt::format("p50 {}, p99 {}, p99.9 {}, largest {} us", microseconds(times.quantile(0.5)),
                     microseconds(times.quantile(0.99)), microseconds(times.quantile(0.999)), microseconds(times.largest()));
}

nlohmann::ordered_json percentiles_json(const Histogram& times) {
  return {{"p50", times.quantile(0.5)}, {"p99", times.quantile(0.99)}, {"p999", times.quantile(0.999)}, {"max", times.largest()}};
}

nlohmann::ordered_json advice_json(const AdviceTally& tally) {
  nlohmann::ordered_json json{{"on", tally.place}, {"updates", tally.updates}, {"grips", tally.grips}};
  json["updates_per_s"] = tally.seconds > 0 ? nlohmann::ordered_json(tally.rate()) : nlohmann::ordered_json();
  json["longest_s"] = tally.seconds > 0 ? nlohmann::ordered_json(tally.longest) : nlohmann::ordered_json();
  return json;
}

std::string board(const std::vector<MixedAmount>& amounts) {
  std::string line;
  for (const MixedAmount& amount : amounts) {
    line +=
        fmt::format("{}{} {:.1f} of {:.1f} mL", line.empty() ? "" : ", ", amount.liquid, amount.arrived * ML, amount.wanted * ML);
  }
  return line;
}

}  // namespace

Narrator::Narrator(const Scene& scene) : scene_(scene) {}

std::string Narrator::stamp(const Tick& tick) const {
  return fmt::format("{:8.2f} s  ", static_cast<double>(tick.number) / scene_.live.rate);
}

// The best place to take each vessel for the current task: its shown guidance point.
std::string Narrator::guidance(const Tick& tick) const {
  std::string points;
  for (const VesselData& vessel : scene_.vessels) {
    if (vessel.guidance.empty()) continue;
    const GuidancePoint& point = vessel.guidance[static_cast<std::size_t>(tick.guidance) % vessel.guidance.size()];
    points += fmt::format("{}{} at {:.0f} mm, {:.0f} deg", points.empty() ? "" : "; ", vessel.name, point.height * 1e3,
                          degrees(point.azimuth));
  }
  return points;
}

std::vector<std::string> Narrator::look(const Tick& tick) {
  std::vector<std::string> lines;
  if (tick.guidance >= 0 && tick.guidance != last_.guidance && !tick.task_done) {
    const std::string points = guidance(tick);
    if (!points.empty()) lines.push_back(stamp(tick) + "guidance points: " + points);
  }
  const auto name = [this](int vessel) { return vessel >= 0 ? scene_.vessels[vessel].name : std::string("a vessel"); };
  if (tick.destinations > last_.destinations) lines.push_back(stamp(tick) + name(tick.vessel) + " is at its destination");
  if (tick.lost > last_.lost) {
    lines.push_back(stamp(tick) + name(last_.vessel) + " slipped and returns to where it stood");
  } else if (is_held(last_.state) && !is_held(tick.state) && tick.state != SessionState::released) {
    lines.push_back(stamp(tick) + name(last_.vessel) + " was let go");
  }
  if (tick.grasps > last_.grasps && is_held(tick.state)) {
    std::string line = fmt::format("{}{} is held at {:.0f} mm", stamp(tick), name(tick.vessel), tick.grasp_height * 1e3);
    if (std::isfinite(tick.guidance_distance))
      line += fmt::format(", {:.0f} mm from the guidance point", tick.guidance_distance * 1e3);
    lines.push_back(line);
  }
  const std::vector<MixedAmount> before = mixing_board(scene_, last_), now = mixing_board(scene_, tick);
  for (std::size_t k = 0; k < now.size(); ++k) {
    const auto is_met = [&](const MixedAmount& amount) {
      return std::abs(amount.arrived - amount.wanted) <= scene_.task->tolerance;
    };
    if (is_met(now[k]) && !is_met(before[k])) {
      lines.push_back(
          fmt::format("{}{} mL of {} are in the target", stamp(tick), fmt::format("{:.1f}", now[k].arrived * ML), now[k].liquid));
    }
  }
  last_ = tick;
  return lines;
}

std::string Narrator::status(const Tick& tick) const {
  std::string line = fmt::format("{:.1f} s  {}", static_cast<double>(tick.number) / scene_.live.rate,
                                 SESSION_STATE_NAMES[static_cast<std::size_t>(tick.state)]);
  if (tick.vessel >= 0) line += fmt::format(" {}  tilt {:.0f} deg", scene_.vessels[tick.vessel].name, degrees(tick.tilt));
  line += fmt::format("  force {:.2f} N", tick.feedback);
  if (scene_.task) line += "  " + board(mixing_board(scene_, tick));
  return line;
}

std::optional<std::string> AdviceNarrator::narrate(const Advice& advice) {
  const bool is_new = advice.vessel != vessel_ || advice.is_held != is_held_;
  const std::string words = advice_words(advice);
  if (is_new && advice.vessel >= 0 && words.empty()) return std::nullopt;  // it may have some later
  vessel_ = advice.vessel;
  is_held_ = advice.is_held;
  if (!is_new || advice.vessel < 0) return std::nullopt;
  return fmt::format("{:8.2f} s  advice, {}: {}", static_cast<double>(advice.tick) / rate_,
                     scene_.vessels[static_cast<std::size_t>(advice.vessel)].name, words);
}

std::string tally_words(const AdviceTally& tally) {
  std::string words = fmt::format("computed on {}: {}", tally.place, counted(tally.updates, "update"));
  if (tally.updates > 0) words += fmt::format(" of {} on average", counted(tally.grips / tally.updates, "grip"));
  if (tally.seconds > 0) words += fmt::format(", {:.1f} a second, no two further apart than {:.2f} s", tally.rate(), tally.longest);
  return words;
}

std::string live_text(const LiveSummary& summary) {
  const LoopReport& loop = summary.loop;
  const Tick& last = loop.last;
  std::string text =
      fmt::format("{} with {}: {} s, {} at {} Hz\n", summary.scene.name, summary.gripper.name, fixed_text(summary.seconds, 1),
                  counted(static_cast<std::uint64_t>(loop.ticks), "tick"), plain_text(summary.scene.live.rate));
  text += fmt::format("  grasps {}, lost {}", last.grasps, last.lost);
  if (summary.scene.task)
    text += fmt::format(", destinations {}; {}", last.destinations, last.task_done ? "the task is done" : "the task is not done");
  text += "\n";
  if (summary.scene.task) {
    text += fmt::format("  amounts    {}; spilled {:.1f} mL\n", board(mixing_board(summary.scene, last)),
                        total_spilled(summary.scene, last) * ML);
  }
  if (summary.has_clock) {
    text += fmt::format("  period     {}; missed {}\n", percentiles(loop.period), readable_number(loop.missed));
    text += fmt::format("  wake-up    {}\n", percentiles(loop.latency));
    text += fmt::format("  step       {}; late {}\n", percentiles(loop.step), readable_number(loop.late));
  }
  if (summary.advice) text += "  advice     " + tally_words(*summary.advice) + "\n";
  for (const std::string& note : summary.notes) text += "  " + note + "\n";
  if (loop.fault == Fault::interrupted && summary.is_by_signal) text += "  ended by a signal\n";
  if (!summary.recording.empty())
    text += fmt::format("  recorded {}in {}\n", summary.is_recorded ? "" : "in part ", one_line(summary.recording));
  return text;
}

std::string live_json(const LiveSummary& summary) {
  const LoopReport& loop = summary.loop;
  const Tick& last = loop.last;
  nlohmann::ordered_json json{
      {"scene", summary.scene.name},
      {"device", {{"name", summary.gripper.name}, {"address", summary.gripper.address}}},
      {"rate_Hz", summary.scene.live.rate},
      {"seconds", summary.seconds},
      {"ticks", loop.ticks},
      {"fault", loop.fault == Fault::none ? nlohmann::ordered_json() : FAULT_NAMES[static_cast<std::size_t>(loop.fault)]},
      {"force", force_words(loop, summary.gripper.watchdog)},
      {"grasps", last.grasps},
      {"lost", last.lost},
      {"destinations", last.destinations},
      {"task_done", last.task_done}};
  json["amounts"] = nlohmann::ordered_json::array();
  for (const MixedAmount& amount : mixing_board(summary.scene, last)) {
    json["amounts"].push_back(
        {{"liquid", amount.liquid}, {"arrived_m3", amount.arrived}, {"wanted_m3", amount.wanted}, {"spilled_m3", amount.spilled}});
  }
  json["spilled_m3"] = total_spilled(summary.scene, last);
  if (summary.has_clock) {
    json["period_s"] = percentiles_json(loop.period);
    json["latency_s"] = percentiles_json(loop.latency);
    json["step_s"] = percentiles_json(loop.step);
    json["missed"] = loop.missed;
    json["late"] = loop.late;
  }
  if (summary.advice) json["advice"] = advice_json(*summary.advice);
  json["notes"] = summary.notes;
  json["recorded_wholly"] = summary.is_recorded;
  json["recording"] = summary.recording.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(summary.recording);
  return json_text(json, 2) + "\n";
}

bool is_force_left(const LoopReport& report) {
  return report.release == ReleaseResult::refused || report.release == ReleaseResult::not_attempted;
}

std::string force_words(const LoopReport& report, double watchdog) {
  SafeLine line;
  add_force_words(line, report.release, {norm(report.force.arm), std::abs(report.force.grip)}, watchdog, report.release_error);
  return std::string(line.text());
}

std::string fault_line(const LoopReport& report, const Guard& guard, const LiveData& live, double watchdog) {
  const double seconds = static_cast<double>(report.last.number) / live.rate;
  if (report.fault == Fault::none || report.fault == Fault::interrupted)
    return fmt::format("live: the session ended after {:.3f} s; {}", seconds, force_words(report, watchdog));
  std::string words = report.error;
  if (report.fault == Fault::jump) words = guard.jump();
  if (report.fault == Fault::stale) words = "the same measurement came twice";
  if (report.fault == Fault::late)
    words = fmt::format(
        "{} in a row took longer than a period, or their reads took longer than {:g} ms; [live] late_steps sets this number",
        counted(static_cast<std::uint64_t>(live.late_steps), "step"), CALL_PATIENCE * 1e3);
  if (report.fault == Fault::not_finite) words = "a value is not a number, or a rotation is not a unit quaternion";
  if (report.fault == Fault::ring_full) words = "the recording is too slow for the loop";
  return fmt::format("live: a fault ended the session after {:.3f} s: {}{}; {}", seconds,
                     FAULT_NAMES[static_cast<std::size_t>(report.fault)], words.empty() ? "" : " (" + words + ")",
                     force_words(report, watchdog));
}

}  // namespace wholehand::device
