// SPDX-License-Identifier: MIT
// What a report says first: what was asked, on what it ran, and what was left out.
#pragma once

#include <string>
#include <vector>

#include "evidence/report/source.h"

namespace wholehand {

// The scene in words and as it was written.
void write_scene(MarkupWriter& html, const ReportSource& source);

// Device, times and size; the sentences of `left_out`.
void write_origin(MarkupWriter& html, const ReportSource& source);

// What the sweep did not compute or keep, because its scene does not need it: a sentence each.
std::vector<std::string> left_out(const ReportSource& source);

}  // namespace wholehand
