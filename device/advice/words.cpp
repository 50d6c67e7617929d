// SPDX-License-Identifier: MIT
#include "device/advice/words.h"

#include <fmt/format.h>

#include <cmath>

#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Vec3;

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

// The same of a change that goes along `way` in the world.
void add_move(std::string& words, double change, const char* before, const char* unit, const Vec3& way) {
  const double x = std::abs(way.x), y = std::abs(way.y), z = std::abs(way.z);
  if (y >= x && y >= z) return add_change(words, std::copysign(change, change * way.y), before, unit, " up", " down");
  if (x >= z) return add_change(words, std::copysign(change, change * way.x), before, unit, " to the right", " to the left");
  add_change(words, std::copysign(change, change * way.z), before, unit, " towards you", " away from you");
}

GripInput between(const GripInput& a, const GripInput& b) {
  GripInput middle;
  middle.azimuth = 0.5 * (a.azimuth + b.azimuth);
  middle.obliquity = 0.5 * (a.obliquity + b.obliquity);
  middle.roll = 0.5 * (a.roll + b.roll);
  return middle;
}

// Where what is moved goes, in the world, while a number of the grip grows.
struct Ways {
  Ways(const GripInput& grip, const Rotation& rotation, Handedness handedness);
  Vec3 wrist;   // roll: about the line of the tips
  Vec3 around;  // azimuth: the hand's side of the line, about the vessel's axis
  Vec3 aside;   // offset: the line
};

// By the frame of kernel 2. At roll 0 the wrist of a right hand is on the side to which the offset grows, and that of a left
// hand, whose line runs the other way, on the opposite one.
Ways::Ways(const GripInput& grip, const Rotation& rotation, Handedness handedness) {
  const glm::dmat3 to_world = to_mat3(rotation);
  const double side = handedness == Handedness::left ? -1 : 1;
  const Vec3 line(std::cos(grip.azimuth), 0, -std::sin(grip.azimuth)), level(std::sin(grip.azimuth), 0, std::cos(grip.azimuth));
  const Vec3 up = std::cos(grip.obliquity) * Vec3(0, 1, 0) - std::sin(grip.obliquity) * line;
  wrist = to_world * (-std::cos(grip.roll) * up - side * std::sin(grip.roll) * level);
  around = to_world * (side * line);
  aside = to_world * level;
}

std::string of_grips(const Advice& advice) {
  if (!advice.best) return "no grip within reach is possible";
  const std::string best = effort_words(advice.best->effort);
  if (!advice.is_better) return "this grip is good: effort " + best;
  std::string way = way_words(advice.present.grip, advice.best->grip, advice.rotation, advice.handedness);
  if (way.empty()) way = "a touch aside";
  if (!advice.present.is_possible)
    return fmt::format("{}: effort {}{}", way, best, advice.is_held ? "" : "; from here no grip is possible");
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

std::string effort_words(double effort) { return std::isfinite(effort) ? fmt::format("{:.2f}", effort) : "more than any strength"; }

std::string way_words(const GripInput& from, const GripInput& to, const Rotation& rotation, Handedness handedness) {
  const Ways ways(between(from, to), rotation, handedness);
  std::string words;
  add_change(words, 1e3 * (to.height - from.height), "", "mm", " higher", " lower");
  add_move(words, degrees(to.roll - from.roll), "wrist ", "degree", ways.wrist);
  add_change(words, degrees(to.obliquity - from.obliquity), "index finger ", "degree", " up", " down");
  add_move(words, degrees(to.azimuth - from.azimuth), "around by ", "degree", ways.around);
  add_move(words, 1e3 * (to.offset - from.offset), "", "mm", ways.aside);
  return words;
}

std::string advice_words(const Advice& advice) {
  if (advice.vessel < 0) return "";
  if (!advice.is_held) return of_grips(advice);
  std::string words = advice.ahead ? of_tilts(*advice.ahead) : "";
  if (advice.best && advice.is_better) words += (words.empty() ? "another grip, " : "; another grip, ") + of_grips(advice);
  return words.empty() && advice.present.is_possible ? "this grip is good" : words;
}

}  // namespace wholehand::device
