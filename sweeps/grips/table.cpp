// SPDX-License-Identifier: MIT
// A grip report as tables, in the units that people read: mm, degrees, mL, g.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/joints.h"
#include "shaders/layout.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/states.h"

namespace wholehand::sweeps {
namespace {

using FingerValues = std::array<double, FINGER_COUNT - 1>;  // index to little finger

// `digits` behind the point, or what is known where lengths are known to `report.length_error`: what lengths enter has no more.
std::string known(const GripReport& report, double value, int digits) {
  constexpr int OF_LENGTHS = 3;  // of exact ones, mm
  return fixed_text(value, std::max(0, digits - OF_LENGTHS + known_digits(1e3 * report.length_error, OF_LENGTHS)));
}

std::string millimeters(const GripReport& report, const Triple& p) {
  return fmt::format("{:>9} {:>8} {:>8}", known(report, p[0] * 1e3, 3), known(report, p[1] * 1e3, 3), known(report, p[2] * 1e3, 3));
}

std::string millimeters(const GripReport& report, double length) { return known(report, length * 1e3, 3) + " mm"; }

const char* yes_no(bool value) { return value ? "yes" : "no"; }

// A hold force that comes from an effort is known to a thousandth: more digits would show two searches for one state as different.
std::string hold_newtons(double force, const GripReport& report) {
  return !std::isfinite(force) ? "infinite" : report.hold ? fmt::format("{:#.3g}", force) : known(report, force, 4);
}

// Fingers whose bit is set from `shift` on in a status; "none".
std::string finger_list(std::uint32_t bits) {
  std::string list;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    if ((bits >> f & 1) != 0) list += (list.empty() ? "" : ", ") + std::string(FINGER_NAMES[f]);
  }
  return list.empty() ? "none" : list;
}

// "flexion 12.3 deg".
std::string wrist_motion(const GripReport& report, double angle, const char* above, const char* below) {
  return fmt::format("{} {} deg", angle >= 0 ? above : below, known(report, degrees(std::abs(angle)), 3));
}

void write_closing(std::string& out, const GripReport& report) {
  const GripResult& r = report.answer.result;
  const bool is_feasible = r.reason == Reason::none;
  append_formatted(out, "  feasible       {}{}\n", yes_no(is_feasible),
                   is_feasible ? "" : fmt::format(": {}", REASON_NAMES[static_cast<std::size_t>(r.reason)]));
  if (!is_feasible && r.reason < Reason::too_wide) return;
  append_formatted(out, "  gap            {}\n", millimeters(report, r.gap));
  append_formatted(out, "  midpoint      {} mm\n", millimeters(report, r.midpoint));
  if (!is_feasible) return;
  append_formatted(out, "  closure        {}\n", known(report, r.closure, 6));
  append_formatted(out, "  contact angles thumb {}, index {} deg, antipodal: {}{}\n",
                   known(report, degrees(r.contact_angles[0]), 3), known(report, degrees(r.contact_angles[1]), 3),
                   yes_no(r.antipodal), r.grazing ? ", grazing" : "");
  append_formatted(out, "  plausible      {}: phalanges {} deep, palm {}{}\n", yes_no(r.plausible),
                   millimeters(report, r.phalanx_depth), millimeters(report, r.palm_depth),
                   fmt::format("{}{}", r.through_table ? "; the hand goes through the table" : "",
                               r.beyond_wrist ? "; wrist and forearm do not reach it within their ranges" : ""));
  if (!std::isnan(r.table_depth)) {
    append_formatted(out, "  table          {} {} the table and its clearance\n", millimeters(report, std::abs(r.table_depth)),
                     r.through_table ? "below" : "above");
  }
  if (!std::isnan(r.self_depth)) {
    append_formatted(out, "  fingers        {} {}{}\n", millimeters(report, std::abs(r.self_depth)),
                     r.self_depth > 0 ? "in each other" : "apart from each other at least",
                     r.self_overlap ? ": deeper than the depth limit" : "");
  }
  if (!std::isnan(r.wrist_share)) {
    append_formatted(out, "  wrist          {}, {}, {}: {} % of a range{}\n",
                     wrist_motion(report, r.wrist_angles[0], "flexion", "extension"),
                     wrist_motion(report, r.wrist_angles[1], "ulnar", "radial"),
                     wrist_motion(report, r.wrist_angles[2], "pronation", "supination"), known(report, 100 * r.wrist_share, 3),
                     r.beyond_wrist ? ", beyond it" : "");
  }
  append_formatted(out, "  bone stretch   {}\n", millimeters(report, r.bone_stretch));
  append_formatted(out, "  fingers used   {}\n", finger_list(r.used_mask));
  if ((r.status & STATUS_CONTACT_UNDECIDED) != 0)
    append_formatted(
        out,
        "  undecided      rounding may decide whether a point of the hand is a contact: efforts are those with it or without\n");
  const std::uint32_t blocked = r.status >> STATUS_BLOCKED_SHIFT & 0x1F, unsettled = r.status >> STATUS_UNSETTLED_SHIFT & 0x1F;
  if (blocked != 0) append_formatted(out, "  blocked        {}: inside the vessel even when open\n", finger_list(blocked));
  if (unsettled != 0) append_formatted(out, "  not settled    {}: used all its steps and is not at rest\n", finger_list(unsettled));
  if ((r.status & STATUS_PROXY_UNSETTLED) != 0)
    append_formatted(out, "  not settled    a proxy: used all its steps and is not at rest\n");
}

void write_joints(std::string& out, const GripReport& report) {
  const GripResult& r = report.answer.result;
  append_formatted(out, "\n  points, mm     {:^27}{:^27}{:^27}{:>11}  {}\n", "rigged", "posed", "proxy", "separation", "contact");
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const auto has = [j](std::uint32_t mask) { return (mask >> j & 1) != 0; };
    const char* role = has(r.tip_mask)      ? ", projected: tip"
                       : has(r.finger_mask) ? ", projected: finger"
                       : has(r.inner_mask)  ? ", projected: inner"
                                            : "";
    append_formatted(out, "  {:<13}{}{}{}{:>11}  {}{}\n", JOINT_NAMES[j].paper, millimeters(report, r.joints[j]),
                     millimeters(report, r.posed[j]), millimeters(report, r.proxies[j]), known(report, r.separation[j] * 1e3, 4),
                     has(r.touch_mask) ? "touches" : "-", role);
  }
}

// Which way a torque about the tilt's direction turns the vessel: the paper's has none.
const char* way_of(double exact_torque) { return exact_torque > 0 ? "over" : exact_torque < 0 ? "back" : "-"; }

void write_states(std::string& out, const GripReport& report) {
  if (report.answer.states.empty()) return;
  const auto head = [&out](const std::array<const char*, 13>& words) {
    constexpr std::array<int, 13> WIDTHS{5, 7, 9, 9, 9, 28, 9, 10, 10, 6, 9, 9, 9};
    append_formatted(out, "  ");
    for (std::size_t k = 0; k < words.size(); ++k) append_formatted(out, "{:>{}}", words[k], WIDTHS[k]);
    append_formatted(out, "\n");
  };
  append_formatted(out, "\n");
  head({"fill", "tilt", "liquid", "poured", "mass", "center of mass", "pivot", "torque", "exact", "turns", "normal", "feedback",
        "hold"});
  head({report.capacity > 0 ? "mL" : "", "deg", "mL", "mL", "g", "mm", "mm", "mN m", "mN m", "", "N", "N", "N"});
  for (const GripState& s : report.answer.states) {
    append_formatted(out, "  {:>5}{:>7} {:>8} {:>8} {:>8} {}", fill_number(report, s.fill), plain_text(degrees(s.tilt), 5),
                     known(report, s.liquid.volume * 1e6, 3), known(report, s.liquid.poured * 1e6, 3),
                     known(report, s.state.mass * 1e3, 3), millimeters(report, s.state.center_of_mass));
    if (!s.counts) {
      append_formatted(out, "  left out by until_poured\n");
      continue;
    }
    // rounded as they are shown, so that a torque of nothing turns nothing
    const std::string exact = known(report, std::abs(s.state.exact_torque) * 1e3, 4);
    const bool is_nothing = exact.find_first_not_of("0.") == std::string::npos;
    append_formatted(out, "{:>9} {:>9} {:>9} {:>5} {:>8} {:>8} {:>8}\n", known(report, s.state.pivot_length * 1e3, 3),
                     known(report, s.state.torque * 1e3, 4), exact, way_of(is_nothing ? 0 : s.state.exact_torque),
                     known(report, s.state.normal_force, 4), known(report, s.state.feedback_force, 4),
                     hold_newtons(s.state.hold_force, report));
  }
  append_formatted(
      out, "  torque: the paper's, without a sign; exact: that about the tilt's direction, which turns the vessel over or back\n");
}

// A share of the hand's strength, in percent.
std::string percent(double effort) {
  return std::isfinite(effort) ? fixed_text(effort * 100, 2) + " % of the hand's strength" : std::string("no force holds it");
}

std::string contact_name(const HeldContact& contact) {
  const std::string place = contact.between > 0 ? fmt::format(" bone {}", contact.between) : "";
  return JOINT_NAMES[contact.joint].paper + place + (contact.digit == FINGER_COUNT ? ", palm" : "");
}

// Names the numbers that come from the core where another device answers the rest.
void write_holding_source(std::string& out, const GripReport& report) {
  if (report.answer.is_core_double || report.holds.empty()) return;
  append_formatted(out, "\n  from the core  in double, for the hand above: hold forces, listed effort and contact forces{}\n",
                   report.answer.hold ? "" : ", and what holds over the scene's states");
}

// What each digit presses in the hardest of the states that were asked for.
void write_contacts(std::string& out, const GripReport& report) {
  const auto hardest = hardest_state(report);
  if (!hardest) return;
  const StateHold& hold = report.holds[*hardest];
  const GripState& state = report.answer.states[*hardest];
  // not "worst": the scene may have a worse one that is not listed, or none as bad
  append_formatted(out, "\n  listed effort  {}, in the hardest of the states listed above: {}, {} deg\n", percent(hold.effort),
                   fill_words(report, state.fill), plain_text(degrees(state.tilt)));
  append_formatted(out, "                 two tips alone in this state: {}\n", percent(hold.tips));
  if (hold.escape) {
    const auto& v = *hold.escape;
    append_formatted(out, "  unopposed      moving along ({}, {}, {}) m/s, turning by ({}, {}, {}) rad/s\n", fixed_text(v[0], 3),
                     fixed_text(v[1], 3), fixed_text(v[2], 3), fixed_text(v[3], 3), fixed_text(v[4], 3), fixed_text(v[5], 3));
    return;
  }
  append_formatted(out, "  {:<18}{:^27} {:^27}{:>9}\n", "presses at", "place, mm", "force, N", "mN m");
  for (const HeldContact& contact : hold.contacts) {
    if (contact.force == Triple{}) continue;
    append_formatted(out, "  {:<18}{} {:>9} {:>8} {:>8} {:>8}\n", contact_name(contact), millimeters(report, contact.point),
                     known(report, contact.force[0], 3), known(report, contact.force[1], 3), known(report, contact.force[2], 3),
                     known(report, contact.torsion * 1e3, 3));
  }
}

void write_hold(std::string& out, const GripReport& report) {
  if (!report.hold) return;
  const GripHold& hold = *report.hold;
  append_formatted(out, "\n  worst effort   {}, in the hardest of the scene's own states: {}, {} deg\n", percent(hold.worst),
                   fill_words(report, hold.worst_fill), plain_text(degrees(hold.worst_tilt)));
  append_formatted(out, "                 two tips alone over the scene's states: {}\n", percent(hold.tips_worst));
  append_formatted(out, "  held margin    {} times the strength that holding takes: the grip {}\n",
                   fixed_text(held_margin(hold.worst), 2), hold.worst <= 1 ? "holds" : "does not hold");
  append_formatted(out, "  friction       {}\n",
                   std::isfinite(hold.friction_needed)
                       ? fmt::format("{:.3f} is the least that holds all states", hold.friction_needed)
                       : std::string("none up to 10 holds all states"));
  append_formatted(out, "  push           {} N at the center of mass, upright and fullest, in the worst of six directions\n",
                   fixed_text(hold.push, 2));
}

void write_quality(std::string& out, const GripReport& report) {
  if (!report.quality) return;
  const GripQuality& quality = *report.quality;
  const auto& [epsilon, volume] = quality.wrenches;
  append_formatted(out, "\n  epsilon        {:.4g} to {:.4g}, moments over {} about {} mm\n", epsilon[0], epsilon[1],
                   millimeters(report, quality.scale), millimeters(report, quality.center));
  append_formatted(out, "  wrench volume  {:.4g} to {:.4g}\n", volume[0], volume[1]);
}

// Over all listed states that hold, beside what people do.
void write_shares(std::string& out, const GripReport& report) {
  // Cepria-Bernal et al. 2017: ten adults transport and pour four bottles
  constexpr FingerValues PUBLISHED{30, 29, 22, 19};
  FingerShares sum{};
  FingerValues allowed{};
  int states = 0;
  for (const StateHold& hold : report.holds) {
    if (!hold.shares || std::isnan(hold.shares->share[0])) continue;
    ++states;
    for (std::size_t k = 0; k < allowed.size(); ++k) {
      sum.share[k] += hold.shares->share[k];
      sum.least[k] += hold.shares->least[k];
      sum.most[k] += hold.shares->most[k];
      allowed[k] += hold.shares->least[k] <= PUBLISHED[k] / 100 && PUBLISHED[k] / 100 <= hold.shares->most[k] ? 1 : 0;
    }
  }
  if (states == 0) return;
  const auto row = [&](const char* name, const auto& text) {
    append_formatted(out, "  {:<50}", name);
    for (std::size_t k = 0; k < allowed.size(); ++k) append_formatted(out, "{:>11}", text(k));
    out += "\n";
  };
  const auto mean = [&](double total) { return fixed_text(100 * total / states, 0); };
  out += "\n";
  row("fingers' shares of their normal forces, %", [](std::size_t k) { return FINGER_NAMES[k + 1]; });
  row(fmt::format("  means over {}: at the least effort", counted(states, "state")).c_str(),
      [&](std::size_t k) { return mean(sum.share[k]); });
  row(fmt::format("  up to {:g} times the least effort", SHARE_ROOM).c_str(),
      [&](std::size_t k) { return mean(sum.least[k]) + " to " + mean(sum.most[k]); });
  row("  people with bottles (published)", [&](std::size_t k) { return fixed_text(PUBLISHED[k], 0); });
  row(fmt::format("  states that allow the published share, of {}", states).c_str(),
      [&](std::size_t k) { return fixed_text(allowed[k], 0); });
}

void write_score(std::string& out, const GripReport& report) {
  const GripScore& score = report.answer.score;
  append_formatted(out, "\n  score          {}\n", known(report, score.score, 6));
  append_formatted(out, "  terms          fingers {}, contacts {}, depth {}, posture {}", fixed_text(score.terms.fingers, 4),
                   fixed_text(score.terms.contacts, 4), fixed_text(score.terms.depth, 4), fixed_text(score.terms.posture, 4));
  if (report.has_tilts)
    append_formatted(out, ", force {}, hold {}", fixed_text(score.terms.force, 4), fixed_text(score.terms.hold, 4));
  append_formatted(out, "\n");
  for (std::size_t f = 0; f < score.fills.size(); ++f) {
    const FillTerms& terms = score.fills[f];
    const std::size_t counted = report.counted_tilts.at(f);
    const std::string tilts = counted == report.score_tilts ? "all" : fmt::format("{} of {}", counted, report.score_tilts);
    const std::string hold = std::isinf(terms.largest_hold) ? "infinite" : hold_newtons(terms.largest_hold, report) + " N";
    const bool is_end = terms.safe_tilt >= report.last_tilts.at(f);
    const std::string safe = std::isnan(terms.safe_tilt) ? "safe at no tilt"
                             : is_end ? fmt::format("safe at every tilt, up to {} deg", plain_text(degrees(terms.safe_tilt)))
                                      : fmt::format("safe up to {} deg", plain_text(degrees(terms.safe_tilt)));
    append_formatted(out, "  over {} tilts, {}: peak force {} N at {} deg, {}\n", tilts,
                     report.has_liquid ? fill_words(report, report.score_fills.at(f)) : "empty", known(report, terms.peak_force, 4),
                     plain_text(degrees(terms.peak_tilt)),
                     std::isnan(terms.largest_hold) ? "largest hold and safe tilt are not computed of an implausible grip"
                                                    : fmt::format("largest hold {}, {}", hold, safe));
  }
}

// Whether hand or friction fails first, and by how much.
std::string first_to_fail(const Scene& scene, const GripHold& hold) {
  const char* fails = hold.worst <= 1 ? "would fail" : "fails";
  if (friction_fails_first(scene, hold.worst, hold.friction_needed)) {
    return fmt::format("Friction {} first: the grip needs {:.3f}, and the vessel has {} (margin {}).\n", fails,
                       hold.friction_needed, plain_text(scene.force.friction),
                       fixed_text(scene.force.friction / hold.friction_needed, 2));
  }
  return fmt::format("The strength of the hand {} first (margin {}).\n", fails, fixed_text(held_margin(hold.worst), 2));
}

std::string hold_verdict(const Scene& scene, const GripReport& report) {
  const GripHold& hold = *report.hold;
  const std::string state = fmt::format("{}, {} deg", fill_words(report, hold.worst_fill), plain_text(degrees(hold.worst_tilt)));
  if (std::isinf(hold.worst)) {
    return fmt::format("Does not hold: the vessel slips in the hardest state ({}), whatever the hand's strength.\n{}.\n", state,
                       std::isfinite(hold.friction_needed)
                           ? fmt::format("A friction of {:.3f} would hold it, and the vessel has {}", hold.friction_needed,
                                         plain_text(scene.force.friction))
                           : std::string("No friction up to 10 would hold it"));
  }
  return fmt::format("{} {} in the hardest state ({}).\n{}", hold.worst <= 1 ? "Holds with" : "Does not hold: it takes",
                     percent(hold.worst), state, first_to_fail(scene, hold));
}

}  // namespace

std::string held_percent(double share) { return fixed_text(std::floor(100 * share), 0); }

bool friction_fails_first(const Scene& scene, double effort, double friction_needed) {
  return std::isinf(effort) || (std::isfinite(friction_needed) && scene.force.friction / friction_needed < held_margin(effort));
}

std::string grip_verdict(const Scene& scene, const GripReport& report) {
  const GripResult& result = report.answer.result;
  if (result.reason != Reason::none) {
    std::string reason = REASON_NAMES[static_cast<std::size_t>(result.reason)];
    std::replace(reason.begin(), reason.end(), '_', ' ');
    return fmt::format("Not feasible ({}): no hand holds the vessel here.\n", reason);
  }
  if (!result.plausible) {
    return fmt::format("Not plausible: {}, so nobody can take this grip.\n",
                       result.through_table  ? "the hand would go through the table"
                       : result.beyond_wrist ? "wrist and forearm would be beyond their ranges"
                       : result.self_overlap ? "the fingers would be in each other"
                                             : "the hand would be too deep in the vessel");
  }
  std::string text = report.hold ? hold_verdict(scene, report)
                                 : fmt::format("Whether the grip holds is not judged: the scene has no {}.\n",
                                               scene.strength ? "[tilts]" : "efforts");
  if (report.held_share) {
    text += fmt::format("It {} in {} % of {} deviations from its place.\n", report.hold ? "holds" : "is plausible",
                        held_percent(*report.held_share), scene.robust->count);
  } else if (!scene.robust) {
    text += "Off its place the grip is not judged: the scene has no [robust].\n";
  }
  if ((result.status & STATUS_CONTACT_UNDECIDED) != 0) text += "Rounding may decide whether a point of the hand is a contact.\n";
  return text;
}

std::string grip_table(const GripReport& report) {
  const GripInput& grip = report.grip;
  std::string text;
  append_formatted(text, "Grip of {} in {}, on {}\n", report.vessel, report.scene, report.device);
  append_formatted(text, "  height {} mm, azimuth {} deg, obliquity {} deg, roll {} deg, offset {} mm, hand scale {:.4g}\n",
                   fixed_text(grip.height * 1e3, 3), fixed_text(degrees(grip.azimuth), 3), fixed_text(degrees(grip.obliquity), 3),
                   fixed_text(degrees(grip.roll), 3), fixed_text(grip.offset * 1e3, 3), grip.hand_scale);
  write_closing(text, report);
  if (report.answer.result.reason != Reason::none) return text;
  write_joints(text, report);
  write_states(text, report);
  write_holding_source(text, report);
  write_contacts(text, report);
  write_hold(text, report);
  write_quality(text, report);
  write_shares(text, report);
  write_score(text, report);
  return text;
}

}  // namespace wholehand::sweeps
