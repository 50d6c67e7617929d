// SPDX-License-Identifier: MIT
// A grip report as tables, in the units that people read: mm, degrees, mL, g.
#include <fmt/format.h>

#include <cmath>

#include "core/joints.h"
#include "core/text.h"
#include "grips/report.h"
#include "grips/states.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

constexpr std::array<const char*, 4> THUMB_JOINTS{"CMC", "MCP", "IP", "tip"};
constexpr std::array<const char*, 5> FINGER_JOINTS{"CMC", "MCP", "PIP", "DIP", "tip"};

std::string joint_name(int j) {
  const int f = finger_of(j), k = j - finger_start(f);
  return fmt::format("{} {}", FINGER_NAMES[f], f == 0 ? THUMB_JOINTS[k] : FINGER_JOINTS[k]);
}

std::string millimetres(const Triple& p) { return fmt::format("{:9.3f} {:8.3f} {:8.3f}", p[0] * 1e3, p[1] * 1e3, p[2] * 1e3); }

const char* yes_no(bool value) { return value ? "yes" : "no"; }

// A hold force that comes from an effort is known to a thousandth: more digits would tell two searches for one state apart.
std::string hold_newtons(double force, const GripReport& report) {
  return !std::isfinite(force) ? "infinite" : report.hold ? fmt::format("{:#.3g}", force) : fmt::format("{:.4f}", force);
}

// Fingers whose bit is set from `shift` on in a status; "none".
std::string finger_list(std::uint32_t bits) {
  std::string list;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    if ((bits >> f & 1) != 0) list += (list.empty() ? "" : ", ") + std::string(FINGER_NAMES[f]);
  }
  return list.empty() ? "none" : list;
}

void write_closing(std::string& out, const GripReport& report) {
  const GripResult& r = report.answer.result;
  const bool is_feasible = r.reason == Reason::none;
  append_formatted(out, "  feasible       {}{}\n", yes_no(is_feasible),
                   is_feasible ? "" : fmt::format(": {}", REASON_NAMES[static_cast<std::size_t>(r.reason)]));
  if (!is_feasible && r.reason < Reason::too_wide) return;
  append_formatted(out, "  gap            {:.3f} mm\n", r.gap * 1e3);
  append_formatted(out, "  midpoint      {} mm\n", millimetres(r.midpoint));
  if (!is_feasible) return;
  append_formatted(out, "  closure        {:.6f}\n", r.closure);
  append_formatted(out, "  contact angles thumb {:.3f}, index {:.3f} deg, antipodal: {}{}\n", degrees(r.contact_angles[0]),
                   degrees(r.contact_angles[1]), yes_no(r.antipodal), r.grazing ? ", grazing" : "");
  append_formatted(out, "  plausible      {}: phalanges {:.3f} mm deep, palm {:.3f} mm{}\n", yes_no(r.plausible),
                   r.phalanx_depth * 1e3, r.palm_depth * 1e3, r.through_table ? "; the hand goes through the table" : "");
  if (!std::isnan(r.table_depth)) {
    append_formatted(out, "  table          {:.3f} mm {} the table and its clearance\n", std::abs(r.table_depth) * 1e3,
                     r.through_table ? "below" : "above");
  }
  if (!std::isnan(r.self_depth)) {
    append_formatted(out, "  fingers        {:.3f} mm {}{}\n", std::abs(r.self_depth) * 1e3,
                     r.self_depth > 0 ? "in each other" : "apart from each other at least",
                     r.self_overlap ? ": deeper than the depth limit" : "");
  }
  append_formatted(out, "  bone stretch   {:.3f} mm\n", r.bone_stretch * 1e3);
  append_formatted(out, "  fingers used   {}\n", finger_list(r.used_mask));
  const std::uint32_t blocked = r.status >> STATUS_BLOCKED_SHIFT & 0x1F, unsettled = r.status >> STATUS_UNSETTLED_SHIFT & 0x1F;
  if (blocked != 0) append_formatted(out, "  blocked        {}: inside the vessel even when open\n", finger_list(blocked));
  if (unsettled != 0) append_formatted(out, "  not settled    {}: used all its steps and is not at rest\n", finger_list(unsettled));
  if ((r.status & STATUS_PROXY_UNSETTLED) != 0)
    append_formatted(out, "  not settled    a proxy: used all its steps and is not at rest\n");
}

void write_joints(std::string& out, const GripResult& r) {
  append_formatted(out, "\n  points, mm     {:^27}{:^27}{:^27}{:>11}  {}\n", "rigged", "posed", "proxy", "separation", "contact");
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const auto has = [j](std::uint32_t mask) { return (mask >> j & 1) != 0; };
    const char* role = has(r.tip_mask)      ? ", projected: tip"
                       : has(r.finger_mask) ? ", projected: finger"
                       : has(r.inner_mask)  ? ", projected: inner"
                                            : "";
    append_formatted(out, "  {:<13}{}{}{}{:11.4f}  {}{}\n", joint_name(j), millimetres(r.joints[j]), millimetres(r.posed[j]),
                     millimetres(r.proxies[j]), r.separation[j] * 1e3, has(r.touch_mask) ? "touches" : "-", role);
  }
}

void write_states(std::string& out, const GripReport& report) {
  if (report.answer.states.empty()) return;
  append_formatted(out, "\n  {:>5}{:>7}{:>9}{:>9}{:>9} {:>27}{:>9}{:>10}{:>10}{:>9}{:>9}{:>9}\n", "fill", "tilt", "liquid",
                   "poured", "mass", "center of mass", "pivot", "torque", "exact", "normal", "feedback", "hold");
  append_formatted(out, "  {:>5}{:>7}{:>9}{:>9}{:>9} {:>27}{:>9}{:>10}{:>10}{:>9}{:>9}{:>9}\n", "", "deg", "mL", "mL", "g", "mm",
                   "mm", "mN m", "mN m", "N", "N", "N");
  for (const GripState& s : report.answer.states) {
    append_formatted(out, "  {:5.3g}{:7.2f} {:8.3f} {:8.3f} {:8.3f} {}", s.fill, degrees(s.tilt), s.liquid.volume * 1e6,
                     s.liquid.poured * 1e6, s.state.mass * 1e3, millimetres(s.state.center_of_mass));
    if (!s.counts) {
      append_formatted(out, "  left out by until_poured\n");
      continue;
    }
    append_formatted(out, "{:9.3f} {:9.4f} {:9.4f} {:8.4f} {:8.4f} {:>8}\n", s.state.pivot_length * 1e3, s.state.torque * 1e3,
                     s.state.exact_torque * 1e3, s.state.normal_force, s.state.feedback_force,
                     hold_newtons(s.state.hold_force, report));
  }
}

// A share of the hand's strength, in percent.
std::string percent(double effort) {
  return std::isfinite(effort) ? fmt::format("{:.2f} % of the hand's strength", effort * 100) : std::string("no force holds it");
}

std::string contact_name(const HeldContact& contact) {
  const std::string place = contact.between > 0 ? fmt::format(" bone {}", contact.between) : "";
  return joint_name(contact.joint) + place + (contact.digit == FINGER_COUNT ? ", palm" : "");
}

// What each digit presses in the hardest of the states that were asked for.
void write_contacts(std::string& out, const GripReport& report) {
  const auto hardest = hardest_state(report);
  if (!hardest) return;
  const StateHold& hold = report.holds[*hardest];
  const GripState& state = report.answer.states[*hardest];
  // not "worst": the scene may have a worse one that is not listed, or none as bad
  append_formatted(out, "\n  listed effort  {}, in the hardest of the states listed above, at fill {:.3g} and {:.2f} deg\n",
                   percent(hold.effort), state.fill, degrees(state.tilt));
  append_formatted(out, "                 two tips alone in this state: {}\n", percent(hold.tips));
  if (hold.escape) {
    const auto& v = *hold.escape;
    append_formatted(out, "  unopposed      moving along ({:.3f}, {:.3f}, {:.3f}) m/s, turning by ({:.3f}, {:.3f}, {:.3f}) rad/s\n",
                     v[0], v[1], v[2], v[3], v[4], v[5]);
    return;
  }
  append_formatted(out, "  {:<18}{:^27} {:^27}{:>9}\n", "presses at", "place, mm", "force, N", "mN m");
  for (const HeldContact& contact : hold.contacts) {
    if (contact.force == Triple{}) continue;
    append_formatted(out, "  {:<18}{} {:9.3f} {:8.3f} {:8.3f} {:8.3f}\n", contact_name(contact), millimetres(contact.point),
                     contact.force[0], contact.force[1], contact.force[2], contact.torsion * 1e3);
  }
}

void write_hold(std::string& out, const GripReport& report) {
  if (!report.hold) return;
  const GripHold& hold = *report.hold;
  append_formatted(out, "\n  worst effort   {}, in the hardest of the scene's own states, at fill {:.3g} and {:.1f} deg\n",
                   percent(hold.worst), hold.worst_fill, degrees(hold.worst_tilt));
  append_formatted(out, "                 two tips alone over the scene's states: {}\n", percent(hold.tips_worst));
  append_formatted(out, "  friction       {}\n",
                   std::isfinite(hold.friction_needed)
                       ? fmt::format("{:.3f} is the least that holds all states", hold.friction_needed)
                       : std::string("none up to 10 holds all states"));
  append_formatted(out, "  push           {:.2f} N at the centre of mass, upright and fullest, in the worst of six directions\n",
                   hold.push);
}

void write_quality(std::string& out, const GripReport& report) {
  if (!report.quality) return;
  const GripQuality& quality = *report.quality;
  const auto& [epsilon, volume] = quality.wrenches;
  append_formatted(out, "\n  epsilon        {:.4g} to {:.4g}, moments over {:.3f} mm about {} mm\n", epsilon[0], epsilon[1],
                   quality.scale * 1e3, millimetres(quality.center));
  append_formatted(out, "  wrench volume  {:.4g} to {:.4g}\n", volume[0], volume[1]);
}

void write_score(std::string& out, const GripReport& report) {
  const GripScore& score = report.answer.score;
  append_formatted(out, "\n  score          {:.6f}\n", score.score);
  append_formatted(out, "  terms          fingers {:.4f}, contacts {:.4f}, depth {:.4f}, posture {:.4f}", score.terms.fingers,
                   score.terms.contacts, score.terms.depth, score.terms.posture);
  if (report.has_tilts) append_formatted(out, ", force {:.4f}, hold {:.4f}", score.terms.force, score.terms.hold);
  append_formatted(out, "\n");
  for (std::size_t f = 0; f < score.fills.size(); ++f) {
    const FillTerms& terms = score.fills[f];
    const std::size_t counted = report.counted_tilts.at(f);
    const std::string tilts = counted == report.score_tilts ? "all" : fmt::format("{} of {}", counted, report.score_tilts);
    const std::string hold = std::isinf(terms.largest_hold) ? "infinite" : hold_newtons(terms.largest_hold, report) + " N";
    const std::string safe =
        std::isnan(terms.safe_tilt) ? "safe at no tilt" : fmt::format("safe up to {:.1f} deg", degrees(terms.safe_tilt));
    append_formatted(out, "  over {} tilts fill {:.3g}: peak force {:.4f} N at {:.1f} deg, {}\n", tilts, report.score_fills.at(f),
                     terms.peak_force, degrees(terms.peak_tilt),
                     std::isnan(terms.largest_hold) ? "largest hold and safe tilt are not computed of an implausible grip"
                                                    : fmt::format("largest hold {}, {}", hold, safe));
  }
}

}  // namespace

std::string grip_table(const GripReport& report) {
  const GripInput& grip = report.grip;
  std::string text;
  append_formatted(text, "Grip of {} in {}, on {}\n", report.vessel, report.scene, report.device);
  append_formatted(
      text, "  height {:.3f} mm, azimuth {:.3f} deg, obliquity {:.3f} deg, roll {:.3f} deg, offset {:.3f} mm, hand scale {:.4g}\n",
      grip.height * 1e3, degrees(grip.azimuth), degrees(grip.obliquity), degrees(grip.roll), grip.offset * 1e3, grip.hand_scale);
  write_closing(text, report);
  if (report.answer.result.reason != Reason::none) return text;
  write_joints(text, report.answer.result);
  write_states(text, report);
  write_contacts(text, report);
  write_hold(text, report);
  write_quality(text, report);
  write_score(text, report);
  return text;
}

}  // namespace wholehand
