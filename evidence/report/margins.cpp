// SPDX-License-Identifier: MIT
#include "evidence/report/margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/charts/html.h"
#include "base/text/text.h"
#include "core/planes.h"
#include "sweeps/grips/states.h"

namespace wholehand {
namespace {

constexpr const char* MARGINS_NOTE =
    "A margin says how many times over a grip keeps to a limit. The margin of the hand's strength is 1 / (worst effort). The "
    "margin of friction is the friction of the vessel over the friction that is needed. The margin of the table is 1, plus 1 for "
    "each 10 mm of room above its clearance. The margin of the gripper is its largest force over the largest normal force before "
    "clamping. The smallest margin says what would fail first. A dash stands for a limit that the scene does not have, or that is "
    "not what fails.";

constexpr double ENDLESS = std::numeric_limits<double>::infinity(), NO_NUMBER = std::numeric_limits<double>::quiet_NaN();

// Indices of the terms in effective_weights, and one for a further possible reason.
enum Term : std::size_t { FINGERS_TERM, CONTACTS_TERM, DEPTH_TERM, POSTURE_TERM, FORCE_TERM, HOLD_TERM, SHARE_TERM };

constexpr const char* NO_DEPTH = "0.0\u00a0mm";

// The ratio of `limit` to `used`, both at least 0.
double times_within(double limit, double used) { return used > 0 ? limit / used : ENDLESS; }

// Unclamped, over the states that count; NaN without states.
double largest_normal_force(const sweeps::GripReport& report) {
  double largest = NO_NUMBER;
  for (const sweeps::GripState& state : report.answer.states) {
    if (state.counts && !(largest >= state.state.normal_force)) largest = state.state.normal_force;
  }
  return largest;
}

std::string percent_text(double share) { return shown_number(100 * share, share < 0.0995 ? 1 : 0) + "\u00a0%"; }

std::string strength_share(const std::string& percent) {
  return fmt::format("the hardest state takes {} of the hand's strength", percent);
}

// A possible reason for a grip: its contribution to the score, and its displayed number.
struct Merit {
  std::size_t term = 0;
  double adds = 0;
  std::string shown;
};

std::string term_number(const sweeps::GripReport& report, std::size_t term) {
  const GripResult& result = report.answer.result;
  switch (term) {
    case FINGERS_TERM:
      return std::to_string(std::popcount(result.used_mask));
    case CONTACTS_TERM:
      return std::to_string(std::popcount(result.touch_mask));
    case DEPTH_TERM:
      return shown_number(1e3 * std::max(result.phalanx_depth, result.palm_depth), 1) + "\u00a0mm";
    case POSTURE_TERM:
      return "closure " + shown_number(result.closure, 2) +
             (std::isnan(result.wrist_share) ? "" : ", wrist at " + percent_text(result.wrist_share) + " of its range");
    case FORCE_TERM:
      return shown_number(std::max(0.0, largest_normal_force(report)), 1) + "\u00a0N";
    case HOLD_TERM:
      return percent_text(report.hold->worst);
    default:
      return sweeps::held_percent(report.held_share.value_or(NO_NUMBER)) + "\u00a0%";
  }
}

std::string term_reason(const Scene& scene, const Merit& merit) {
  const std::string& number = merit.shown;
  switch (merit.term) {
    case FINGERS_TERM:
      return fmt::format("{} of {} fingers touch the vessel", number, FINGER_COUNT);
    case CONTACTS_TERM:
      return fmt::format("{} of {} points of the hand touch the vessel", number, JOINT_COUNT);
    case DEPTH_TERM:
      return number == NO_DEPTH ? "the hand does not reach into the glass"
                                : fmt::format("the hand is at most {} deep in the glass", number);
    case POSTURE_TERM:
      return fmt::format("{} ({})", scene.arm ? "the posture is easy" : "the hand is near the middle of its range", number);
    case FORCE_TERM:
      return fmt::format("the gripper renders at most {} of its {}\u00a0N", number, plain_number(scene.force.max));
    case HOLD_TERM:
      return strength_share(number);
    default:
      return fmt::format("{} of its deviations hold", number);
  }
}

// Each term's contribution to a grip's score, and last the share of its deviations that hold: lists are ranked by the deviations' score.
std::vector<Merit> merits_of(const Scene& scene, const sweeps::GripReport& report) {
  const ScoreTerms& terms = report.answer.score.terms;
  const std::array<double, 6> weights = effective_weights(scene),
                              values{terms.fingers, terms.contacts, terms.depth, terms.posture, terms.force, terms.hold};
  std::vector<Merit> merits;
  for (std::size_t term = 0; term < values.size(); ++term)
    merits.push_back({term, weights[term] * values[term], term_number(report, term)});
  merits.push_back({SHARE_TERM, report.held_share.value_or(0), term_number(report, SHARE_TERM)});
  return merits;
}

// Whether a merit is a reason. What would fail the grip first is no merit, nor is holding if that takes more strength than the hand has.
bool is_reason(const Merit& merit, double worst, std::optional<Limit> weakest) {
  const bool is_weak = (merit.term == FORCE_TERM && weakest == Limit::force) ||
                       (merit.term == HOLD_TERM && (weakest == Limit::effort || weakest == Limit::friction || !(worst <= 1)));
  return !is_weak && merit.adds > 0;
}

// The words for at most two terms in which the grip is better than the median of its list, first those in which it is better than most grips. If
// there are fewer, also the term that adds most, which others of the list may share (but not a depth above 0).
std::vector<std::string> best_reasons(const Scene& scene, const sweeps::GripReport& report, const std::vector<RankedReport>& list,
                                      std::optional<Limit> weakest) {
  std::vector<std::vector<Merit>> others;
  for (const RankedReport& other : list)
    if (other.report.hold) others.push_back(merits_of(scene, other.report));
  struct Distinction {
    Merit merit;
    std::ptrdiff_t ahead_of = 0;  // grips of the list
    double exceeds = 0;           // the median
    std::string median;
  };
  std::vector<Distinction> found;
  std::optional<Merit> shared;
  bool is_as_median = false;  // what is shared; else it is less, for want of any other
  for (const Merit& merit : merits_of(scene, report)) {
    if (!is_reason(merit, report.hold->worst, weakest)) continue;
    bool is_less = false;
    if (!others.empty()) {
      const auto middle = others.begin() + static_cast<std::ptrdiff_t>(others.size() / 2);
      std::nth_element(others.begin(), middle, others.end(),
                       [&](const auto& a, const auto& b) { return a[merit.term].adds < b[merit.term].adds; });
      const Merit& median = (*middle)[merit.term];
      if (merit.adds > median.adds && merit.shown != median.shown) {
        const auto ahead_of =
            std::count_if(others.begin(), others.end(), [&](const auto& a) { return a[merit.term].adds < merit.adds; });
        found.push_back({merit, ahead_of, merit.adds - median.adds, median.shown});
        continue;
      }
      is_less = merit.adds < median.adds && merit.shown != median.shown;
    }
    const bool is_slight = merit.term == SHARE_TERM || (merit.term == DEPTH_TERM && merit.shown != NO_DEPTH);
    if (is_slight || (shared && std::pair(is_as_median, shared->adds) >= std::pair(!is_less, merit.adds))) continue;
    shared = merit;
    is_as_median = !is_less;
  }
  std::stable_sort(found.begin(), found.end(), [](const Distinction& a, const Distinction& b) {
    return std::pair(a.ahead_of, a.exceeds) > std::pair(b.ahead_of, b.exceeds);
  });
  found.resize(std::min<std::size_t>(found.size(), 2));
  std::vector<std::string> words;
  for (const Distinction& one : found)
    words.push_back(fmt::format("{} (median of the list: {})", term_reason(scene, one.merit), one.median));
  if (shared && (words.empty() || (words.size() < 2 && is_as_median))) words.push_back(term_reason(scene, *shared));
  return words;
}

std::string worst_state(const Scene& scene, const sweeps::GripReport& report) {
  const std::string tilt = fmt::format("at a tilt of {}°", plain_number(degrees(report.hold->worst_tilt)));
  return report.has_liquid ? fmt::format("{} and a fill of {}", tilt,
                                         report.capacity > 0 ? sweeps::fill_number(report, report.hold->worst_fill) + "\u00a0mL"
                                                             : sweeps::share_text(scene, report.hold->worst_fill))
                           : tilt;
}

// What the smallest margin is about, and why.
std::string limit_text(const Scene& scene, const sweeps::GripReport& report, const Margin& margin) {
  const bool is_kept = margin.value >= 1;
  const std::string shown = fmt::format("(margin {})", shown_number(margin.value, margin.value < 10 ? 2 : 0));
  switch (margin.limit) {
    case Limit::effort:
      if (std::isinf(report.hold->worst))
        return fmt::format("no force of the hand holds the vessel {}", worst_state(scene, report));
      return fmt::format("{}, because {} {}",
                         is_kept ? "the strength of the hand would fail first" : "the strength of the hand fails",
                         strength_share(percent_text(report.hold->worst)), shown);
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

std::vector<Margin> grip_margins(const Scene& scene, const sweeps::GripReport& report) {
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

std::string verdict(const Scene& scene, const sweeps::GripReport& report, const std::vector<RankedReport>& list) {
  if (!report.hold) return "";
  const std::optional<Margin> weakest = smallest_margin(grip_margins(scene, report));
  const std::vector<std::string> reasons =
      best_reasons(scene, report, list, weakest ? std::optional(weakest->limit) : std::nullopt);
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
