// SPDX-License-Identifier: MIT
// A standalone picture file: an SVG with a title, a white background and its own style, so it reads the same in print and on a dark page.
#pragma once

#include <string>

#include "base/charts/markup.h"

namespace wholehand {

struct PictureFrame {
  std::string title;        // drawn, and read first by a screen reader
  std::string description;  // read next by a screen reader
  double width = 0;         // units
  double height = 0;        // units, of the area under the title
  double scale = 1;         // pixels of a unit
};

// Opens the picture; the caller closes it. Returns the y at which the area under the title begins.
double open_picture(MarkupWriter& svg, const PictureFrame& frame);

}  // namespace wholehand
