// SPDX-License-Identifier: MIT
// Sizes of hands: lengths come from a survey of hand lengths, widths and thicknesses from a survey of hand breadths.
#pragma once

#include "core/scene.h"

namespace wholehand {

// Sizes of the flat hand (every joint straight) at scale 1, m.
struct HandSize {
  double length = 0;   // from the wrist to the tip of the middle finger, along the hand (-z)
  double breadth = 0;  // across the knuckles (x), from skin to skin: MCP of the index finger to MCP of the little finger
};

HandSize size_of(const HandData& hand);

// Sum of the radii of the tips of thumb and index finger at scale 1, m: a held object is this much thinner than their gap.
double tip_radii(const HandData& hand);

// The hand of `person = "paper"`, with default scale and limits: as long as the mean adult's, but narrower than 99 of 100 women's hands.
HandData paper_hand();

// Gives the hand a size. Bases and segments scale with the length, radii with the breadth. The middle, ring and little finger move sideways,
// unturned, so that the distances of their knuckles from the index finger's scale with the breadth. Thumb and index finger therefore keep their
// shape, and the gap scales with the length.
void set_size(HandData& hand, const HandSize& size);

enum class Sex { female, male };

// One measure of a survey, m.
struct Surveyed {
  double mean = 0;
  double deviation = 0;  // standard deviation
};

// Adults of one sex.
struct HandSurvey {
  Surveyed length, breadth;
  double correlation = 0;  // of the two
};

// ANSUR II: 1,986 women and 4,082 men of the US Army, measured in 2010 to 2012 (Gordon et al. 2014, NATICK/TR-15/007).
// Computed from the survey's public data.
const HandSurvey& hand_survey(Sex sex);

// The length and the breadth that `percentile` per cent of a sex do not reach, 0 < percentile < 100, by normal distributions with the survey's
// moments.
HandSize surveyed_size(Sex sex, double percentile);

// The expected breadth of an adult's hand of this length (m), if nothing else is known: the regression over equally many women and men.
double expected_breadth(double length);

}  // namespace wholehand
