// SPDX-License-Identifier: MIT
#include "sweeps/grips/glass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/liquid.h"
#include "core/load.h"
#include "core/vectors.h"

namespace wholehand::sweeps {
namespace {

constexpr double CORNER_COSINE = 0.985;  // 10 degrees: sharper edges of the glass are drawn across it
constexpr int BONE_SAMPLES = 5;          // along a bone, of what covers it

// One half of an outline as path commands after its first point; `side` -1 mirrors it. Backwards where asked.
std::string half_outline(const DrawnView& view, const std::vector<PreparedElement>& elements, double side, bool backwards) {
  std::string path;
  const std::array<double, 2>* last = nullptr;
  const auto drawn = [&](const std::array<double, 2>& p) {
    return point_text({view.origin[0] + side * 1e3 * p[0], view.origin[1] - 1e3 * p[1]});
  };
  const auto to = [&](const PreparedElement& e) {
    const auto &start = backwards ? e.b : e.a, &end = backwards ? e.a : e.b;
    // level elements of a cavity are left out: the next one begins elsewhere
    if (last && std::hypot(start[0] - (*last)[0], start[1] - (*last)[1]) > 1e-9) path += "L" + drawn(start);
    last = &end;
    const bool anticlockwise = (e.side > 0) == (e.b[1] > e.a[1]);  // in (r, y); mirrored and backwards it stays so
    path += e.side == 0 ? "L" + drawn(end)
                        : fmt::format("A{0} {0} 0 0 {1} {2}", number_text(1e3 * e.radius),
                                      anticlockwise == (backwards == (side < 0)) ? 0 : 1, drawn(end));
  };
  if (backwards) {
    std::for_each(elements.rbegin(), elements.rend(), to);
  } else {
    std::for_each(elements.begin(), elements.end(), to);
  }
  return path;
}

// Direction of an element at its end or start, in (r, y).
Flat tangent_of(const PreparedElement& e, bool at_end) {
  const auto& p = at_end ? e.b : e.a;
  Flat t{e.b[0] - e.a[0], e.b[1] - e.a[1]};
  if (e.side != 0) {
    const double sense = (e.side > 0) == (e.b[1] > e.a[1]) ? 1 : -1;
    t = {-sense * (p[1] - e.center[1]), sense * (p[0] - e.center[0])};
  }
  const double length = std::hypot(t[0], t[1]);
  return {t[0] / length, t[1] / length};
}

// Largest radius of an element above a height, m; 0 where it does not reach there.
double widest_above(const PreparedElement& e, double height) {
  const double low = std::max(height, std::min(e.a[1], e.b[1])), high = std::max(e.a[1], e.b[1]);
  if (high <= height) return 0;
  if (e.a[1] == e.b[1]) return std::max(e.a[0], e.b[0]);
  if (e.side > 0 && e.center[1] > low && e.center[1] < high) return e.center[0] + e.radius;
  const core_f64::Element element = core_f64::load_element(e);
  return std::max(core_f64::element_radius(element, low), core_f64::element_radius(element, high));
}

// Lines of a view, m to the right and up, as path commands.
std::string lines_path(const DrawnView& view, const std::vector<std::vector<Flat>>& lines, const char* end) {
  std::string path;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Flat p{view.origin[0] + 1e3 * line[i][0], view.origin[1] - 1e3 * line[i][1]};
      path += (i == 0 ? "M" : i == 1 ? "L" : " ") + point_text(p);
    }
    path += end;
  }
  return path;
}

void draw_path(std::string& svg, const char* style, const std::string& path) {
  if (!path.empty()) svg += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, path);
}

void draw_circle(std::string& svg, const DrawnView& view, double radius, const char* style) {
  svg += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", style, number_text(view.origin[0]),
                     number_text(view.origin[1]), number_text(1e3 * radius));
}

}  // namespace

DrawnGlass::DrawnGlass(const VesselData& vessel) : prepared_(prepare_vessel(vessel, vessel.has_cavity())) {
  if (!vessel.mesh) return;
  body_ = vessel.mesh->body;
  edges_ = find_edges(*body_);
}

std::array<double, 2> DrawnGlass::extent_along(const Triple& axis) const {
  if (!body_) {
    const double radius = 1e3 * prepared_.largest_radius;
    return axis[1] != 0 ? std::array{0.0, 1e3 * prepared_.mouth_height} : std::array{-radius, radius};
  }
  std::array<double, 2> extent{HUGE_VAL, -HUGE_VAL};
  for (const Triple& p : body_->vertices) {
    const double at = 1e3 * dot(axis, p);
    extent = {std::min(extent[0], at), std::max(extent[1], at)};
  }
  return extent;
}

void DrawnGlass::look(DrawnView& view, double pixel) const {
  if (body_) view.mesh = std::make_shared<MeshView>(*body_, edges_, view.right, view.up, view.toward, 1e-3 * pixel);
}

// More of its samples behind the mesh than in front of it.
bool DrawnGlass::mesh_covers(const DrawnView& view, const Triple& a, const Triple& b) const {
  int behind = 0;
  double depth = 0;
  for (int k = 0; k < BONE_SAMPLES; ++k) {
    const double t = (k + 0.5) / BONE_SAMPLES;
    const Triple p = point_between(a, b, t);
    const double cover = view.mesh->cover_at(p);
    if (cover != DepthMap::NOTHING) behind += cover > 0 ? 1 : -1;
    depth += view.depth(p) / BONE_SAMPLES;
  }
  if (behind != 0 || !view.is_level()) return behind > 0;
  const std::array<double, 2> extent = extent_along(view.toward);
  return depth < 0.5 * (extent[0] + extent[1]);
}

bool DrawnGlass::covers(const DrawnView& view, const Triple& a, const Triple& b) const {
  if (body_) return mesh_covers(view, a, b);
  const Triple p = midpoint(a, b);
  if (view.is_level()) return view.depth(p) < 0;
  return std::any_of(prepared_.hull.begin(), prepared_.hull.end(),
                     [&](const PreparedElement& e) { return widest_above(e, p[1]) > std::hypot(p[0], p[2]); });
}

void DrawnGlass::draw_upright(std::string& svg, const DrawnView& view) const {
  const auto& hull = prepared_.hull;
  svg += fmt::format("<path class=\"glass\" d=\"M{}{}{}Z\"/>\n", point_text(view.origin), half_outline(view, hull, 1, false),
                     half_outline(view, hull, -1, true));
  for (std::size_t i = 0; i + 2 < hull.size(); ++i) {
    const Flat before = tangent_of(hull[i], true), after = tangent_of(hull[i + 1], false);
    if (before[0] * after[0] + before[1] * after[1] > CORNER_COSINE || hull[i].b[1] < 1e-6) continue;
    const double r = 1e3 * hull[i].b[0], y = view.origin[1] - 1e3 * hull[i].b[1];
    draw_line(svg, {view.origin[0] - r, y}, {view.origin[0] + r, y}, "edge");
  }
}

void DrawnGlass::draw_from_above(std::string& svg, const DrawnView& view) const {
  draw_circle(svg, view, prepared_.largest_radius, "glass");
  const double mouth = prepared_.hull.back().a[0];
  if (mouth < prepared_.largest_radius - 1e-6) draw_circle(svg, view, mouth, "edge");
}

void DrawnGlass::draw_mesh(std::string& svg, const DrawnView& view) const {
  const MeshLines lines = view.mesh->lines();
  draw_path(svg, "body", lines_path(view, lines.covered, "Z"));
  draw_path(svg, "edge", lines_path(view, lines.creases, ""));
  draw_path(svg, "contour", lines_path(view, lines.contours, ""));
}

void DrawnGlass::draw_cavity(std::string& svg, const DrawnView& view) const {
  if (!view.is_level()) {
    draw_circle(svg, view, prepared_.mouth_radius, "inner");
    return;
  }
  for (const double side : {-1.0, 1.0}) {
    const auto& floor = prepared_.cavity.front().a;
    const Flat middle{view.origin[0], view.origin[1] - 1e3 * floor[1]};
    svg +=
        fmt::format("<path class=\"inner\" d=\"M{}L{}{}\"/>\n", point_text(middle),
                    point_text({middle[0] + side * 1e3 * floor[0], middle[1]}), half_outline(view, prepared_.cavity, side, false));
  }
}

void DrawnGlass::draw(std::string& svg, const DrawnView& view) const {
  if (body_) {
    draw_mesh(svg, view);
  } else if (view.is_level()) {
    draw_upright(svg, view);
  } else {
    draw_from_above(svg, view);
  }
  if (!prepared_.cavity.empty()) draw_cavity(svg, view);
}

}  // namespace wholehand::sweeps
