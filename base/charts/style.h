// SPDX-License-Identifier: MIT
// How the parts of charts look, by their classes.
#pragma once

#include <string>

namespace wholehand {

// Style sheets for a page that has charts in it and sets --ink, --soft, --page, --rule, --none, --hollow and --bad: what all charts
// use, what lines with a color by day and another by night use, and what box plots use.
extern const char* const CHART_RULES;
extern const char* const LINE_RULES;
extern const char* const BOX_RULES;

// CHART_RULES for a picture of its own: black on white by day and by night, and without variables, which programs for papers do not
// know.
std::string picture_rules();

}  // namespace wholehand
