// SPDX-License-Identifier: MIT
// The style of chart parts, by class.
#pragma once

#include <string>

namespace wholehand {

// Style sheets for a page with charts that sets --ink, --soft, --page, --rule, --none, --hollow and --bad: one for all charts, one for lines with a
// light and a dark color, and one for box plots.
extern const char* const CHART_RULES;
extern const char* const LINE_RULES;
extern const char* const BOX_RULES;

// CHART_RULES for a standalone picture: always black on white, and without CSS variables, which programs for papers do not support.
std::string picture_rules();

}  // namespace wholehand
