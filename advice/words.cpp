// SPDX-License-Identifier: MIT
#include "advice/words.h"

#include <fmt/format.h>

#include <cmath>

namespace wholehand {
namespace {

constexpr double WORTH_A_WORD = 0.8;  // the other side: from this share of the effort on downwards
constexpr double EASY = 0.1;          // an effort that needs no warning

void add(std::string& words, const std::string& more) {
  if (!words.empty()) words += ", ";
  words += more;
}

// "8 mm higher", of a difference in whole units; nothing of 0.
void add_change(std::string& words, double change, const char* before, const char* unit, const char* up, const char* down) {
  const double size = std::round(std::abs(change));
  if (size < 1) return;
  add(words, fmt::format("{}{:.0f} {}{}{}", before, size, unit, size == 1 || unit[0] == 'm' ? "" : "s", change > 0 ? up : down));
}

std::string of_grips(const Advice& advice) {
  if (!advice.best) return "no grip within reach is possible";
  const std::string best = effort_words(advice.best->effort);
  if (!advice.is_better) return "this grip is good: effort " + best;
  std::string way = way_words(advice.present.grip, advice.best->grip);
  if (way.empty()) way = "a touch aside";
  if (!advice.present.is_possible) return fmt::format("{}: effort {}; from here no grip is possible", way, best);
  return fmt::format("{}: effort {} to {}", way, effort_words(advice.present.effort), best);
}

std::string of_tilts(const TiltsAhead& ahead) {
  const TiltAhead* hardest = ahead.hardest();
  if (!hardest || hardest->effort < EASY) return "";
  std::string words =
      fmt::format("at {:.0f} degrees the grip needs {} of your strength", degrees(hardest->tilt), effort_words(hardest->effort));
  if (std::isinf(hardest->effort)) words = fmt::format("at {:.0f} degrees no strength holds this grip", degrees(hardest->tilt));
  const double other = ahead.other_worst();
  if (other <= WORTH_A_WORD * hardest->effort) words += fmt::format("; tilt over the other side: {}", effort_words(other));
  return words;
}

}  // namespace

std::string effort_words(double effort) {
  if (!std::isfinite(effort)) return "more than any strength";
  const std::string text = fmt::format("{:.2f}", effort);
  return text[0] == '0' ? text.substr(1) : text;
}

std::string way_words(const GripInput& from, const GripInput& to) {
  std::string words;
  add_change(words, 1e3 * (to.height - from.height), "", "mm", " higher", " lower");
  add_change(words, degrees(to.roll - from.roll), "turn ", "degree", "", " back");
  add_change(words, degrees(to.obliquity - from.obliquity), "index finger ", "degree", " up", " down");
  add_change(words, degrees(to.azimuth - from.azimuth), "around by ", "degree", " to the left", " to the right");
  // the offset is to that side of the line which is the user's as long as the line does not run backwards
  const double side = std::cos(to.azimuth) < 0 ? -1 : 1;
  add_change(words, side * 1e3 * (to.offset - from.offset), "", "mm", " nearer to you", " further from you");
  return words;
}

std::string advice_words(const Advice& advice) {
  if (advice.vessel < 0) return "";
  if (!advice.is_held) return of_grips(advice);
  std::string words = advice.ahead ? of_tilts(*advice.ahead) : "";
  if (advice.best && advice.is_better && advice.present.is_possible)
    words += (words.empty() ? "another grip, " : "; another grip, ") + of_grips(advice);
  return words.empty() ? "this grip is good" : words;
}

}  // namespace wholehand
