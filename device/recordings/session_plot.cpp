// SPDX-License-Identifier: MIT
#include "device/recordings/session_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>

#include "base/charts/colors.h"
#include "base/charts/picture.h"
#include "base/charts/plot.h"

namespace wholehand::device {
namespace {

// units; pixels a unit
constexpr double SESSION_WIDTH = 760, SESSION_SCALE = 1.4, SESSION_LEFT = 46, SESSION_RIGHT = SESSION_WIDTH - 8;
constexpr double PANEL_HEIGHT = 130, PANEL_STEP = 162;
constexpr double LETTERS_RISE = 5;  // of the states' letters above the uppermost panel
constexpr double SESSION_HEIGHT = 2 * LEGEND_STEP + 44 + 3 * PANEL_STEP;
constexpr std::size_t PLOT_COLUMNS = 1400;    // of time; more ticks than that are drawn by their extremes
constexpr double NARROWEST_RUN = 1.0 / 4000;  // of the time that is shown: less is not seen
constexpr double NARROWEST_LETTER = 1.0 / 60;

// Tints, which differ in lightness too; and a letter each, for print without colors.
struct StateShade {
  SessionState state;
  std::string color;
  const char* letter;
};
const std::vector<StateShade>& state_shades() {
  static const std::vector<StateShade> shades{
      {SessionState::touching, tint(okabe_ito::BLACK, 0.075), ""},    {SessionState::lift, tint(okabe_ito::SKY_BLUE, 0.28), "L"},
      {SessionState::tilt, tint(okabe_ito::ORANGE, 0.45), "T"},       {SessionState::maintain, tint(okabe_ito::GREEN, 0.34), "M"},
      {SessionState::slipped, tint(okabe_ito::VERMILION, 0.45), "S"}, {SessionState::let_go, tint(okabe_ito::BLUE, 0.3), "G"},
      {SessionState::released, tint(okabe_ito::BLACK, 0.26), "R"}};
  return shades;
}

// One line of a panel: a number of a tick, and whether it is there.
struct PlotSeries {
  double Tick::*member;
  double unit;
  bool held_only;
};
constexpr PlotSeries FEEDBACK{&Tick::feedback, 1, false}, NORMAL{&Tick::normal_force, 1, true}, TILT{&Tick::tilt, PI / 180, true},
    GRIP{&Tick::user_force, 1, true};

bool is_shown(const Tick& tick, const PlotSeries& series) {
  return std::isfinite(tick.*series.member) && (!series.held_only || is_held(tick.state));
}

double seconds_of(const Recording& recording, const Tick& tick) { return static_cast<double>(tick.number) / recording.info.rate; }

// The smallest and the largest value of each column of time, in their order; a gap where it is not there.
std::vector<std::array<double, 2>> series_points(const Recording& recording, const PlotSeries& series) {
  const std::vector<Tick>& ticks = recording.ticks;
  const auto is_there = [&series](const Tick& tick) { return is_shown(tick, series); };
  const std::size_t column = std::max<std::size_t>(1, ticks.size() / PLOT_COLUMNS);
  std::vector<std::array<double, 2>> points;
  for (std::size_t first = 0; first < ticks.size();) {
    if (!is_there(ticks[first])) {
      points.push_back({seconds_of(recording, ticks[first]), std::nan("")});
      while (first < ticks.size() && !is_there(ticks[first])) ++first;
      continue;
    }
    std::size_t least = first, most = first, end = first;
    for (; end < std::min(first + column, ticks.size()) && is_there(ticks[end]); ++end) {
      if (ticks[end].*series.member < ticks[least].*series.member) least = end;
      if (ticks[end].*series.member > ticks[most].*series.member) most = end;
    }
    for (const std::size_t k : {std::min(least, most), std::max(least, most)})
      points.push_back({seconds_of(recording, ticks[k]), ticks[k].*series.member / series.unit});
    first = end;
  }
  return points;
}

double largest(const Recording& recording, const PlotSeries& series) {
  double most = 0;
  for (const Tick& tick : recording.ticks)
    if (is_shown(tick, series)) most = std::max(most, tick.*series.member / series.unit);
  return most;
}

// From 0 where nothing is below it, with a twentieth of room.
void set_range(PlotAxis& axis, const Recording& recording, std::initializer_list<PlotSeries> all) {
  double least = 0, most = 0;
  for (const PlotSeries& series : all) {
    most = std::max(most, largest(recording, series));
    for (const Tick& tick : recording.ticks)
      if (is_shown(tick, series)) least = std::min(least, tick.*series.member / series.unit);
  }
  if (most - least < 1e-6) most = least + 1;
  const double room = 0.05 * (most - least);
  axis.low = least < 0 ? least - room : 0;
  axis.high = most + room;
}

// A layer for each state, with its stretches from the bottom to the top of an axis.
std::vector<PlotLayer> shade_layers(const SessionReport& report, const PlotAxis& time, const PlotAxis& axis) {
  std::vector<PlotLayer> layers;
  for (const StateShade& shade : state_shades()) {
    PlotLayer layer;
    layer.label = SESSION_STATE_NAMES[static_cast<std::size_t>(shade.state)];
    if (*shade.letter) layer.label += fmt::format(" ({})", shade.letter);
    layer.color = shade.color;
    layer.is_area = true;
    for (const StateRun& run : report.runs) {
      if (run.state != shade.state || run.duration < NARROWEST_RUN * report.duration) continue;
      layer.boxes.push_back({std::max(time.low, run.start), axis.low, run.start + run.duration, axis.high});
    }
    layers.push_back(layer);
  }
  return layers;
}

// Above the uppermost panel.
void put_letters(MarkupWriter& svg, const SessionReport& report, const PlotAxis& time, double y) {
  const PlotArea across{SESSION_LEFT, 0, SESSION_RIGHT, 1, time.low, time.high};
  for (const StateRun& run : report.runs) {
    if (run.duration < NARROWEST_LETTER * report.duration) continue;
    for (const StateShade& shade : state_shades())
      if (shade.state == run.state && *shade.letter)
        put_text(svg, across.x(run.start + 0.5 * run.duration), y, shade.letter, "mid");
  }
}

PlotLayer line_layer(const char* label, const Rgb& color, const char* dashes, const std::vector<std::array<double, 2>>& points) {
  PlotLayer layer;
  layer.label = label;
  layer.color = color_text(color);
  layer.line = 1.2;
  layer.dashes = dashes;
  layer.points = points;
  return layer;
}

// The panel of some series over time, above the shades of the states.
Plot session_panel(const Recording& recording, const SessionReport& report, const PlotAxis& time, const char* label,
                   std::initializer_list<PlotSeries> all) {
  Plot panel;
  panel.x = time;
  panel.y.label = label;
  panel.y.has_grid = true;
  panel.label_rise = 8;
  set_range(panel.y, recording, all);
  panel.layers = shade_layers(report, time, panel.y);
  return panel;
}

std::string spoken_session(const Recording& recording, const SessionReport& report) {
  std::string text = fmt::format(
      "Three panels over {:.1f} s: feedback force, at most {:.2f} N, and normal force, at most {:.2f} N; tilt, at most "
      "{:.0f}\u00b0; "
      "grip force, at most {:.2f} N. Shaded by state:",
      report.duration, largest(recording, FEEDBACK), largest(recording, NORMAL), largest(recording, TILT),
      largest(recording, GRIP));
  for (const StateShade& shade : state_shades()) {
    const auto state = static_cast<std::size_t>(shade.state);
    text += fmt::format("{} {} {:.1f} s", &shade == &state_shades().front() ? "" : ",", SESSION_STATE_NAMES[state],
                        report.time_in_state[state]);
  }
  return text + ".";
}

}  // namespace

std::string session_picture(const Recording& recording, const SessionReport& report) {
  PlotAxis time;
  time.label = "time (s)";
  time.low = seconds_of(recording, recording.ticks.front());
  time.high = time.low + std::max(report.duration, 1 / recording.info.rate);
  time.has_numbers = false;
  Plot force = session_panel(recording, report, time, "feedback force (N)", {FEEDBACK, NORMAL});
  force.label_rise = LETTERS_RISE + 14;  // the letters stand between
  const std::vector<PlotLayer> states = force.layers;
  const std::vector<PlotLayer> lines{line_layer("feedback force", okabe_ito::BLACK, "", series_points(recording, FEEDBACK)),
                                     line_layer("normal force", okabe_ito::VERMILION, "5 3", series_points(recording, NORMAL))};
  force.layers.insert(force.layers.end(), lines.begin(), lines.end());
  Plot tilt = session_panel(recording, report, time, "tilt (\u00b0)", {TILT});
  // a damaged recording may have any number as a tilt: the axis then finds its own ticks
  if (tilt.y.high - tilt.y.low <= 720)
    for (double tick = 30 * std::ceil(tilt.y.low / 30); tick <= tilt.y.high; tick += 30) tilt.y.ticks.push_back(tick);
  tilt.layers.push_back(line_layer("", okabe_ito::BLACK, "", series_points(recording, TILT)));
  Plot grip = session_panel(recording, report, time, "grip force (N)", {GRIP});
  grip.layers.push_back(line_layer("", okabe_ito::BLACK, "", series_points(recording, GRIP)));
  grip.x.has_numbers = true;

  const std::string scene = recording.info.scene_name.empty() ? "a scene" : recording.info.scene_name;
  MarkupWriter svg;
  double top = open_picture(svg, {"Session in " + scene + ", on " + recording.info.device.name, spoken_session(recording, report),
                                  SESSION_WIDTH, SESSION_HEIGHT, SESSION_SCALE});
  top = put_legend(svg, lines, 2, top + CHART_LETTER, SESSION_RIGHT) + LEGEND_STEP;
  top = put_legend(svg, states, 2, top, SESSION_RIGHT) + 42;
  put_letters(svg, report, time, top - LETTERS_RISE);
  for (const Plot* panel : {&force, &tilt, &grip}) {
    put_plot(svg, *panel, {SESSION_LEFT, top, SESSION_RIGHT, top + PANEL_HEIGHT});
    top += PANEL_STEP;
  }
  return svg.close().written();
}

}  // namespace wholehand::device
