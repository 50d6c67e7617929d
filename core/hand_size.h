// SPDX-License-Identifier: MIT
// How large a hand is, and hands of people's sizes: lengths by a survey of hand lengths, what lies across by a survey of hand
// breadths.
#pragma once

#include "core/scene.h"

namespace wholehand {

// Sizes of the flat hand (every joint straight) at scale 1, m.
struct HandSize {
  double length = 0;   // from the wrist to the tip of the middle finger, along the hand (-z)
  double breadth = 0;  // across the knuckles (x), from skin to skin: MCP of the index finger to MCP of the little finger
};

HandSize size_of(const HandData& hand);

// Sum of the radii of the tips of thumb and index finger at scale 1, m: a held object is thinner than their gap by this.
double tip_radii(const HandData& hand);

// The hand of `person = "paper"`, scale and limits the default's: as long as the mean adult's, but narrower than 99 of 100
// hands of women.
HandData paper_hand();

// Gives the hand a size. All bases and segments take the ratio of the lengths, all radii that of the breadths; the middle, ring
// and little finger move sideways, as they are, until their knuckles lie apart from the index finger's by the ratio of the
// breadths. Thumb and index finger therefore keep their form, and the hand closes as it did: its gap is the former one times the
// ratio of the lengths.
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

// The length and the breadth below which `percentile` per cent of a sex lie, 0 < percentile < 100: of normal distributions with
// the survey's moments.
HandSize surveyed_size(Sex sex, double percentile);

// The breadth to expect of an adult's hand of this length (m), where nothing else is known: the regression over as many women as
// men.
double expected_breadth(double length);

}  // namespace wholehand
