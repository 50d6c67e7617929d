// SPDX-License-Identifier: MIT
#include "base/charts/picture.h"

#include <fmt/format.h>

#include <vector>

#include "base/charts/axes.h"
#include "base/charts/style.h"
#include "base/files/pictures.h"

namespace wholehand {
namespace {

constexpr double TITLE_LETTER = 13;   // units, as the style sheet has it
constexpr double TITLE_WIDER = 1.28;  // than other text: it is larger and bold
constexpr double TITLE_SIDE = 2;      // units, free at its left and at its right

// The longest beginning that fits, in whole words if there is more than one; at least a letter.
std::size_t line_end(const std::string& text, double room) {
  std::size_t end = 0, word_end = 0;
  while (end < text.size()) {
    std::size_t next = end + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xC0) == 0x80) ++next;
    if (end > 0 && TITLE_WIDER * text_width(text.substr(0, next)) > room) return word_end > 0 ? word_end : end;
    if (text[end] == ' ') word_end = next;
    end = next;
  }
  return end;
}

std::vector<std::string> title_lines(std::string title, double room) {
  std::vector<std::string> lines;
  while (!title.empty()) {
    const std::size_t end = line_end(title, room);
    lines.push_back(title.substr(0, end));
    title.erase(0, end);
  }
  return lines;
}

}  // namespace

double open_picture(MarkupWriter& svg, const PictureFrame& frame) {
  const std::vector<std::string> lines = title_lines(frame.title, frame.width - 2 * TITLE_SIDE);
  const double step = 1.3 * TITLE_LETTER, under = 10 + step * static_cast<double>(lines.size()), height = under + frame.height;
  svg.markup("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"width", chart_number(frame.scale * frame.width)},
                   {"height", chart_number(frame.scale * height)},
                   {"viewBox", fmt::format("0 0 {} {}", chart_number(frame.width), chart_number(height))},
                   {"role", "img"},
                   {"aria-labelledby", "title text"}});
  svg.markup(PICTURE_MARK).markup("\n");  // before a name from a scene or recording, which may be long
  svg.element("title", frame.title, {{"id", "title"}});
  svg.element("desc", frame.description, {{"id", "text"}});
  svg.open("style").markup("\n" + picture_rules()).close();
  svg.empty("rect", {{"width", chart_number(frame.width)}, {"height", chart_number(height)}, {"fill", "#ffffff"}});
  for (std::size_t k = 0; k < lines.size(); ++k)
    put_text(svg, TITLE_SIDE, 4 + step * static_cast<double>(k + 1), lines[k], "title");
  return under;
}

}  // namespace wholehand
