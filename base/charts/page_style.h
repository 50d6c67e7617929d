// SPDX-License-Identifier: MIT
// The style sheet of a report: a phone's column to a wide screen, light and dark, and paper. Its charts have theirs (base/charts/style.h).
#pragma once

namespace wholehand {

extern const char* const REPORT_STYLE;

}  // namespace wholehand
