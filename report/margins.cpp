// SPDX-License-Identifier: MIT
#include "report/margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/planes.h"
#include "core/text.h"
#include "grips/states.h"
#include "report/html.h"

namespace wholehand {
namespace {

constexpr const char* MARGINS_NOTE =
    "A margin says how many times over a grip keeps to a limit. The margin of the hand's strength is 1 / (worst effort). The "
    "margin of friction is the friction of the vessel over the friction that is needed. The margin of the table is 1, plus 1 for "
    "each 10 mm of room above its clearance. The margin of the gripper is its largest force over the largest normal force before "
    "clamping. The smallest margin says what would fail first. A dash stands for a limit that the scene does not have, or that is "
    "not what fails.";

constexpr double ENDLESS = std::numeric_limits<double>::infinity(), NO_NUMBER = std::numeric_limits<double>::quiet_NaN();

// Places of the terms in effective_weights.
enum Term : std::size_t { FINGERS_TERM, CONTACTS_TERM, DEPTH_TERM, POSTURE_TERM, FORCE_TERM, HOLD_TERM, TERM_COUNT };

// How often `used` goes into `limit`, both at least 0.
double times_within(double limit, double used) { return used > 0 ? limit / used : ENDLESS; }

// Unclamped, over the states that count; NaN without states.
double largest_normal_force(const GripReport& report) {
  double largest = NO_NUMBER;
  for (const GripState& state : report.answer.states) {
    if (state.counts && !(largest >= state.state.normal_force)) largest = state.state.normal_force;
  }
  return largest;
}

std::string percent_text(double share) { return shown_number(100 * share, share < 0.0995 ? 1 : 0) + "\u00a0%"; }

std::string strength_share(double effort) {
  return fmt::format("the hardest state takes {} of the hand's strength", percent_text(effort));
}

std::string depth_reason(double millimetres) {
  if (millimetres < 0.05) return "the hand does not reach into the glass";
  return fmt::format("the hand is at most {} mm deep in the glass", shown_number(millimetres, 1));
}

std::string term_reason(const Scene& scene, const GripReport& report, std::size_t term) {
  const GripResult& result = report.answer.result;
  switch (term) {
    case FINGERS_TERM:
      return fmt::format("{} of {} fingers touch the vessel", std::popcount(result.used_mask), FINGER_COUNT);
    case CONTACTS_TERM:
      return fmt::format("{} of {} points of the hand touch the vessel", std::popcount(result.touch_mask), JOINT_COUNT);
    case DEPTH_TERM:
      return depth_reason(1e3 * std::max(result.phalanx_depth, result.palm_depth));
    case POSTURE_TERM:
      return fmt::format("the hand is near the middle of its range (closure {})", shown_number(result.closure, 2));
    case FORCE_TERM:
      return fmt::format("the gripper renders at most {} N of its {} N",
                         shown_number(std::max(0.0, largest_normal_force(report)), 1), plain_number(scene.force.max));
    default:
      return strength_share(report.hold->worst);
  }
}

// The terms that add most to the score, the most first; at most two. A term that adds nothing is no reason, nor is holding where the
// worst effort is more than the hand has.
std::vector<std::size_t> best_terms(const Scene& scene, const ScoreTerms& terms, double worst, std::optional<Limit> weakest) {
  const std::array<double, 6> weights = effective_weights(scene),
                              values{terms.fingers, terms.contacts, terms.depth, terms.posture, terms.force, terms.hold};
  const auto adds = [&](std::size_t term) { return weights[term] * values[term]; };
  std::vector<std::size_t> found;
  for (std::size_t term = 0; term < TERM_COUNT; ++term) {
    const bool is_weak = (term == FORCE_TERM && weakest == Limit::force) ||
                         (term == HOLD_TERM && (weakest == Limit::effort || weakest == Limit::friction || !(worst <= 1)));
    if (!is_weak && adds(term) > 0) found.push_back(term);
  }
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) { return adds(a) > adds(b); });
  found.resize(std::min<std::size_t>(found.size(), 2));
  return found;
}

std::string worst_state(const Scene& scene, const GripReport& report) {
  const std::string tilt = fmt::format("at a tilt of {}°", plain_number(degrees(report.hold->worst_tilt)));
  return report.has_liquid ? fmt::format("{} and a fill of {}", tilt,
                                         report.capacity > 0 ? fill_number(report, report.hold->worst_fill) + "\u00a0mL"
                                                             : share_text(scene, report.hold->worst_fill))
                           : tilt;
}

// What the smallest margin is about, and why.
std::string limit_text(const Scene& scene, const GripReport& report, const Margin& margin) {
  const bool is_kept = margin.value >= 1;
  const std::string shown = fmt::format("(margin {})", shown_number(margin.value, margin.value < 10 ? 2 : 0));
  switch (margin.limit) {
    case Limit::effort:
      if (std::isinf(report.hold->worst))
        return fmt::format("no force of the hand holds the vessel {}", worst_state(scene, report));
      return fmt::format("{}, because {} {}",
                         is_kept ? "the strength of the hand would fail first" : "the strength of the hand fails",
                         strength_share(report.hold->worst), shown);
    case Limit::friction:
      return fmt::format("{}, because the grip needs a friction of {} and the vessel has {} {}",
                         is_kept ? "friction would fail first" : "friction fails", shown_number(report.hold->friction_needed, 3),
                         plain_number(scene.force.friction), shown);
    case Limit::table: {
      const double room = -1e3 * report.answer.result.table_depth;
      return is_kept ? fmt::format("the table would be in the way first, because the hand has {} mm of room above its clearance {}",
                                   shown_number(room, 1), shown)
                     : fmt::format("the table is in the way, because the hand is {} mm too low {}", shown_number(-room, 1), shown);
    }
    case Limit::force:
      break;
  }
  return fmt::format(
      "{}, because the feedback force is up to {} N and the gripper gives {} N {}",
      is_kept ? "the force of the gripper would reach its limit first" : "the force of the gripper is beyond its limit",
      shown_number(largest_normal_force(report), 1), plain_number(scene.force.max), shown);
}

}  // namespace

std::vector<Margin> grip_margins(const Scene& scene, const GripReport& report) {
  std::vector<Margin> margins;
  if (!report.hold) return margins;
  margins.push_back({Limit::effort, times_within(1, report.hold->worst)});
  if (std::isfinite(report.hold->friction_needed))
    margins.push_back({Limit::friction, times_within(scene.force.friction, report.hold->friction_needed)});
  const double table_depth = report.answer.result.table_depth, force = largest_normal_force(report);
  if (!std::isnan(table_depth)) margins.push_back({Limit::table, 1 - table_depth / TABLE_MARGIN_STEP});
  if (!std::isnan(force)) margins.push_back({Limit::force, times_within(scene.force.max, force)});
  return margins;
}

std::optional<Margin> smallest_margin(const std::vector<Margin>& margins) {
  const auto found =
      std::min_element(margins.begin(), margins.end(), [](const Margin& a, const Margin& b) { return a.value < b.value; });
  if (found == margins.end() || std::isinf(found->value)) return std::nullopt;
  return *found;
}

std::string verdict(const Scene& scene, const GripReport& report) {
  if (!report.hold) return "";
  const std::optional<Margin> weakest = smallest_margin(grip_margins(scene, report));
  std::vector<std::string> reasons;
  for (const std::size_t term :
       best_terms(scene, report.answer.score.terms, report.hold->worst, weakest ? std::optional(weakest->limit) : std::nullopt)) {
    reasons.push_back(term_reason(scene, report, term));
  }
  if (weakest && weakest->value < 1 && !reasons.empty())
    return fmt::format("Although {}, {}.", joined(reasons, " and "), limit_text(scene, report, *weakest));
  std::string text =
      reasons.empty() ? "Nothing speaks for this grip" : fmt::format("This grip is good because {}", joined(reasons, " and "));
  if (weakest) text += "; " + limit_text(scene, report, *weakest);
  return text + ".";
}

void write_margins(MarkupWriter& html, const Scene& scene, const std::vector<RankedReport>& grips, const std::string& name) {
  if (std::none_of(grips.begin(), grips.end(), [](const RankedReport& grip) { return grip.report.hold.has_value(); })) return;
  HtmlTable table(html, "Limits of the best grips of " + name,
                  {"rank", "worst effort", "two tips", "held push (N)", "friction needed", "margin of strength", "of friction",
                   "of the table", "of the gripper"});
  for (const auto& [rank, report] : grips) {
    if (!report.hold) continue;
    std::vector<std::string> cells{std::to_string(rank), shown_number(report.hold->worst, 3),
                                   shown_number(report.hold->tips_worst, 2), shown_number(report.hold->push, 1),
                                   shown_number(report.hold->friction_needed, 3)};
    const std::vector<Margin> margins = grip_margins(scene, report);
    for (const Limit limit : {Limit::effort, Limit::friction, Limit::table, Limit::force}) {
      const auto found =
          std::find_if(margins.begin(), margins.end(), [limit](const Margin& margin) { return margin.limit == limit; });
      cells.push_back(shown_number(found == margins.end() ? NO_NUMBER : found->value, 2));
    }
    table.row(cells);
  }
  table.end();
  html.element("p", MARGINS_NOTE, {{"class", "note"}});
}

}  // namespace wholehand
