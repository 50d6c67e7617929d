// SPDX-License-Identifier: MIT
#include "core/meshes/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/readable.h"
#include "base/text/text.h"

namespace wholehand {
namespace {

constexpr double LEAST_HELD = 0.02, MOST_HELD = 0.4;  // m: largest extent of what a hand holds
constexpr double WIDEST_GRASP = 0.15;                 // m: least extent of it, which the hand spans
constexpr double USUAL_SIZE = 0.15;                   // m: of a vessel
constexpr double HUGE_MESH = 10, TINY_MESH = 2e-3;    // m: held by no hand, in whatever unit
constexpr double ROUNDED = 1e-6;                      // of a number that was a float
constexpr double CLEARLY_LONGER = 1.15;
constexpr double FAR_SMALLER = 0.2;

constexpr std::array UNITS{LengthUnit{"meters", 1}, LengthUnit{"centimeters", 0.01}, LengthUnit{"millimeters", 0.001},
                           LengthUnit{"inches", 0.0254}};

double largest(const Triple& size) { return *std::max_element(size.begin(), size.end()); }
double smallest(const Triple& size) { return *std::min_element(size.begin(), size.end()); }

// Whether a hand can hold a body of numbers in that unit.
bool is_held(const Triple& numbers, double unit = 1) {
  const double size = unit * largest(numbers), least = unit * smallest(numbers);
  return size >= LEAST_HELD * (1 - ROUNDED) && size <= MOST_HELD * (1 + ROUNDED) && least <= WIDEST_GRASP * (1 + ROUNDED);
}

// By how many factors of e the largest extent is off the usual one.
double off_usual(const Triple& numbers, const LengthUnit& unit) {
  return std::abs(std::log(unit.meters * largest(numbers) / USUAL_SIZE));
}

std::string length_text(double length) { return length >= 1 ? plain_text(length, 4) + " m" : plain_text(1e3 * length, 4) + " mm"; }

// The key of a scene that turns a direction of the mesh up (docs/mesh.md, "Frames").
const char* key_that_raises(Side side) {
  switch (side) {
    case Side::front:
      return "up = \"z\"";
    case Side::back:
      return "rotate_deg = [90, 0, 0]";
    case Side::right:
      return "rotate_deg = [0, 0, 90]";
    case Side::left:
      return "rotate_deg = [0, 0, -90]";
    case Side::down:
      return "rotate_deg = [180, 0, 0]";
    case Side::up:
      break;
  }
  return "";
}

}  // namespace

const char* side_name(Side side) {
  constexpr std::array NAMES{"-x", "+x", "-y", "+y", "-z", "+z"};
  return NAMES[static_cast<std::size_t>(side)];
}

std::vector<LengthUnit> graspable_units(const Triple& numbers) {
  std::vector<LengthUnit> units;
  for (const LengthUnit& unit : UNITS)
    if (is_held(numbers, unit.meters)) units.push_back(unit);
  std::stable_sort(units.begin(), units.end(),
                   [&](const LengthUnit& a, const LengthUnit& b) { return off_usual(numbers, a) < off_usual(numbers, b); });
  return units;
}

LengthUnit nearest_unit(const Triple& numbers) {
  return *std::min_element(UNITS.begin(), UNITS.end(),
                           [&](const LengthUnit& a, const LengthUnit& b) { return off_usual(numbers, a) < off_usual(numbers, b); });
}

SizeHint mesh_size_hint(const Triple& size, double scale) {
  if (is_held(size)) return {};
  const Triple numbers{size[0] / scale, size[1] / scale, size[2] / scale};
  const double extent = largest(size);
  std::vector<std::string> likely;
  for (const LengthUnit& unit : graspable_units(numbers))
    likely.push_back(fmt::format("{:.6g} ({}: {})", unit.meters, unit.name, length_text(unit.meters * largest(numbers))));
  SizeHint hint;
  hint.is_other_unit = !likely.empty() || extent > HUGE_MESH || extent < TINY_MESH;
  hint.text = fmt::format("it is {} large, which a hand hardly holds: its numbers{} are taken as meters; ", length_text(extent),
                          scale == 1 ? "" : fmt::format(" times {:.6g}", scale));
  if (likely.empty()) {
    hint.text +=
        fmt::format("it would fit in no usual unit, and mesh_scale = {:.4g} to {:.4g} makes it fit", LEAST_HELD / largest(numbers),
                    std::min(MOST_HELD / largest(numbers), WIDEST_GRASP / smallest(numbers)));
  } else {
    hint.text += (likely.size() == 1 ? "the likely scale is mesh_scale = " : "the likely scale is one of mesh_scale = ") +
                 joined(likely, ", ");
  }
  return hint;
}

std::optional<Side> open_side(const TriangleMesh& mesh, const MeshFacts& facts) {
  constexpr Triple OFF_MIDDLE{0.50037, 0.50061, 0.50083};  // not on corners and edges of symmetric bodies
  Triple p{};
  for (int k = 0; k < 3; ++k) p[k] = facts.low[k] + OFF_MIDDLE[k] * (facts.high[k] - facts.low[k]);
  std::array<bool, 6> is_blocked{};
  for (const Corners& triangle : mesh.triangles)
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<double, 3> turn{};  // of each side about p, seen along the axis
      for (int k = 0; k < 3; ++k) {
        const Triple &a = mesh.vertices[triangle[(k + 1) % 3]], &b = mesh.vertices[triangle[(k + 2) % 3]];
        turn[k] = (a[u] - p[u]) * (b[v] - p[v]) - (a[v] - p[v]) * (b[u] - p[u]);
      }
      const auto [least, most] = std::minmax_element(turn.begin(), turn.end());
      if ((*least < 0 && *most > 0) || *least == *most) continue;  // beside it, or edge on
      double height = 0;
      for (int k = 0; k < 3; ++k) height += turn[k] * (mesh.vertices[triangle[k]][axis] - p[axis]);
      is_blocked[2 * axis + (height / (turn[0] + turn[1] + turn[2]) > 0 ? 1 : 0)] = true;
    }
  if (std::count(is_blocked.begin(), is_blocked.end(), false) != 1) return {};
  return static_cast<Side>(std::find(is_blocked.begin(), is_blocked.end(), false) - is_blocked.begin());
}

std::string posture_hint(const TriangleMesh& mesh, const MeshFacts& facts) {
  const std::optional<Side> open = open_side(mesh, facts);
  if (open) {
    if (*open == Side::up) return "";
    return fmt::format("its open side faces {}, and +y is up: if it lies on its side, {} stands it up", side_name(*open),
                       key_that_raises(*open));
  }
  const Triple size = facts.size();
  const int longest = size[2] > size[0] ? 2 : 0;
  const bool is_disc = std::max(size[0], size[2]) < CLEARLY_LONGER * std::min(size[0], size[2]);
  if (is_disc || size[longest] < CLEARLY_LONGER * size[1]) return "";
  return fmt::format("it is longest along {}, and y is up: if it lies on its side, {} stands it up", longest == 2 ? "z" : "x",
                     key_that_raises(longest == 2 ? Side::front : Side::right));
}

std::string inner_outline_hint(double height, double radius, double body_height, double reach) {
  if (height >= FAR_SMALLER * body_height || radius >= FAR_SMALLER * reach) return "";
  std::string hint =
      fmt::format("the inner outline is {:.3g} mm high and {:.3g} mm wide, far smaller than the mesh of {:.4g} and {:.4g} mm",
                  1e3 * height, 2e3 * radius, 1e3 * body_height, 2e3 * reach);
  for (const LengthUnit& unit : UNITS) {
    const double factor = unit.meters / 1e-3, share = factor * std::max(height / body_height, radius / reach);
    if (factor > 1 && share <= 1 && share > 0.5)
      hint += fmt::format("; it is read as millimeters, and its numbers look like {}: multiply them by {:.4g}", unit.name, factor);
  }
  return hint;
}

}  // namespace wholehand
