// SPDX-License-Identifier: MIT
// The arrows of a grip's drawing: where they point, how long they are, and when there are none.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "core/vectors.h"
#include "sweeps/grips/svg.h"
#include "tests/support/scenes.h"
#include "tests/support/xml.h"

namespace wholehand::sweeps {
namespace {

constexpr double TWO_DECIMALS = 0.011;  // mm, of a difference of places that are written with two

using Place = std::array<double, 2>;

// An arrow as it is drawn, or as it should be, mm on the sheet.
struct SeenArrow {
  Place head{}, tail{};
  double length() const { return std::hypot(head[0] - tail[0], head[1] - tail[1]); }
};

GripReport bare_report(const Scene& scene, std::size_t vessel, const GripInput& grip) {
  return make_grip_report(scene, vessel, grip, scene_axes(scene, vessel),
                          core_grip_methods(scene, make_core_evaluator(scene), "core"));
}

std::string part_of(const std::string& svg, const std::string& id) {
  const std::size_t from = svg.find("<g id=\"" + id + "\">");
  EXPECT_NE(from, std::string::npos) << id;
  return svg.substr(from, svg.find("</g>", from) - from);
}

// All numbers of a text, in their order.
std::vector<double> numbers_in(const std::string& text) {
  static const std::regex number("-?[0-9]+(\\.[0-9]+)?");
  std::vector<double> found;
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) found.push_back(std::stod(it->str()));
  return found;
}

// A shape of seven corners: the first is the head's point, the middle of the fourth and fifth is the tail.
std::vector<SeenArrow> arrows_in(const std::string& text) {
  static const std::regex shape("class=\"force\" d=\"([^\"]*)\"");
  std::vector<SeenArrow> found;
  for (std::sregex_iterator it(text.begin(), text.end(), shape), end; it != end; ++it) {
    const auto at = numbers_in((*it)[1]);
    EXPECT_EQ(at.size(), 14u);
    if (at.size() == 14) found.push_back({{at[0], at[1]}, {0.5 * (at[6] + at[8]), 0.5 * (at[7] + at[9])}});
  }
  return found;
}

// Width and height of the sheet on paper, then in its own coordinates.
std::array<double, 4> sheet_of(const std::string& svg) {
  static const std::regex sheet("width=\"([0-9.]+)mm\" height=\"([0-9.]+)mm\" viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\"");
  std::smatch match;
  EXPECT_TRUE(std::regex_search(svg, match, sheet));
  return {std::stod(match[1]), std::stod(match[2]), std::stod(match[3]), std::stod(match[4])};
}

// A view read anew: its directions, and the place of the thumb's tip, where its thumb-index line begins.
struct ReadView {
  Triple right{}, up{}, thumb{};
  Place origin{};
  Place place(const Triple& p) const {
    const Triple from{p[0] - thumb[0], p[1] - thumb[1], p[2] - thumb[2]};
    return {origin[0] + 1e3 * dot(right, from), origin[1] - 1e3 * dot(up, from)};
  }
};

ReadView read_view(const std::string& svg, const std::string& name, const Scene& scene, const GripReport& report) {
  const double c = std::cos(report.grip.azimuth), s = std::sin(report.grip.azimuth);
  const double side = scene.hand.handedness == Handedness::right ? 1 : -1;
  const Triple across{side * c, 0, -side * s}, away{-side * s, 0, -side * c}, up{0, 1, 0};
  ReadView view{name == "side" ? away : across, name == "top" ? away : up, report.answer.result.posed[THUMB_TIP], {}};
  std::smatch match;
  const std::string text = part_of(svg, name);
  EXPECT_TRUE(std::regex_search(text, match, std::regex("class=\"axis\" d=\"M([-0-9.]+) ([-0-9.]+)L")));
  view.origin = {std::stod(match[1]), std::stod(match[2])};
  return view;
}

// The forces of a state in a view whose longest arrow is so long, without those that are shorter than `shortest`.
std::vector<SeenArrow> expected_arrows(const StateHold& hold, const ReadView& view, double longest, double shortest) {
  double largest = 0;
  for (const HeldContact& contact : hold.contacts) largest = std::max(largest, norm(contact.force));
  std::vector<SeenArrow> arrows;
  for (const HeldContact& contact : hold.contacts) {
    const Place head = view.place(contact.point);
    const double scale = longest / largest;
    const SeenArrow arrow{head, {head[0] - scale * dot(view.right, contact.force), head[1] + scale * dot(view.up, contact.force)}};
    EXPECT_GT(std::abs(arrow.length() - shortest), 1e-3) << "too close to the limit for this test";
    if (arrow.length() > shortest) arrows.push_back(arrow);
  }
  return arrows;
}

double places_apart(const Place& a, const Place& b) { return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])); }

std::size_t hardest_of(const GripReport& report) {
  std::size_t hardest = 0;
  for (std::size_t k = 0; k < report.holds.size(); ++k)
    if (report.holds[k].effort > report.holds[hardest].effort) hardest = k;
  return hardest;
}

// Every arrow is one of the expected ones, in each view.
void expect_its_arrows(const Scene& scene, const GripReport& report, int& seen) {
  const std::string svg = grip_svg(scene, 0, report);
  expect_well_formed(svg);
  const auto sheet = sheet_of(svg);
  const double unit = sheet[2] / sheet[0];  // to 0.05 mm of the paper's width
  const auto key = arrows_in(part_of(svg, "legend"));
  ASSERT_EQ(key.size(), 1u);
  EXPECT_NEAR(key[0].length(), 15 * unit, 0.01 * unit);
  const StateHold& hold = report.holds[hardest_of(report)];
  for (const char* name : {"front", "side", "top"}) {
    const auto expected = expected_arrows(hold, read_view(svg, name, scene, report), key[0].length(), 0.1 * key[0].length());
    const auto drawn = arrows_in(part_of(svg, name));
    EXPECT_EQ(drawn.size(), expected.size()) << name;
    for (const SeenArrow& arrow : expected) {
      const auto is_it = [&](const SeenArrow& other) {
        return places_apart(arrow.head, other.head) < TWO_DECIMALS && places_apart(arrow.tail, other.tail) < 2 * TWO_DECIMALS;
      };
      EXPECT_EQ(std::count_if(drawn.begin(), drawn.end(), is_it), 1) << name << " " << arrow.head[0] << " " << arrow.head[1];
    }
    seen += static_cast<int>(expected.size());
  }
}

TEST(GripSvgForces, EachContactThatPressesHasItsArrow) {
  int seen = 0;
  for (const Handedness handedness : {Handedness::right, Handedness::left})
    for (const double azimuth : {0.0, 2.5}) {
      Scene scene = three_beakers();
      scene.hand.handedness = handedness;
      scene.tilts = {0, radians(40)};
      scene.strength.emplace();
      GripReport report = bare_report(scene, 0, {0.0585, azimuth, 0.1, 0.38, 0, 1});
      ASSERT_EQ(report.answer.result.reason, Reason::none);
      add_holding(report, scene, 0);
      ASSERT_TRUE(std::isfinite(report.holds[hardest_of(report)].effort));
      expect_its_arrows(scene, report, seen);
    }
  EXPECT_GT(seen, 30);
}

// A report with made forces in its last state but one, which takes most.
GripReport made_report(const Scene& scene, const std::vector<HeldContact>& contacts) {
  GripReport report = bare_report(scene, 0, {0.0585, 0, 0, 0, 0, 1});
  report.holds.resize(report.answer.states.size());
  StateHold& hardest = report.holds.at(report.holds.size() - 2);
  hardest.effort = 0.5;
  hardest.contacts = contacts;
  report.holds.front().effort = 0.25;
  return report;
}

Scene two_tilts() {
  Scene scene = three_beakers();
  scene.tilts = {0, radians(45)};
  return scene;
}

TEST(GripSvgForces, SaysTheScaleAndTheState) {
  const GripReport report = made_report(two_tilts(), {{THUMB_TIP, 0, {-0.04, 0.05, 0}, {1, 0, 0}, {3, 4, 0}, 0}});
  const std::string svg = grip_svg(two_tilts(), 0, report);
  const std::string legend = part_of(svg, "legend");
  EXPECT_NE(legend.find(">force on the vessel<"), std::string::npos);
  EXPECT_NE(legend.find(">longest arrow 5.00 N, fill 1, tilt 0.0\u00b0<"), std::string::npos) << legend;
  EXPECT_NE(svg.find("Arrows show the forces of the hand: longest arrow 5.00 N, "), std::string::npos);
}

// Along the line of sight there is nothing to draw, and a small force is left out.
TEST(GripSvgForces, ShortArrowsAreLeftOut) {
  const GripReport report = made_report(two_tilts(), {{THUMB_TIP, 0, {-0.04, 0.05, 0}, {1, 0, 0}, {10, 0, 0}, 0},
                                                      {INDEX_TIP, 1, {0.04, 0.05, 0}, {-1, 0, 0}, {-1.1, 0, 0}, 0},
                                                      {INDEX_TIP, 1, {0.04, 0.06, 0}, {-1, 0, 0}, {-0.9, 0, 0}, 0},
                                                      {INDEX_TIP, 1, {0.04, 0.07, 0}, {-1, 0, 0}, {0, 0, 0}, 0}});
  const std::string svg = grip_svg(two_tilts(), 0, report);
  EXPECT_EQ(arrows_in(part_of(svg, "front")).size(), 2u);
  EXPECT_EQ(arrows_in(part_of(svg, "top")).size(), 2u);
  EXPECT_EQ(arrows_in(part_of(svg, "side")).size(), 0u);
}

// Arrows that begin far outside make room for themselves, and the sheet still fits on a page.
TEST(GripSvgForces, TailsStayOnTheSheet) {
  std::vector<HeldContact> contacts;
  for (const double sense : {1.0, -1.0}) {
    contacts.push_back({THUMB_TIP, 0, {0.09 * sense, 0.05, 0}, {}, {-5 * sense, 0, 0}, 0});
    contacts.push_back({THUMB_TIP, 0, {0, 0.055 + 0.1 * sense, 0}, {}, {0, -5 * sense, 0}, 0});
    contacts.push_back({THUMB_TIP, 0, {0, 0.05, 0.15 * sense}, {}, {0, 0, -5 * sense}, 0});
  }
  const GripReport report = made_report(two_tilts(), contacts);
  const std::string svg = grip_svg(two_tilts(), 0, report);
  const auto sheet = sheet_of(svg);
  EXPECT_LE(sheet[0], 180.01);
  EXPECT_LE(sheet[1], 250.01);
  EXPECT_TRUE(sheet[0] > 179.9 || sheet[1] > 249.9);
  double rightmost = 0, leftmost = 1e9;
  for (const char* name : {"front", "side", "top"}) {
    const auto arrows = arrows_in(part_of(svg, name));
    EXPECT_EQ(arrows.size(), 4u) << name;
    for (const SeenArrow& arrow : arrows) {
      EXPECT_GT(arrow.tail[0], 0) << name;
      EXPECT_LT(arrow.tail[0], sheet[2]) << name;
      EXPECT_GT(arrow.tail[1], 0) << name;
      EXPECT_LT(arrow.tail[1], sheet[3]) << name;
      if (name == std::string("front")) rightmost = std::max(rightmost, arrow.tail[0]);
      if (name == std::string("side")) leftmost = std::min(leftmost, arrow.tail[0]);
    }
  }
  EXPECT_LT(rightmost, leftmost);  // the views do not run into one another
}

TEST(GripSvgForces, WithoutAForceTheDrawingIsAsBefore) {
  const Scene scene = two_tilts();
  GripReport report = made_report(scene, {{THUMB_TIP, 0, {-0.04, 0.05, 0}, {1, 0, 0}, {3, 4, 0}, 0}});
  EXPECT_NE(grip_svg(scene, 0, report).find("class=\"force\""), std::string::npos);
  GripReport bare = report;
  bare.holds.clear();
  const std::string before = grip_svg(scene, 0, bare);
  EXPECT_EQ(before.find("force"), std::string::npos);
  EXPECT_EQ(before.find("arrow"), std::string::npos);
  GripReport unheld = report;
  unheld.holds.front().effort = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grip_svg(scene, 0, unheld), before);
  report.holds.at(report.holds.size() - 2).contacts.front().force = {};
  EXPECT_EQ(grip_svg(scene, 0, report), before);
}

}  // namespace
}  // namespace wholehand::sweeps
