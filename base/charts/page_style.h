// SPDX-License-Identifier: MIT
// The style sheet of a report: from a phone's column to a wide screen, light, dark and printed. Charts have their own (base/charts/style.h).
#pragma once

namespace wholehand {

extern const char* const REPORT_STYLE;

}  // namespace wholehand
