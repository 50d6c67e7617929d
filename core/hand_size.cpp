// SPDX-License-Identifier: MIT
#include "core/hand_size.h"

#include <cmath>

#include "base/numbers/normal.h"

namespace wholehand {
namespace {

constexpr int INDEX = 1, MIDDLE = 2, LITTLE = 4;
constexpr int MCP = 1;  // of a finger's radii

// How far a straight finger goes across (x) and along (-z) for each meter: Ry(-splay) Rx(-arch) (0, 0, -1).
double across(const FingerData& finger) { return std::sin(finger.splay) * std::cos(finger.arch); }
double along(const FingerData& finger) { return std::cos(finger.splay) * std::cos(finger.arch); }

double knuckle_across(const FingerData& finger) { return finger.base[0] + finger.segments[0] * across(finger); }

constexpr HandSurvey WOMEN{{181.08e-3, 10.06e-3}, {78.15e-3, 3.84e-3}, 0.570};
constexpr HandSurvey MEN{{193.28e-3, 9.95e-3}, {88.26e-3, 4.39e-3}, 0.582};

double percentile_of(const Surveyed& measure, double percentile) {
  return measure.mean + measure.deviation * normal_quantile(percentile / 100);
}

}  // namespace

HandData paper_hand() {
  HandData hand;
  hand.fingers = {{
      {{-22e-3, -9e-3, -18e-3}, radians(10), 0, {46.22e-3, 31.57e-3, 27.34e-3, 0}, {8e-3, 8e-3, 8e-3, 8e-3, 0}},
      {{-13e-3, 0, -28e-3}, radians(-8), 0, {68.12e-3, 39.78e-3, 22.38e-3, 19.66e-3}, {8e-3, 8e-3, 7.5e-3, 7e-3, 7e-3}},
      {{-2e-3, 1.5e-3, -30e-3}, 0, 0, {64.60e-3, 44.63e-3, 26.33e-3, 21.35e-3}, {8e-3, 8e-3, 7.5e-3, 7e-3, 7e-3}},
      {{8e-3, 0, -28e-3}, radians(7), radians(4), {58.00e-3, 41.37e-3, 25.65e-3, 21.25e-3}, {8e-3, 8e-3, 7.5e-3, 7e-3, 7e-3}},
      {{17e-3, -3e-3, -24e-3}, radians(15), radians(8), {53.69e-3, 32.74e-3, 18.11e-3, 19.69e-3}, {8e-3, 8e-3, 7.5e-3, 7e-3, 7e-3}},
  }};
  return hand;
}

double tip_radii(const HandData& hand) { return hand.fingers[0].radii[3] + hand.fingers[1].radii[4]; }

HandSize size_of(const HandData& hand) {
  const FingerData& middle = hand.fingers[MIDDLE];
  double finger = 0;
  for (const double segment : middle.segments) finger += segment;
  const FingerData &index = hand.fingers[INDEX], &little = hand.fingers[LITTLE];
  HandSize size;
  size.length = finger * along(middle) - middle.base[2];
  size.breadth = knuckle_across(little) + little.radii[MCP] - knuckle_across(index) + index.radii[MCP];
  return size;
}

void set_size(HandData& hand, const HandSize& size) {
  const HandSize now = size_of(hand);
  const double longer = size.length / now.length, wider = size.breadth / now.breadth;
  const double index_knuckle = knuckle_across(hand.fingers[INDEX]);
  for (int f = 0; f < FINGER_COUNT; ++f) {
    FingerData& finger = hand.fingers[f];
    const double aside = f > INDEX ? (wider - longer) * (knuckle_across(finger) - index_knuckle) : 0;
    for (double& coordinate : finger.base) coordinate *= longer;
    finger.base[0] += aside;
    for (double& segment : finger.segments) segment *= longer;
    for (double& radius : finger.radii) radius *= wider;
  }
}

const HandSurvey& hand_survey(Sex sex) { return sex == Sex::female ? WOMEN : MEN; }

HandSize surveyed_size(Sex sex, double percentile) {
  const HandSurvey& survey = hand_survey(sex);
  return {percentile_of(survey.length, percentile), percentile_of(survey.breadth, percentile)};
}

// In a population of half women and half men, a covariance is the mean of the sexes' covariances plus a quarter of the product of the
// differences of their means.
double expected_breadth(double length) {
  const auto within = [](const HandSurvey& s) { return s.correlation * s.length.deviation * s.breadth.deviation; };
  const double apart = MEN.length.mean - WOMEN.length.mean;
  const double covariance = (within(WOMEN) + within(MEN)) / 2 + apart * (MEN.breadth.mean - WOMEN.breadth.mean) / 4;
  const double variance =
      (WOMEN.length.deviation * WOMEN.length.deviation + MEN.length.deviation * MEN.length.deviation) / 2 + apart * apart / 4;
  const double mean = (WOMEN.length.mean + MEN.length.mean) / 2;
  return (WOMEN.breadth.mean + MEN.breadth.mean) / 2 + covariance / variance * (length - mean);
}

}  // namespace wholehand
