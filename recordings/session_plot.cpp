// SPDX-License-Identifier: MIT
#include "recordings/session_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>

#include "system/gnuplot.h"

namespace wholehand {
namespace {

constexpr int SESSION_WIDTH = 1100, SESSION_HEIGHT = 760;
constexpr std::size_t PLOT_COLUMNS = 1500;    // of time; more ticks than that are drawn by their extremes
constexpr double NARROWEST_RUN = 1.0 / 4000;  // of the time that is shown: less is not seen
constexpr double NARROWEST_LETTER = 1.0 / 60;

// Tints of Okabe and Ito's colours, which differ in lightness too; and a letter each, for print without colours.
struct StateShade {
  SessionState state;
  const char* color;
  const char* letter;
};
constexpr StateShade STATE_SHADES[] = {{SessionState::touching, "#ececec", ""}, {SessionState::lift, "#cfe6f5", "L"},
                                       {SessionState::tilt, "#f6d391", "T"},    {SessionState::maintain, "#a9d8c6", "M"},
                                       {SessionState::slipped, "#f0b49a", "S"}, {SessionState::released, "#bdbdbd", "R"}};

struct PlotPanel {
  const char* axis;
  double bottom, height;  // of the picture
  const char* tics;
};
constexpr PlotPanel PANELS[] = {{"feedback force / N", 0.655, 0.245, "autofreq"},
                                {"tilt / deg", 0.375, 0.245, "30"},
                                {"grip force / N", 0.095, 0.245, "autofreq"}};

// One line of a panel: a number of a tick, and whether it is there.
struct PlotSeries {
  const char* block;
  double Tick::*member;
  double unit;
  bool held_only;
};
constexpr PlotSeries FEEDBACK{"$feedback", &Tick::feedback, 1, false}, NORMAL{"$normal", &Tick::normal_force, 1, true},
    TILT{"$tilt", &Tick::tilt, PI / 180, true}, GRIP{"$grip", &Tick::user_force, 1, true};

bool is_shown(const Tick& tick, const PlotSeries& series) {
  return std::isfinite(tick.*series.member) && (!series.held_only || is_held(tick.state));
}

// As a block of data: the smallest and the largest value of each column of time, in their order; an empty line where it is not there.
std::string series_data(const std::vector<Tick>& ticks, double rate, const PlotSeries& series) {
  std::string text = fmt::format("{} << EOD\n", series.block);
  const auto is_there = [&series](const Tick& tick) { return is_shown(tick, series); };
  const std::size_t column = std::max<std::size_t>(1, ticks.size() / PLOT_COLUMNS);
  bool is_open = false;
  for (std::size_t first = 0; first < ticks.size();) {
    if (!is_there(ticks[first])) {
      if (is_open) text += "\n";
      is_open = false;
      ++first;
      continue;
    }
    std::size_t least = first, most = first, end = first;
    for (; end < std::min(first + column, ticks.size()) && is_there(ticks[end]); ++end) {
      if (ticks[end].*series.member < ticks[least].*series.member) least = end;
      if (ticks[end].*series.member > ticks[most].*series.member) most = end;
    }
    for (const std::size_t k : {std::min(least, most), std::max(least, most)})
      fmt::format_to(std::back_inserter(text), "{:.6f} {:.6g}\n", static_cast<double>(ticks[k].number) / rate,
                     ticks[k].*series.member / series.unit);
    is_open = true;
    first = end;
  }
  return text + (is_open ? "" : "NaN NaN\n") + "EOD\n";
}

void shade_states(std::string& script, const SessionReport& report, double start) {
  auto out = std::back_inserter(script);
  int object = 0;
  for (const StateRun& run : report.runs) {
    const auto shade = std::find_if(std::begin(STATE_SHADES), std::end(STATE_SHADES),
                                    [&run](const StateShade& s) { return s.state == run.state; });
    if (shade == std::end(STATE_SHADES) || run.duration < NARROWEST_RUN * report.duration) continue;
    fmt::format_to(out,
                   "set object {} rectangle from first {:.6f}, graph 0 to first {:.6f}, graph 1 behind fillcolor '{}' fillstyle "
                   "solid noborder\n",
                   ++object, std::max(start, run.start), run.start + run.duration, shade->color);
  }
}

// Above the uppermost panel.
void name_states(std::string& script, const SessionReport& report) {
  for (const StateRun& run : report.runs) {
    const auto shade = std::find_if(std::begin(STATE_SHADES), std::end(STATE_SHADES),
                                    [&run](const StateShade& s) { return s.state == run.state; });
    if (shade == std::end(STATE_SHADES) || run.duration < NARROWEST_LETTER * report.duration) continue;
    fmt::format_to(std::back_inserter(script), "set label {} at first {:.6f}, graph 1.04 center font ',11' textcolor '#404040'\n",
                   gnuplot_quoted(shade->letter), run.start + run.duration / 2);
  }
}

// What the tints mean: boxes without data, beside the lines of the panel.
std::string shade_key() {
  std::string plots;
  for (const StateShade& shade : STATE_SHADES) {
    fmt::format_to(std::back_inserter(plots), ", NaN with boxes fillcolor '{}' fillstyle solid title {}", shade.color,
                   gnuplot_quoted(std::string(SESSION_STATE_NAMES[static_cast<std::size_t>(shade.state)]) +
                                  (*shade.letter ? std::string(" (") + shade.letter + ")" : "")));
  }
  return plots;
}

// An axis of its own making: gnuplot has none where a series is empty.
std::string plot_range(const std::vector<Tick>& ticks, std::initializer_list<PlotSeries> all) {
  double least = 0, most = 0;
  for (const Tick& tick : ticks) {
    for (const PlotSeries& series : all) {
      if (!is_shown(tick, series)) continue;
      least = std::min(least, tick.*series.member / series.unit);
      most = std::max(most, tick.*series.member / series.unit);
    }
  }
  if (most - least < 1e-6) most = least + 1;
  const double room = 0.05 * (most - least);
  return fmt::format("set yrange [{:.6g}:{:.6g}]\n", least < 0 ? least - room : 0, most + room);
}

void begin_panel(std::string& script, const PlotPanel& panel, bool is_last) {
  fmt::format_to(std::back_inserter(script),
                 "set bmargin at screen {:.3f}\nset tmargin at screen {:.3f}\nset ylabel {} textcolor '#202020'\nset ytics {}\n",
                 panel.bottom, panel.bottom + panel.height, gnuplot_quoted(panel.axis), panel.tics);
  script += is_last ? "set xlabel 'time / s' textcolor '#202020'\nset format x '%g'\n" : "set format x ''\n";
}

}  // namespace

std::string session_plot_script(const Recording& recording, const SessionReport& report, const std::string& file) {
  const std::vector<Tick>& ticks = recording.ticks;
  const double rate = recording.info.rate, start = static_cast<double>(ticks.front().number) / rate, end = start + report.duration;
  std::string script = gnuplot_style(SESSION_WIDTH, SESSION_HEIGHT);
  for (const PlotSeries& series : {FEEDBACK, NORMAL, TILT, GRIP}) script += series_data(ticks, rate, series);
  const std::string scene = recording.info.scene_name.empty() ? "a scene" : recording.info.scene_name;
  script += gnuplot_output(file) + "set multiplot\n";
  fmt::format_to(std::back_inserter(script),
                 "set label 1000 {} at screen 0.075, screen 0.965 left font ',14' textcolor '#202020'\n"
                 "set xrange [{:.6f}:{:.6f}]\nset format y '%4g'\nset lmargin at screen 0.075\nset rmargin at "
                 "screen 0.84\n"
                 "set grid ytics front linetype 1 linecolor '#d8d8d8' linewidth 0.5\n"
                 "set key at screen 0.85, screen 0.9 left top Left reverse samplen 1.5 textcolor '#202020'\n",
                 gnuplot_quoted("Session in " + scene + ", on " + recording.info.device.name), start, end);
  shade_states(script, report, start);
  begin_panel(script, PANELS[0], false);
  script += plot_range(ticks, {FEEDBACK, NORMAL});
  std::string letters;
  name_states(letters, report);
  script += letters;
  script +=
      "plot $feedback with lines linewidth 1.5 linecolor '#000000' title 'feedback force', "
      "$normal with lines linewidth 1.5 dashtype 2 linecolor '#d55e00' title 'normal force'" +
      shade_key() + "\nunset label\nunset key\n";
  begin_panel(script, PANELS[1], false);
  script += plot_range(ticks, {TILT});
  script += "plot $tilt with lines linewidth 1.5 linecolor '#000000'\n";
  begin_panel(script, PANELS[2], true);
  script += plot_range(ticks, {GRIP});
  script += "plot $grip with lines linewidth 1.5 linecolor '#000000'\nunset multiplot\nset output\n";
  return script;
}

std::string draw_session(const Recording& recording, const SessionReport& report, const std::string& file) {
  return draw_with_gnuplot(session_plot_script(recording, report, file), {file});
}

}  // namespace wholehand
