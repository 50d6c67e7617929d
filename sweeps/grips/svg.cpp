// SPDX-License-Identifier: MIT
#include "sweeps/grips/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/charts/colors.h"
#include "base/charts/markup.h"
#include "base/text/readable.h"
#include "core/joints.h"
#include "core/vectors.h"
#include "shaders/layout.h"
#include "sweeps/grips/forces.h"
#include "sweeps/grips/glass.h"
#include "sweeps/grips/hand_nodes.h"
#include "sweeps/grips/states.h"

namespace wholehand::sweeps {
namespace {

constexpr double PAPER_WIDTH = 180;    // mm, at most
constexpr double PAPER_HEIGHT = 250;   // mm, at most
constexpr double LEGEND_WIDTH = 24;    // letters
constexpr double LEGEND_HEIGHT = 19;   // letters
constexpr double FORCES_HEIGHT = 3;    // letters, what the legend says of forces
constexpr double PAPER_FONT = 2.8;     // mm: 8 pt
constexpr double PAPER_LINE = 0.25;    // mm
constexpr double SMALLEST_SKIN = 1.5;  // mm: a bare point is still seen
constexpr std::array<char, FINGER_COUNT> INITIALS{'T', 'I', 'M', 'R', 'L'};
constexpr double PAPER_DETAIL = 0.1;  // mm, of a mesh

// The hand and the glass in mm, and what the views have in common.
struct Drawing {
  const GripReport& report;
  DrawnGlass glass;
  DrawnForces forces;
  std::string vessel;
  double base = 0;                           // m
  std::array<Triple, JOINT_COUNT> joints{};  // m
  std::array<double, JOINT_COUNT> skin{};    // mm
  double unit = 0;                           // mm of the vessel on a mm of paper
  double font = 0, line = 0;                 // mm of the vessel
};

// Extent of hand, glass and arrows along a direction, mm.
std::array<double, 2> extent_along(const Drawing& drawing, const Triple& axis) {
  std::array<double, 2> extent = drawing.glass.extent_along(axis);
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const Triple& p = drawing.joints[j];
    const double at = 1e3 * dot(axis, p);
    extent = {std::min(extent[0], at - drawing.skin[j]), std::max(extent[1], at + drawing.skin[j])};
  }
  drawing.forces.widen(extent, axis, drawing.unit);
  return extent;
}

// ---- the hand ----

// Hull of two discs, as they are seen of a bone.
std::string bone_path(const Flat& a, double ra, const Flat& b, double rb) {
  const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
  if (length <= std::abs(ra - rb) + 1e-6) {
    const Flat& c = ra >= rb ? a : b;
    const double r = std::max(ra, rb);
    return fmt::format("M{0}A{2} {2} 0 1 0 {1}A{2} {2} 0 1 0 {0}Z", point_text({c[0] - r, c[1]}), point_text({c[0] + r, c[1]}),
                       number_text(r));
  }
  const Flat w{(b[0] - a[0]) / length, (b[1] - a[1]) / length};
  const double along = (ra - rb) / length, across = std::sqrt((1 - along) * (1 + along));
  const auto touch = [&](const Flat& c, double r, double side) {
    return point_text({c[0] + r * (along * w[0] - side * across * w[1]), c[1] + r * (along * w[1] + side * across * w[0])});
  };
  return fmt::format("M{}L{}A{} {} 0 {} 0 {}L{}A{} {} 0 {} 0 {}Z", touch(a, ra, 1), touch(b, rb, 1), number_text(rb),
                     number_text(rb), rb > ra ? 1 : 0, touch(b, rb, -1), touch(a, ra, -1), number_text(ra), number_text(ra),
                     ra > rb ? 1 : 0, touch(a, ra, 1));
}

// A run of a finger's joints, drawn as one shape.
struct FingerRun {
  int first = 0, last = 0;
  bool is_behind = false;  // the glass is in front of it
  double depth = 0;        // mm
};

// The bones of all fingers in runs that are on one side of the glass, the furthest first.
std::vector<FingerRun> finger_runs(const Drawing& drawing, const DrawnView& view) {
  std::vector<FingerRun> runs;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k + 1 < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const Triple &a = drawing.joints[j], &b = drawing.joints[j + 1];
      const Triple middle = midpoint(a, b);
      const bool is_behind = drawing.glass.covers(view, a, b);
      if (k > 0 && runs.back().is_behind == is_behind) {
        runs.back().last = j + 1;
        runs.back().depth = std::max(runs.back().depth, view.depth(middle));
      } else {
        runs.push_back({j, j + 1, is_behind, view.depth(middle)});
      }
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const FingerRun& a, const FingerRun& b) { return a.depth < b.depth; });
  return runs;
}

// Shape shows the state as well as color does: a disc, a diamond, a small ring.
std::string marker(const Flat& p, PointState state, double font) {
  const double size = 0.42 * font;
  const char* name = POINT_STYLES[static_cast<std::size_t>(state)].name;
  if (state == PointState::projected) {
    return fmt::format("<path class=\"{}\" d=\"M{}L{}L{}L{}Z\"/>\n", name, point_text({p[0] - size, p[1]}),
                       point_text({p[0], p[1] - size}), point_text({p[0] + size, p[1]}), point_text({p[0], p[1] + size}));
  }
  return fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", name, number_text(p[0]), number_text(p[1]),
                     number_text(state == PointState::free ? 0.55 * size : 0.85 * size));
}

// All shapes with a line round them, then all again without: what is left is the line round the whole.
void draw_run(std::string& svg, const Drawing& drawing, const DrawnView& view, const FingerRun& run) {
  std::string shapes, bones;
  for (int j = run.first; j < run.last; ++j) {
    const Flat a = view.flat(drawing.joints[j]), b = view.flat(drawing.joints[j + 1]);
    shapes += bone_path(a, drawing.skin[j], b, drawing.skin[j + 1]);
    bones += fmt::format("{}{}", j == run.first ? "M" + point_text(a) + "L" : "L", point_text(b));
  }
  svg += fmt::format("<path class=\"skin\" d=\"{0}\"/>\n<path class=\"flesh\" d=\"{0}\"/>\n<path class=\"bone\" d=\"{1}\"/>\n",
                     shapes, bones);
  for (int j = run.first; j <= run.last; ++j)
    svg += marker(view.flat(drawing.joints[j]), point_state(drawing.report.answer.result, j), drawing.font);
}

// ---- words and measures ----

void draw_text(std::string& svg, const Flat& p, const char* style, const std::string& text) {
  svg += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>\n", style, number_text(p[0]), number_text(p[1]),
                     markup_escaped(text));
}

// A measure between two points with ticks across its ends, the words beside its middle.
void draw_measure(std::string& svg, const Drawing& drawing, const Flat& a, const Flat& b, const std::string& text) {
  const double tick = 0.35 * drawing.font;
  const bool is_level = a[1] == b[1];
  const double tx = is_level ? 0 : tick, ty = is_level ? tick : 0;
  draw_line(svg, a, b, "measure");
  for (const Flat& end : {a, b}) draw_line(svg, {end[0] - tx, end[1] - ty}, {end[0] + tx, end[1] + ty}, "measure");
  const Flat middle{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
  if (is_level) {
    draw_text(svg, {middle[0], middle[1] + 1.1 * drawing.font}, "mid", text);
  } else {
    draw_text(svg, {middle[0] + 0.5 * drawing.font, middle[1] + 0.35 * drawing.font}, "start", text);
  }
}

// Whether a run's shapes cover a place on the sheet.
bool covers(const Drawing& drawing, const DrawnView& view, const FingerRun& run, const Flat& p) {
  for (int j = run.first; j < run.last; ++j) {
    const Flat a = view.flat(drawing.joints[j]), b = view.flat(drawing.joints[j + 1]);
    const Flat along{b[0] - a[0], b[1] - a[1]}, to{p[0] - a[0], p[1] - a[1]};
    const double squared = along[0] * along[0] + along[1] * along[1];
    const double t = squared > 0 ? std::clamp((to[0] * along[0] + to[1] * along[1]) / squared, 0.0, 1.0) : 0;
    const double skin = drawing.skin[j] + t * (drawing.skin[j + 1] - drawing.skin[j]);
    if (std::hypot(to[0] - t * along[0], to[1] - t * along[1]) < skin) return true;
  }
  return false;
}

// Initials beyond the tips that are seen: of those that no nearer finger covers, and not on top of another's initial.
void draw_initials(std::string& svg, const Drawing& drawing, const DrawnView& view, const std::vector<FingerRun>& runs) {
  std::vector<Flat> taken;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    const int finger = finger_of(run->last);
    if (run->last != finger_start(finger) + finger_joints(finger) - 1) continue;  // not the run with the tip
    const Flat tip = view.flat(drawing.joints[run->last]), before = view.flat(drawing.joints[run->last - 1]);
    const double length = std::hypot(tip[0] - before[0], tip[1] - before[1]);
    const Flat along = length < 1 ? Flat{0, -1} : Flat{(tip[0] - before[0]) / length, (tip[1] - before[1]) / length};
    const double beyond = drawing.skin[run->last] + 0.7 * drawing.font;
    const Flat at{tip[0] + beyond * along[0], tip[1] + beyond * along[1]};
    const bool is_hidden = std::any_of(runs.rbegin(), run, [&](const FingerRun& nearer) {
      return covers(drawing, view, nearer, tip) || covers(drawing, view, nearer, at);
    });
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const Flat& other) {
      return std::hypot(at[0] - other[0], at[1] - other[1]) < drawing.font;
    });
    if (is_hidden || is_taken) continue;
    draw_text(svg, {at[0], at[1] + 0.35 * drawing.font}, "initial", std::string(1, INITIALS[finger]));
    taken.push_back(at);
  }
}

void draw_view(std::string& svg, const Drawing& drawing, const DrawnView& view, const Flat& title) {
  svg += fmt::format("<g id=\"{}\">\n", view.name);
  const std::vector<FingerRun> runs = finger_runs(drawing, view);
  for (const FingerRun& run : runs) {
    if (run.is_behind) draw_run(svg, drawing, view, run);
  }
  drawing.glass.draw(svg, view);
  for (const FingerRun& run : runs) {
    if (!run.is_behind) draw_run(svg, drawing, view, run);
  }
  const Flat thumb = view.flat(drawing.joints[THUMB_TIP]), index = view.flat(drawing.joints[INDEX_TIP]);
  draw_line(svg, thumb, index, "axis");
  drawing.forces.draw(svg, view, drawing.unit);
  draw_initials(svg, drawing, view, runs);
  draw_text(svg, title, "head", view.name);
  svg += "</g>\n";
}

std::vector<std::string> caption_lines(const GripReport& report) {
  const GripInput& g = report.grip;
  const GripResult& r = report.answer.result;
  std::vector<std::string> lines{
      report.vessel,
      fmt::format("height {:.1f} mm, roll {:.1f}\u00b0", g.height * 1e3, degrees(g.roll)),
      fmt::format("obliquity {:.1f}\u00b0, azimuth {:.1f}\u00b0", degrees(g.obliquity), degrees(g.azimuth)),
      fmt::format("gap {:.1f} mm, closure {:.2f}", r.gap * 1e3, r.closure),
      fmt::format("{}, {}", counted(static_cast<std::uint64_t>(std::popcount(r.used_mask)), "finger"),
                  counted(static_cast<std::uint64_t>(std::popcount(r.touch_mask)), "point touches", "points touch")),
      fmt::format("score {:.3f}{}", report.answer.score.score,
                  !r.plausible                   ? " (implausible)"
                  : report.answer.score.not_held ? " (not held)"
                                                 : ""),
  };
  if (g.offset != 0) lines[2] += fmt::format(", offset {:.1f} mm", g.offset * 1e3);
  return lines;
}

// What the drawing shows, in sentences for those who do not see it.
std::string spoken(const Drawing& drawing, double width, double height) {
  const GripResult& r = drawing.report.answer.result;
  std::string text = fmt::format(
      "Front, side and top view of a hand that holds {}, {:.0f} mm wide and {:.0f} mm high, between thumb and index finger {:.1f} "
      "mm "
      "above its base.",
      drawing.vessel, width, height, 1e3 * (drawing.report.grip.height - drawing.base));
  for (int f = 0; f < FINGER_COUNT; ++f) {
    int touching = 0;
    for (int k = 0; k < finger_joints(f); ++k) touching += r.touch_mask >> (finger_start(f) + k) & 1;
    text += fmt::format(" The {} touches with {} of its {} points.", f == 0 ? "thumb" : std::string(FINGER_NAMES[f]) + " finger",
                        touching, finger_joints(f));
  }
  if (!drawing.forces.empty()) text += " Arrows show the forces of the hand: " + drawing.forces.words() + ".";
  return text;
}

void draw_legend(std::string& svg, const Drawing& drawing, Flat at) {
  const double step = 1.45 * drawing.font;
  const auto lines = caption_lines(drawing.report);
  svg += "<g id=\"legend\">\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    at[1] += step;
    draw_text(svg, at, i == 0 ? "head" : "start", lines[i]);
  }
  at[1] += 0.5 * step;
  const std::array<const char*, 3> words{"touches where it was", "touches, brought to the glass", "does not touch"};
  for (int s = 0; s < 3; ++s) {
    at[1] += step;
    svg += marker({at[0] + 0.5 * drawing.font, at[1] - 0.35 * drawing.font}, static_cast<PointState>(s), drawing.font);
    draw_text(svg, {at[0] + 1.4 * drawing.font, at[1]}, "start", words[s]);
  }
  if (!drawing.forces.empty()) {
    at[1] += step;
    const Flat head = DrawnForces::draw_longest(svg, {at[0], at[1] - 0.35 * drawing.font}, drawing.unit);
    draw_text(svg, {head[0] + 0.6 * drawing.font, at[1]}, "start", "force on the vessel");
    at[1] += step;
    draw_text(svg, at, "start", drawing.forces.words());
  }
  at[1] += step;
  draw_text(svg, at, "start", "T thumb, I index, M middle, R ring, L little");
  at[1] += 1.3 * step;
  draw_measure(svg, drawing, at, {at[0] + 50, at[1]}, "50 mm");
  svg += "</g>\n";
}

std::string style_sheet(const Drawing& drawing) {
  const auto color = [](PointState state) { return color_text(POINT_STYLES[static_cast<std::size_t>(state)].color); };
  const double w = drawing.line;
  return fmt::format(
      "<style>\n"
      "text {{ font-family: Helvetica, Arial, sans-serif; font-size: {font:.2f}px; fill: #202020 }}\n"
      ".mid {{ text-anchor: middle }}\n.head {{ font-weight: bold }}\n"
      ".initial {{ text-anchor: middle; stroke: #ffffff; stroke-width: {halo:.2f}; paint-order: stroke; stroke-linejoin: round }}\n"
      "path, circle {{ stroke-linejoin: round; stroke-linecap: round }}\n"
      ".glass {{ fill: #eaf3f8; fill-opacity: 0.6; stroke: #202020; stroke-width: {thick:.3f} }}\n"
      ".body {{ fill: #eaf3f8; fill-opacity: 0.6; fill-rule: evenodd; stroke: none }}\n"
      ".contour {{ fill: none; stroke: #202020; stroke-width: {thick:.3f} }}\n"
      ".edge, .measure {{ fill: none; stroke: #404040; stroke-width: {thin:.3f} }}\n"
      ".inner {{ fill: none; stroke: #606060; stroke-width: {thin:.3f}; stroke-dasharray: {dash:.2f} {dash:.2f} }}\n"
      ".axis {{ fill: none; stroke: #404040; stroke-width: {thin:.3f}; stroke-dasharray: {long_dash:.2f} {dash:.2f} {thin:.2f} "
      "{dash:.2f} }}\n"
      ".skin {{ fill: none; stroke: #202020; stroke-width: {double_line:.3f} }}\n"
      ".flesh {{ fill: #ffffff; stroke: none }}\n"
      ".bone {{ fill: none; stroke: #909090; stroke-width: {line:.3f} }}\n"
      ".touching {{ fill: {touching}; stroke: #202020; stroke-width: {thin:.3f} }}\n"
      ".projected {{ fill: {projected}; stroke: #202020; stroke-width: {thin:.3f} }}\n"
      ".free {{ fill: {free}; stroke: #606060; stroke-width: {line:.3f} }}\n"
      "{forces}</style>\n",
      fmt::arg("font", drawing.font), fmt::arg("line", w), fmt::arg("thick", 1.4 * w), fmt::arg("thin", 0.6 * w),
      fmt::arg("halo", 4 * w), fmt::arg("dash", 3 * w), fmt::arg("long_dash", 10 * w), fmt::arg("double_line", 2.4 * w),
      fmt::arg("touching", color(PointState::touching)), fmt::arg("projected", color(PointState::projected)),
      fmt::arg("free", color(PointState::free)), fmt::arg("forces", drawing.forces.empty() ? "" : DrawnForces::style(w)));
}

Drawing make_drawing(const Scene& scene, std::size_t vessel, const GripReport& report) {
  const VesselData& data = scene.vessels[vessel];
  Drawing drawing{report, DrawnGlass(data), DrawnForces(report), data.name, data.base};
  const HandNodes hand = hand_nodes(scene.hand, report.grip, report.answer.result);
  for (int j = 0; j < JOINT_COUNT; ++j) {
    drawing.joints[j] = hand.joints[j].position;
    drawing.skin[j] = std::max(SMALLEST_SKIN, 1e3 * hand.joints[j].radius);
  }
  return drawing;
}

// How far the views reach, mm of the vessel: along the thumb-index line, away from the hand, up.
struct ViewExtents {
  std::array<double, 2> wide{}, deep{}, high{};
  double width() const { return wide[1] - wide[0]; }
  double depth() const { return deep[1] - deep[0]; }
  double height() const { return high[1] - high[0]; }
};

// Sets the scale by which the sheet fits on a page; in letters, margins, gaps and measures take 11 across and 10 down. Arrows have
// their length on paper, so the extents grow with the scale, and each step adds less than half of the last.
ViewExtents fit_page(Drawing& drawing, const std::array<Triple, 3>& axes, double legend_height) {
  ViewExtents extents;
  for (int step = 0; step < 60; ++step) {
    extents = {extent_along(drawing, axes[0]), extent_along(drawing, axes[1]), extent_along(drawing, axes[2])};
    const double width = extents.width(), depth = extents.depth(), height = extents.height(), before = drawing.unit;
    drawing.unit = std::max(
        {(width + depth) / (PAPER_WIDTH - 11 * PAPER_FONT), width / (PAPER_WIDTH - (5 + LEGEND_WIDTH) * PAPER_FONT),
         (depth + height) / (PAPER_HEIGHT - 10 * PAPER_FONT), height / (PAPER_HEIGHT - (10 + legend_height) * PAPER_FONT)});
    if (drawing.unit == before) break;
  }
  drawing.font = PAPER_FONT * drawing.unit;
  drawing.line = PAPER_LINE * drawing.unit;
  return extents;
}

}  // namespace

std::string grip_svg(const Scene& scene, std::size_t vessel, const GripReport& report) {
  check_drawable(report, "--svg");
  Drawing drawing = make_drawing(scene, vessel, report);
  // towards the hand, d x y for a right hand, and to its right
  const double side = scene.hand.handedness == Handedness::right ? 1 : -1;
  const Triple hand{side * std::sin(report.grip.azimuth), 0, side * std::cos(report.grip.azimuth)};
  const Triple across{hand[2], 0, -hand[0]}, away{-hand[0], 0, -hand[2]}, up{0, 1, 0};
  DrawnView front{"front", across, up, hand, {}, {}}, beside{"side", away, up, across, {}, {}},
      above{"top", across, away, up, {}, {}};

  const auto glass_wide = drawing.glass.extent_along(across), glass_high = drawing.glass.extent_along(up);
  const double legend_height = LEGEND_HEIGHT + (drawing.forces.empty() ? 0 : FORCES_HEIGHT);
  const ViewExtents extents = fit_page(drawing, {across, away, up}, legend_height);
  const double width = extents.width(), depth = extents.depth(), height = extents.height(), unit = drawing.unit, f = drawing.font;
  const double left = 2 * f, top_row = 3 * f, right_column = left + width + 3 * f;
  const double first_row = std::max(depth, legend_height * f), second_row = top_row + first_row + 3 * f;
  const double sheet_width = right_column + std::max(depth + 6 * f, LEGEND_WIDTH * f), sheet_height = second_row + height + 4 * f;
  above.origin = {left - extents.wide[0], top_row + (first_row - depth) + extents.deep[1]};
  front.origin = {left - extents.wide[0], second_row + extents.high[1]};
  beside.origin = {right_column - extents.deep[0], second_row + extents.high[1]};

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.1f}mm\" height=\"{:.1f}mm\" viewBox=\"0 0 {:.2f} {:.2f}\" role=\"img\" "
      "aria-labelledby=\"title desc\">\n<title id=\"title\">{}</title>\n<desc id=\"desc\">{}</desc>\n",
      sheet_width / unit, sheet_height / unit, sheet_width, sheet_height, markup_escaped("Grip of " + drawing.vessel),
      markup_escaped(spoken(drawing, glass_wide[1] - glass_wide[0], glass_high[1] - glass_high[0])));
  svg += style_sheet(drawing);
  svg += fmt::format("<rect width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#ffffff\"/>\n", sheet_width, sheet_height);
  for (DrawnView* view : {&above, &front, &beside}) drawing.glass.look(*view, PAPER_DETAIL * unit);
  draw_view(svg, drawing, above, {left, top_row - f});
  draw_view(svg, drawing, front, {left, second_row - f});
  draw_view(svg, drawing, beside, {right_column, second_row - f});
  const double under = second_row + height + f, right = right_column + depth + 0.8 * f;
  draw_measure(svg, drawing, {front.origin[0] + glass_wide[0], under}, {front.origin[0] + glass_wide[1], under},
               fmt::format("{:.0f} mm", glass_wide[1] - glass_wide[0]));
  draw_measure(svg, drawing, {right, beside.origin[1] - glass_high[0]}, {right, beside.origin[1] - glass_high[1]},
               fmt::format("{:.0f} mm", glass_high[1] - glass_high[0]));
  draw_legend(svg, drawing, {right_column, top_row - 1.8 * f});
  return svg + "</svg>\n";
}

}  // namespace wholehand::sweeps
