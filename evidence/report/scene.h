// SPDX-License-Identifier: MIT
// The first part of a report: the request, the machine, and what was left out.
#pragma once

#include <string>
#include <vector>

#include "evidence/report/source.h"

namespace wholehand {

// The scene in words and in its original text.
void write_scene(MarkupWriter& html, const ReportSource& source);

// Device, times and size; the sentences of `left_out`.
void write_origin(MarkupWriter& html, const ReportSource& source);

// What the sweep did not compute or keep because its scene does not need it, one sentence each.
std::vector<std::string> left_out(const ReportSource& source);

}  // namespace wholehand
