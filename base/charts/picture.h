// SPDX-License-Identifier: MIT
// A picture of its own, as a file holds it: an SVG with its title, a white ground and its own style, so that it reads the same in
// print and on a dark page.
#pragma once

#include <string>

#include "base/charts/markup.h"

namespace wholehand {

struct PictureFrame {
  std::string title;        // is drawn, and what a screen reader says first
  std::string description;  // what a screen reader says then
  double width = 0;         // units
  double height = 0;        // units, of what is under the title
  double scale = 1;         // pixels of a unit
};

// Opens the picture, to be closed by the caller. Returns the y at which its room begins, under the title.
double open_picture(MarkupWriter& svg, const PictureFrame& frame);

}  // namespace wholehand
