// SPDX-License-Identifier: MIT
// [hand]: the hand's size, limits, bones and trajectories.
#include <array>

#include "core/hand_size.h"
#include "core/reader/parts.h"

namespace wholehand {
namespace {

// [hand.thumb] has three segments, four radii and no arch; the fingers four and five.
void read_finger(const SceneTable& hand, int f, FingerData& finger) {
  const bool is_thumb = f == 0;
  const auto table = is_thumb ? hand.table(FINGER_NAMES[f], {"base_mm", "splay_deg", "segments_mm", "radii_mm"})
                              : hand.table(FINGER_NAMES[f], {"base_mm", "splay_deg", "arch_deg", "segments_mm", "radii_mm"});
  if (!table) return;
  table->read("base_mm", ranges::HAND_BASE, "[x, y, z]", finger.base);
  table->read("splay_deg", ranges::HAND_SPREAD, finger.splay);
  if (!is_thumb) table->read("arch_deg", ranges::HAND_SPREAD, finger.arch);
  table->read("segments_mm", ranges::SEGMENT, "from the base to the tip", std::span(finger.segments).first(is_thumb ? 3 : 4));
  table->read("radii_mm", ranges::JOINT_RADIUS, "from the base to the tip", std::span(finger.radii).first(is_thumb ? 4 : 5));
}

void read_angle(const SceneTable& angles, const char* key, AngleRange& range) {
  std::array<double, 2> ends{range.open, range.closed};
  angles.read(key, ranges::JOINT_ANGLE, "[open, closed]", ends);
  range = {ends[0], ends[1]};
}

// Reads whose hand it is: the default, one of a length, a person of a survey, or the paper's. The tables of the fingers then change
// single numbers, and `scale` multiplies all.
void read_size(const SceneTable& table, HandData& hand) {
  if (table.has("length_mm") && table.has("person"))
    table.file().refuse(table.place("person"), "person beside length_mm", "allowed: one of length_mm and person");
  table.read("scale", ranges::SCALE, hand.scale);
  if (table.has("length_mm")) {
    HandSize size;
    table.need("length_mm", ranges::HAND_LENGTH, size.length);
    size.breadth = expected_breadth(size.length);
    set_size(hand, size);
  }
  if (const toml::node* person = table.find("person"); person && !person->is_table()) {
    const auto* word = person->as_string();
    if (!word || word->get() != "paper")
      table.file().refuse(place_of(*person), "person " + found(*person), "allowed: \"paper\" or a table with sex and percentile");
    hand.fingers = paper_hand().fingers;
  } else if (const auto surveyed = table.table("person", {"sex", "percentile"})) {
    surveyed->need("sex", "\"female\" or \"male\"");
    Sex sex = Sex::female;
    surveyed->read("sex", {{"female", Sex::female}, {"male", Sex::male}}, sex);
    double percentile = 50;
    surveyed->need("percentile", ranges::PERCENTILE, percentile);
    set_size(hand, surveyed_size(sex, percentile));
  }
}

}  // namespace

void read_hand(const SceneTable& root, HandData& hand) {
  const auto table = root.table(
      "hand", {"scale", "length_mm", "person", "handedness", "contact_tolerance_mm", "max_angle_deg", "paper_max_angle_deg",
               "depth_limit_mm", "between", "joint_limit_deg", "thumb", "index", "middle", "ring", "little", "angles"});
  if (!table) return;
  hand.place = table->file().text_of(table->place());
  read_size(*table, hand);
  table->read("handedness", {{"right", Handedness::right}, {"left", Handedness::left}}, hand.handedness);
  table->read("contact_tolerance_mm", ranges::CONTACT_TOLERANCE, hand.contact_tolerance);
  table->read("max_angle_deg", ranges::TURN, hand.max_angle);
  table->read("paper_max_angle_deg", ranges::TURN, hand.paper_max_angle);
  table->read("depth_limit_mm", ranges::DEPTH_LIMIT, hand.depth_limit);
  std::int64_t between = hand.between;
  table->read("between", ranges::BETWEEN, between);
  hand.between = static_cast<int>(between);
  table->read("joint_limit_deg", ranges::TURN, "[MCP, PIP, DIP]", hand.joint_limit);
  for (int f = 0; f < FINGER_COUNT; ++f) read_finger(*table, f, hand.fingers[f]);

  const auto angles =
      table->table("angles", {"thumb_abduction_deg", "thumb_mcp_deg", "thumb_ip_deg", "mcp_deg", "pip_deg", "dip_per_pip"});
  if (!angles) return;
  read_angle(*angles, "thumb_abduction_deg", hand.thumb_abduction);
  read_angle(*angles, "thumb_mcp_deg", hand.thumb_mcp);
  read_angle(*angles, "thumb_ip_deg", hand.thumb_ip);
  read_angle(*angles, "mcp_deg", hand.mcp);
  read_angle(*angles, "pip_deg", hand.pip);
  angles->read("dip_per_pip", ranges::DIP_PER_PIP, hand.dip_per_pip);
}

}  // namespace wholehand
