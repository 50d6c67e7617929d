// SPDX-License-Identifier: MIT
#include "sweeps/grips/view.h"

#include <fmt/format.h>

#include <cmath>

namespace wholehand::sweeps {

std::string number_text(double value) { return fmt::format("{:.2f}", std::abs(value) < 0.005 ? 0 : value); }
std::string point_text(const Flat& p) { return number_text(p[0]) + " " + number_text(p[1]); }

void draw_line(std::string& svg, const Flat& a, const Flat& b, const char* style) {
  svg += fmt::format("<path class=\"{}\" d=\"M{}L{}\"/>\n", style, point_text(a), point_text(b));
}

}  // namespace wholehand::sweeps
