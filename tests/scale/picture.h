// SPDX-License-Identifier: MIT
// Efficiency over ranks as a picture.
#pragma once

#include <string>
#include <vector>

#include "tests/scale/machine.h"

namespace wholehand::scale {

// A line of the table; those of a group and a label make a line of the picture.
struct Row {
  std::string group, label;
  Job job;
  Outcome outcome;
};

// As SVG, of the groups cpu and gpu.
std::string scale_picture(const std::vector<Row>& rows);

}  // namespace wholehand::scale
