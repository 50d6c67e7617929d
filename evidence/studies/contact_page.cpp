// SPDX-License-Identifier: MIT
#include "evidence/studies/contact_page.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/charts/html.h"
#include "base/text/text.h"
#include "core/joints.h"
#include "evidence/studies/words.h"

namespace wholehand {
namespace {

// The statistics of the whole hand, in the order of the page.
struct ShownStatistic {
  const char *name, *text;
  bool is_share;
};
constexpr std::array<ShownStatistic, 15> OF_HAND{{
    {"held_share", "grasps that hold", true},
    {"plausible_share", "of these, plausible ones", true},
    {"mean_fingers", "fingers used, mean", false},
    {"mean_points", "points that touch, mean", false},
    {"pearson_fingers_height", "r of fingers and height", false},
    {"pearson_fingers_distance", "r of fingers and distance", false},
    {"pearson_points_height", "r of points and height", false},
    {"pearson_points_distance", "r of points and distance", false},
    {"projected_share", "grasps with projected points", true},
    {"projected_tip_share", "of these points: tip", true},
    {"projected_finger_share", "of these points: finger", true},
    {"projected_inner_share", "of these points: inner", true},
    {"grasps_projected_tip_share", "grasps with the role tip", true},
    {"grasps_projected_finger_share", "grasps with the role finger", true},
    {"grasps_projected_inner_share", "grasps with the role inner", true},
}};

// "0.52 (0.31 to 0.70)", with a dash for what is not there.
std::string value_text(const StudyRow& row, bool is_share) {
  const double unit = is_share ? 100 : 1;
  const int digits = is_share ? 0 : 2;
  std::string text = shown_number(unit * row.value, digits) + (is_share && !std::isnan(row.value) ? " %" : "");
  if (row.interval.low <= row.interval.high)
    text +=
        fmt::format(" ({} to {})", shown_number(unit * row.interval.low, digits), shown_number(unit * row.interval.high, digits));
  return text;
}

// The rows of a pose by vessel, statistic and subject.
class Found {
 public:
  explicit Found(std::span<const StudyRow> rows) {
    for (const StudyRow& row : rows) {
      rows_[{row.vessel, row.statistic, row.subject}] = &row;
      if (vessels_.empty() || vessels_.back() != row.vessel) vessels_.push_back(row.vessel);
    }
  }
  const std::vector<std::string>& vessels() const { return vessels_; }
  const StudyRow& at(const std::string& vessel, const std::string& statistic, const std::string& subject = "") const {
    return *rows_.at({vessel, statistic, subject});
  }

 private:
  std::map<std::array<std::string, 3>, const StudyRow*> rows_;
  std::vector<std::string> vessels_;
};

void write_hand_table(MarkupWriter& html, const Found& found, const std::string& pose) {
  std::vector<std::string> columns{"statistic"};
  columns.insert(columns.end(), found.vessels().begin(), found.vessels().end());
  HtmlTable table(html,
                  fmt::format("The whole hand, pose {}: the population, and the 95 % interval at the paper's sample size", pose),
                  columns);
  for (const ShownStatistic& shown : OF_HAND) {
    std::vector<std::string> cells{shown.text};
    for (const std::string& vessel : found.vessels()) cells.push_back(value_text(found.at(vessel, shown.name), shown.is_share));
    table.row(cells);
  }
  table.end();
}

// "SN, -0.62 (-0.80 to -0.35)", or why there is none.
std::string worded(const StudyRow& row, double touch_share) {
  const std::string word = word_of_correlation(row.value);
  return word.empty() ? why_no_correlation(touch_share) : (word == "-" ? "\u2013" : word) + ", " + value_text(row, false);
}

void write_point_table(MarkupWriter& html, const Found& found, const std::string& pose, const std::string& vessel) {
  HtmlTable table(html,
                  fmt::format("Table 1 as predicted: the points of the hand on {}, pose {}",
                              vessel == ALL_VESSELS ? "all vessels of the sample" : vessel, pose),
                  {"point", "touches", "with the height", "with the distance"}, {2, 3});
  for (int joint = 0; joint < JOINT_COUNT; ++joint) {
    const std::string point = joint_key(joint);
    const StudyRow& touches = found.at(vessel, "touch_share", point);
    table.row({point, value_text(touches, true), worded(found.at(vessel, "point_biserial_height", point), touches.value),
               worded(found.at(vessel, "point_biserial_distance", point), touches.value)});
  }
  table.end();
}

// `rows`: of one pose.
void write_contact_tables(MarkupWriter& html, std::span<const StudyRow> rows) {
  const Found found(rows);
  write_hand_table(html, found, rows.front().pose);
  for (const std::string& vessel : found.vessels()) write_point_table(html, found, rows.front().pose, vessel);
}

StudySection words_of_contacts() {
  return {"words",
          "The words",
          {"Each person grasps each vessel at each of its guidance points. The height is that of the line between thumb and index "
           "finger. The distance is that of the nearer contact, on the skin, from the guidance point. A grasp holds if the grip is "
           "feasible; all other numbers are of the grasps that hold.",
           fmt::format(
               "VSN, SN and N: a very strong (|r| from {}), a strong (from {}) and a weaker (from {}) negative "
               "correlation; P, SP and VSP: the same, positive; \u2013: a smaller one. These limits are ours, and apply to r in "
               "two digits. A point that always or never touches has none.",
               VERY_STRONG_R, STRONG_R, WEAK_R)},
          {}};
}

}  // namespace

void add_contact_sections(StudyPage& page, const ContactPlan& plan, std::span<const StudyRow> rows) {
  std::vector<std::string> samples;
  for (const StudyVessel& vessel : plan.vessels())
    samples.push_back(fmt::format("{}: {}{}", vessel.name, vessel.sample, vessel.is_of_paper ? "" : " (not in \u201call\u201d)"));
  std::vector<std::string> words;
  words.push_back(
      fmt::format("A sample of the paper's size has {} people, and these grasps. {}.", PAPER_PEOPLE, joined(samples, ", ")));
  if (!plan.unheld().empty())
    words.push_back(fmt::format("The mean person cannot hold {}: there everybody plans the roll 0.", joined(plan.unheld(), ", ")));
  for (const char* pose : STUDY_POSE_NAMES) {
    StudySection section{pose, fmt::format("Contacts, pose {}", pose), std::exchange(words, {}), {}};
    for (const StudyRow& row : rows)
      if (row.pose == pose) section.rows.push_back(row);
    section.words.emplace_back(
        "The tables of points predict the paper\u2019s Table 1: how each point\u2019s touch goes with the height and with the "
        "distance, in words. The shares with projected points and roles predict the paper\u2019s projection rates. The "
        "paper\u2019s "
        "own numbers are not known here, and nothing is fitted to them.");
    section.write = write_contact_tables;
    page.sections.push_back(std::move(section));
  }
  page.sections.push_back(words_of_contacts());
}

}  // namespace wholehand
