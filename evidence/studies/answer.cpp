// SPDX-License-Identifier: MIT
#include "evidence/studies/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include "base/charts/axes.h"
#include "base/charts/html.h"
#include "base/text/text.h"
#include "evidence/studies/paper_sample.h"
#include "evidence/studies/statistic_words.h"

namespace wholehand {
namespace {

// ---- words ----

std::string experiment_words(const StudyRow& row) {
  std::string words = row.experiment;
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words + ", " + (row.vessel == ALL_VESSELS ? "all vessels" : row.vessel);
}

std::string row_words(const StudyRow& row) {
  if (row.experiment == "forces" && row.statistic == "lost_share") return fmt::format("lost often at {} N", row.subject);
  return statistic_words(row.statistic) + (row.subject.empty() ? "" : ", " + row.subject);
}

std::string signed_value(const StudyRow& row, double value) {
  return (value > 0 ? "+" : "") + statistic_value(row.statistic, value);
}

bool has_width(const StudyRow& row) { return row.interval.high - row.interval.low > SHARE_ROUNDING; }

// ---- the picture ----

// units
constexpr double WIDTH = 760, LEFT = 238, RIGHT = 478, TOP = 40, ROW = 17, GAP = 9, BAR = 4, MARK = 4.2, ARROW = 6;
constexpr std::array<double, 4> COLUMNS{546, 608, 670, 738};  // right ends of the numbers
constexpr double MOST = 6;                                    // half widths from the middle; an arrow stands for more

double height_of(std::span<const StudyRow> rows) {
  double height = TOP;
  for (std::size_t k = 0; k < rows.size(); ++k)
    height += ROW + (k == 0 || experiment_words(rows[k - 1]) != experiment_words(rows[k]) ? ROW + GAP : 0);
  return height;
}

void put_path(MarkupWriter& svg, const char* style, const std::string& path) { svg.empty("path", {{"class", style}, {"d", path}}); }

void put_disc(MarkupWriter& svg, double x, double y) {
  svg.empty("circle", {{"class", "inside"}, {"cx", chart_number(x)}, {"cy", chart_number(y)}, {"r", chart_number(MARK)}});
}

void put_diamond(MarkupWriter& svg, double x, double y) {
  put_path(svg, "outside",
           fmt::format("M{0} {1}L{2} {3}L{0} {4}L{5} {3}z", chart_number(x), chart_number(y - MARK - 1), chart_number(x + MARK + 1),
                       chart_number(y), chart_number(y + MARK + 1), chart_number(x - MARK - 1)));
}

void put_arrow(MarkupWriter& svg, double x, double y, double direction) {
  put_path(
      svg, "outside",
      fmt::format("M{} {}L{} {}L{} {}z", chart_number(x + direction * ARROW), chart_number(y), chart_number(x - direction * ARROW),
                  chart_number(y - MARK), chart_number(x - direction * ARROW), chart_number(y + MARK)));
}

// The interval is the bar from -1 to 1, and the thin line in it is our value.
void put_interval(MarkupWriter& svg, const PlotArea& area, const StudyRow& row, double y) {
  const double middle = 0.5 * (row.interval.low + row.interval.high), half = 0.5 * (row.interval.high - row.interval.low);
  const auto place = [&](double value) { return (value - middle) / half; };
  if (has_width(row)) {
    svg.empty("rect", {{"class", "box"},
                       {"x", chart_number(area.x(-1))},
                       {"y", chart_number(y - BAR)},
                       {"width", chart_number(area.x(1) - area.x(-1))},
                       {"height", chart_number(2 * BAR)}});
    const double value = std::clamp(place(row.value), -MOST, MOST);
    put_line(svg, area.x(value), y - BAR, area.x(value), y + BAR, "median");
  } else {
    put_line(svg, area.x(0), y - BAR - 1, area.x(0), y + BAR + 1, "median");
  }
  if (*row.off() == 0) {
    put_disc(svg, area.x(has_width(row) ? place(*row.paper) : 0), y);
  } else if (has_width(row) && std::abs(place(*row.paper)) <= MOST) {
    put_diamond(svg, area.x(place(*row.paper)), y);
  } else {
    const double direction = *row.off() > 0 ? -1 : 1;
    put_arrow(svg, area.x(direction * MOST), y, direction);
  }
}

void put_row(MarkupWriter& svg, const PlotArea& area, const StudyRow& row, double y) {
  const double foot = y + 0.35 * CHART_LETTER;
  put_text(svg, LEFT - 12, foot, row_words(row), "end");
  put_interval(svg, area, row, y);
  const std::array<double, 4> numbers{row.interval.low, row.value, row.interval.high, *row.paper};
  for (std::size_t k = 0; k < numbers.size(); ++k)
    put_text(svg, COLUMNS[k], foot, page_text(statistic_value(row.statistic, numbers[k])), "end");
}

// What bars, lines and marks mean. Returns the y of its foot.
double put_key(MarkupWriter& svg, double top) {
  const double mark = 14, text = 30;
  double y = top + 14;
  const auto line = [&](const std::string& words, const auto& put) {
    put(y);
    put_text(svg, text, y + 0.35 * CHART_LETTER, words, "start");
    y += ROW;
  };
  line("the paper\u2019s value inside our interval", [&](double at) { put_disc(svg, mark, at); });
  line("outside it", [&](double at) { put_diamond(svg, mark, at); });
  line(fmt::format("outside it, by more than {:g} half widths, or by any difference if the interval has no width", MOST - 1),
       [&](double at) { put_arrow(svg, mark, at, 1); });
  line("our 95 % interval at the paper\u2019s sample size, scaled to one width in all rows, with the value of the population",
       [&](double at) {
         svg.empty("rect", {{"class", "box"},
                            {"x", chart_number(mark - 10)},
                            {"y", chart_number(at - BAR)},
                            {"width", "20"},
                            {"height", chart_number(2 * BAR)}});
         put_line(svg, mark + 3, at - BAR, mark + 3, at + BAR, "median");
       });
  line("no width: all samples have this one value",
       [&](double at) { put_line(svg, mark, at - BAR - 1, mark, at + BAR + 1, "median"); });
  return y;
}

std::string spoken(const StudyRow& row) {
  return fmt::format(" {}, {}: {} ({}), the paper {}, {}.", experiment_words(row), row_words(row),
                     statistic_value(row.statistic, row.value), interval_words(row), statistic_value(row.statistic, *row.paper),
                     *row.inside() ? "inside" : "outside");
}

void write_picture(MarkupWriter& html, std::span<const StudyRow> rows) {
  ChartName name{"intervals", "The paper\u2019s numbers and our 95 % intervals", "Each row scales our interval to one width."};
  for (const StudyRow& row : rows) name.description += spoken(row);
  const double bottom = height_of(rows) + 4;
  const PlotArea area{LEFT, TOP, RIGHT, bottom, -MOST - 0.6, MOST + 0.6, 0, 1};
  MarkupWriter key;
  const double foot = put_key(key, bottom + 2.2 * CHART_LETTER + 8);
  html.open("figure", {{"class", "wide answer"}, {"role", "region"}, {"tabindex", "0"}, {"aria-label", name.title}});
  open_chart(html, name, foot, WIDTH);
  const std::array<const char*, 4> heads{"low", "value", "high", "the paper"};
  for (std::size_t k = 0; k < heads.size(); ++k) put_text(html, COLUMNS[k], TOP - 10, heads[k], "end");
  for (double tick = -MOST; tick <= MOST; tick += 2) put_line(html, area.x(tick), TOP, area.x(tick), bottom, "grid");
  put_x_axis(html, area, {-6, -4, -2, 0, 2, 4, 6}, "half widths of the interval from its middle");
  put_frame(html, area);
  double y = TOP;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (const std::string words = experiment_words(rows[k]); k == 0 || experiment_words(rows[k - 1]) != words) {
      y += GAP + ROW;
      put_text(html, 4, y - 5, words, "start head");
    }
    put_row(html, area, rows[k], y + 0.5 * ROW);
    y += ROW;
  }
  html.markup(key.written()).close();
  html.close();
}

// ---- the table ----

// By how much the paper's numbers miss the intervals.
void write_misses(MarkupWriter& html, std::span<const StudyRow> rows) {
  HtmlTable table(html, "Outside: what would bring the paper\u2019s number to the nearer end of our interval",
                  {"statistic", "of", "the paper", "nearer end", "change", "of the paper\u2019s number"}, {1});
  for (const StudyRow& row : rows) {
    const double off = *row.off(), paper = *row.paper;
    if (off == 0) continue;
    const std::string share = paper == 0 ? "-" : fmt::format("{:+.0f} %", 100 * off / std::abs(paper));
    std::vector<std::string> cells{row_words(row), experiment_words(row)};
    for (const std::string& text :
         {statistic_value(row.statistic, paper), statistic_value(row.statistic, paper + off), signed_value(row, off), share})
      cells.push_back(page_text(text));
    table.row(cells);
  }
  table.end();
}

void write_answer(MarkupWriter& html, std::span<const StudyRow> rows) {
  write_picture(html, rows);
  if (count_inside(rows).inside < rows.size()) write_misses(html, rows);
}

std::string share_words(const InsideCount& count) { return fmt::format("{} of {}", count.inside, count.of); }

}  // namespace

std::string answer_sentence(std::span<const StudyRow> rows) {
  std::vector<std::string> parts;
  bool has_contacts = false;
  for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
    while (end < rows.size() && rows[end].experiment == rows[first].experiment) ++end;
    const InsideCount count = count_inside(rows.subspan(first, end - first));
    if (count.of > 0) parts.push_back(share_words(count) + " for " + rows[first].experiment);
    has_contacts = has_contacts || rows[first].experiment == "contacts";
  }
  const InsideCount all = count_inside(rows);
  return (all.of > 0 ? fmt::format("{} of the paper\u2019s numbers lie inside our 95 % intervals: {}.", share_words(all),
                                   joined(parts, ", "))
                     : std::string("None of the paper\u2019s numbers can be compared here.")) +
         (has_contacts ? " The paper\u2019s numbers for contacts are not known here, so ours are predictions." : "");
}

StudySection answer_section(std::span<const StudyRow> rows) {
  StudySection section;
  section.id = "answer";
  section.title = "The answer";
  section.words = {answer_sentence(rows)};
  for (const StudyRow& row : rows)
    if (row.inside()) section.rows.push_back(row);
  section.write = write_answer;
  return section;
}

}  // namespace wholehand
