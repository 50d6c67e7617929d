// SPDX-License-Identifier: MIT
// Shapes of a few dimensions, as outlines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/text.h"
#include "core/reader/parts.h"

namespace wholehand {
namespace {

constexpr std::array<std::string_view, 5> DIMENSIONS{"diameter_mm", "height_mm", "neck_mm", "upright_mm", "shoulder_mm"};

// A shape's own dimensions: all of them, and none of another's.
void check_dimensions(const SceneTable& vessel, const std::string& shape, std::initializer_list<std::string_view> own) {
  for (const auto key : DIMENSIONS) {
    const bool is_own = std::find(own.begin(), own.end(), key) != own.end();
    if (is_own || !vessel.has(key)) continue;
    vessel.file().refuse(vessel.place(key), fmt::format("{} is not a dimension of a {}", key, shape),
                         fmt::format("allowed: {}", joined(own, ", ")));
  }
  for (const auto key : own) vessel.need(key, fmt::format("a {} with {}", shape, joined(own, ", ")));
}

OutlineElement line_to(double r, double y) {
  OutlineElement element;
  element.end = {r, y};
  return element;
}

// Refuses unless `less` < `more`, both SI and given under these keys.
void check_order(const SceneTable& vessel, const char* less_key, double less, const char* more_key, double more) {
  if (less < more) return;
  vessel.file().refuse(vessel.place(less_key), fmt::format("{} {}", less_key, found(*vessel.find(less_key))),
                       fmt::format("allowed: less than {} = {:.6g}", more_key, more * 1e3));
}

Silhouette cylinder(const SceneTable& vessel) {
  double diameter = 0, height = 0;
  vessel.need("diameter_mm", ranges::DIAMETER, diameter);
  vessel.need("height_mm", ranges::HEIGHT, height);
  const double r = diameter / 2;
  return {{line_to(r, 0), line_to(r, height), line_to(0, height)}, r, height};
}

// A sphere that stands on the base and reaches up to where it meets the neck.
Silhouette flask(const SceneTable& vessel) {
  double diameter = 0, neck = 0, height = 0;
  vessel.need("diameter_mm", ranges::DIAMETER, diameter);
  vessel.need("neck_mm", ranges::DIAMETER, neck);
  vessel.need("height_mm", ranges::HEIGHT, height);
  check_order(vessel, "neck_mm", neck, "diameter_mm", diameter);
  const double r = diameter / 2, neck_r = neck / 2;
  const double meets = r + std::sqrt((r - neck_r) * (r + neck_r));
  if (!(height > meets)) {
    vessel.file().refuse(vessel.place("height_mm"), fmt::format("height_mm {}", found(*vessel.find("height_mm"))),
                         fmt::format("allowed: more than {:.6g}, where the sphere meets the neck", meets * 1e3));
  }
  OutlineElement sphere;
  sphere.is_arc = true;
  sphere.end = {neck_r, meets};
  sphere.center = {0, r};
  return {{sphere, line_to(neck_r, height), line_to(0, height)}, r, height};
}

Silhouette conical(const SceneTable& vessel) {
  double diameter = 0, upright = 0, neck = 0, shoulder = 0, height = 0;
  vessel.need("diameter_mm", ranges::DIAMETER, diameter);
  vessel.need("upright_mm", ranges::UPRIGHT, upright);
  vessel.need("neck_mm", ranges::DIAMETER, neck);
  vessel.need("shoulder_mm", ranges::HEIGHT, shoulder);
  vessel.need("height_mm", ranges::HEIGHT, height);
  check_order(vessel, "neck_mm", neck, "diameter_mm", diameter);
  check_order(vessel, "upright_mm", upright, "shoulder_mm", shoulder);
  check_order(vessel, "shoulder_mm", shoulder, "height_mm", height);
  const double r = diameter / 2, neck_r = neck / 2;
  Silhouette silhouette{{line_to(r, 0)}, r, height};
  if (upright > 0) silhouette.elements.push_back(line_to(r, upright));
  for (const auto& element : {line_to(neck_r, shoulder), line_to(neck_r, height), line_to(0, height)}) {
    silhouette.elements.push_back(element);
  }
  return silhouette;
}

}  // namespace

Silhouette read_shape(const SceneTable& vessel, const std::string& shape) {
  Silhouette silhouette;
  if (shape == "cylinder") {
    check_dimensions(vessel, shape, {"diameter_mm", "height_mm"});
    silhouette = cylinder(vessel);
  } else if (shape == "flask") {
    check_dimensions(vessel, shape, {"diameter_mm", "neck_mm", "height_mm"});
    silhouette = flask(vessel);
  } else {
    check_dimensions(vessel, shape, {"diameter_mm", "upright_mm", "neck_mm", "shoulder_mm", "height_mm"});
    silhouette = conical(vessel);
  }
  const Place place = vessel.place("shape");
  for (OutlineElement& element : silhouette.elements) {
    element.line = place.line;
    element.column = place.column;
  }
  return silhouette;
}

}  // namespace wholehand
