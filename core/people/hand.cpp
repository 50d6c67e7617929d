// SPDX-License-Identifier: MIT
// A person's own hand.
#include <cmath>

#include "core/people/person.h"
#include "core/prepare.h"

namespace wholehand {
namespace {

// Buryanov & Kotiuk 2010, Table I: mean and standard deviation of the segments of 66 adults, mm. The pulp is added to the last
// segment.
struct Segment {
  double mean, deviation, pulp_mean = 0, pulp_deviation = 0;
};
constexpr std::array<Segment, SEGMENT_COUNT> SEGMENTS{{
    {46.22, 3.94},
    {31.57, 3.13},
    {21.67, 1.60, 5.67, 0.61},  // thumb
    {68.12, 6.27},
    {39.78, 4.94},
    {22.38, 2.51},
    {15.82, 2.26, 3.84, 0.59},  // index
    {64.60, 5.38},
    {44.63, 3.81},
    {26.33, 3.00},
    {17.40, 1.85, 3.95, 0.61},  // middle
    {58.00, 5.06},
    {41.37, 3.87},
    {25.65, 3.29},
    {17.30, 2.22, 3.95, 0.60},  // ring
    {53.69, 4.36},
    {32.74, 2.77},
    {18.11, 2.54},
    {15.96, 2.45, 3.73, 0.62},  // little
}};

// The variation of length among equally many women and men: each sex has its own variation, and the means differ.
double length_variation() {
  const Surveyed &women = hand_survey(Sex::female).length, &men = hand_survey(Sex::male).length;
  const double apart = men.mean - women.mean;
  const double variance = (women.deviation * women.deviation + men.deviation * men.deviation) / 2 + apart * apart / 4;
  return 2 * std::sqrt(variance) / (women.mean + men.mean);
}

void end_at(double closure, AngleRange& range) { range.closed = range.open + closure * (range.closed - range.open); }

}  // namespace

double segment_deviation(std::size_t segment) {
  const Segment& s = SEGMENTS[segment];
  const double all = std::hypot(s.deviation, s.pulp_deviation) / (s.mean + s.pulp_mean), length = length_variation();
  return std::sqrt(std::fmax(0, all * all - length * length));
}

HandData hand_of(const HandData& plain, const Person& person) {
  HandData hand = plain;
  hand.scale = 1;
  // The scene's hand size has moved the knuckles sideways. Another size undoes this, but not after the proportions, so these always apply to a hand
  // of the default's size.
  set_size(hand, size_of(HandData{}));
  std::size_t at = 0;
  for (int f = 0; f < FINGER_COUNT; ++f)
    for (int k = 0; k < (f == 0 ? 3 : 4); ++k) hand.fingers[f].segments[k] *= person.segments[at++];
  set_size(hand, person.hand);
  const double end = gap_falls_until(hand);
  if (end < 1) {
    for (AngleRange* range : {&hand.thumb_abduction, &hand.thumb_mcp, &hand.thumb_ip, &hand.mcp, &hand.pip}) end_at(end, *range);
  }
  return hand;
}

}  // namespace wholehand
