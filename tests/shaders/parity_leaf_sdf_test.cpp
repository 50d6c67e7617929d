// SPDX-License-Identifier: MIT
// Leaf functions of sdf.glsl that work on one element of an outline or on one cell of a lattice, and those of contact.glsl, against
// the core's (tests/support/leaf_parity.h). What is made of them is in parity_leaf_test.cpp.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/prepare.h"
#include "shaders/layout.h"
#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// Share of undecided inputs among those that are not on a boundary on purpose.
constexpr double ONE_IN_A_THOUSAND = 1e-3;

// ---- one element ----

// On a lattice of 1/512 m with elements on every second of its points, whose circles have the radius 5 / 256 m and ends on 3-4-5
// triangles, no coordinate has more than 6 bits: sums, products and squares are exact, in float and fused or not. Every decision
// that takes no root is the same or wrong: horizontal elements, the ends' heights, the ends, the surface itself, the half's edge,
// the center.
constexpr double UNIT = 1.0 / 256;
constexpr int SIDE_UNITS = 16;
constexpr double CENTER = 8 * UNIT;

PreparedElement line(double ar, double ay, double br, double by) {
  PreparedElement element;
  element.a = {ar * UNIT, ay * UNIT};
  element.b = {br * UNIT, by * UNIT};
  const double length = std::hypot(br - ar, by - ay);
  element.center = {(by - ay) / length, (ar - br) / length};
  return element;
}

PreparedElement arc(double ar, double ay, double br, double by, int side) {
  PreparedElement element;
  element.a = {CENTER + ar * UNIT, CENTER + ay * UNIT};
  element.b = {CENTER + br * UNIT, CENTER + by * UNIT};
  element.center = {CENTER, CENTER};
  element.radius = 5 * UNIT;
  element.side = side;
  return element;
}

std::vector<PreparedElement> plain_elements() {
  std::vector<PreparedElement> elements{line(0, 2, 8, 2),  line(8, 12, 0, 12), line(8, 2, 8, 12),
                                        line(4, 12, 4, 2), line(2, 1, 8, 9),   line(9, 10, 3, 2),
                                        line(10, 3, 7, 7), line(0, 3, 0, 9),   line(12, 6, 12, 6.5)};
  for (const int side : {1, -1}) {
    for (const auto& [ax, ay, bx, by] : {std::array{3, -4, 4, 3}, std::array{0, -5, 0, 5}, std::array{0, -5, 5, 0},
                                         std::array{5, 0, 0, 5}, std::array{4, 3, 3, 4}}) {
      elements.push_back(arc(side * ax, ay, side * bx, by, side));
      elements.push_back(arc(side * bx, by, side * ax, ay, side));
    }
  }
  for (std::size_t i = 0; i < elements.size(); ++i) elements[i].supports = static_cast<int>(i % 8);
  return elements;
}

// Whether q lies on the ray from an arc's center through one of its ends: whether it is within the sector then hinges on a root,
// which Vulkan gives to some units. At the center there is nothing to round.
bool on_edge_of_sector(const double* given) {
  const int code = static_cast<int>(given[7]), side = SIDE_OF(code);
  const double x = given[8] - given[4], y = given[9] - given[5], square = x * x + y * y;
  if (side == 0 || side * x < 0 || square == 0) return false;
  const auto same = [&](double end) { return y * std::abs(y) * given[6] * given[6] == end * std::abs(end) * square; };
  return same(given[1] - given[5]) || same(given[3] - given[5]);
}

Leaf element_leaf(double scale) {
  return {.shader = "probe_sdf",
          .probe = PROBE_ELEMENT,
          .inputs = 11,
          .outputs = together(
              std::vector<Output>{
                  {"distance", scale}, {"crosses", 1, true}, {"spans", 1, true}, {"convex", 1, true}, {"supports", 1, true}},
              repeated("outward", 2, scale)),
          .undecided = ONE_IN_A_THOUSAND,
          .fixed = {7, 10}};
}

TEST_F(ParityLeaf, ElementByExactArithmetic) {
  Builder build(200);
  for (const PreparedElement& element : plain_elements()) {
    for (int i = 0; i <= 2 * SIDE_UNITS; ++i) {
      for (int k = 0; k <= 2 * SIDE_UNITS; ++k) {
        const std::array<double, 2> q{i * UNIT / 2, k * UNIT / 2};
        Builder row(0);
        row.element(element).add(q[0]).add(q[1]).add((i + k) % 2 == 0 ? 1 : -1);
        // points whose answer hinges on a root: only the ends, few enough for the bound, however the device rounds
        if (on_edge_of_sector(row.table.data()) && q != element.a && q != element.b) continue;
        build.table.insert(build.table.end(), row.table.begin(), row.table.end());
      }
    }
  }
  // the normal is given or one exact difference
  Leaf leaf = element_leaf(2 * SIDE_UNITS * UNIT);
  for (std::size_t k = 5; k < 7; ++k) leaf.outputs[k].discrete = true;
  leaf.exact = true;
  leaf.hinges = on_edge_of_sector;
  compare(leaf, build.table, three_beakers());
}

// A place on an element: the share of its height or, where it has none, of its length.
std::array<double, 2> on_element(const PreparedElement& e, double share) {
  const double y = e.a[1] + share * (e.b[1] - e.a[1]);
  if (e.side == 0) return {e.a[0] + share * (e.b[0] - e.a[0]), y};
  const double rise = y - e.center[1];
  return {e.center[0] + e.side * std::sqrt(std::max(0.0, (e.radius - rise) * (e.radius + rise))), y};
}

// Elements of vessels, from points anywhere, close to either side of them, close to their ends, on a level with an end.
TEST_F(ParityLeaf, ElementOfVessels) {
  const Scene scene = vessels_scene();
  for (const VesselData& vessel : {vase(), ledges(), shell_of(beaker2())}) {
    Builder build(210);
    for (const PreparedElement& element : prepare_vessel(vessel, vessel.wall > 0).outline) {
      const auto add = [&](const std::array<double, 2>& q) {
        build.element(element).add(std::abs(q[0])).add(q[1]).add(build.random.uniform(-1, 1) < 0 ? -1 : 1);
      };
      for (int i = 0; i < 101; ++i) add({build.random.uniform(0, 0.07), build.random.uniform(-0.03, 0.17)});
      for (const double off : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        for (int i = 0; i < 12; ++i) {
          const auto [r, y] = on_element(element, build.random.uniform(-0.05, 1.05));
          add({r + build.random.uniform(-off, off), y + build.random.uniform(-off, off)});
          const std::array<double, 2>& end = i % 2 == 0 ? element.a : element.b;
          add({end[0] + build.random.uniform(-off, off), end[1] + build.random.uniform(-off, off)});
        }
      }
      for (const auto& end : {element.a, element.b})
        for (int i = 0; i < 4; ++i) add({build.random.uniform(0, 0.07), end[1]});
    }
    compare(element_leaf(0.15), build.table, scene);
  }
}

// ---- proxies ----

// From outside too, and from the surface itself, where contact_at does not ask.
TEST_F(ParityLeaf, Proxy) {
  const Scene scene = vessels_scene();
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    const double radius = largest_radius(vessel);
    const auto outline = prepare_vessel(vessel, vessel.wall > 0).outline;
    Builder build(220 + v);
    const auto turned = [&](const std::array<double, 2>& q) {
      const double angle = build.random.uniform(-PI, PI);
      build.add(q[0] * std::cos(angle)).add(q[1]).add(q[0] * std::sin(angle));
    };
    for (int i = 0; i < 999; ++i) {
      turned({build.random.uniform(0, 1.5 * radius), build.random.uniform(-0.2, 1.2) * vessel.height});
      build.uniform(5e-3, 9e-3);
    }
    for (const PreparedElement& element : outline) {
      for (int i = 0; i < 21; ++i) {
        const auto [r, y] = on_element(element, build.random.uniform(0.01, 0.99));
        turned({r + (i % 3 - 1) * 1e-4, y});
        build.add(i % 2 == 0 ? 0 : 7e-3);
      }
    }
    compare({.shader = "probe_sdf",
             .probe = PROBE_PROXY,
             .inputs = 4,
             .outputs = together(repeated("proxy", 3, REACH), std::vector<Output>{{"settled", 1, true}}),
             .stopped = {3},
             .undecided = ONE_IN_A_THOUSAND},
            build.table, scene, v);
  }
}

// On the axis of a cylinder and at the center of a flask's arc, where the gradient is +x because nothing else tells. One step then
// lands on the surface to a few roundings, far within where it stops, so nothing is moved.
TEST_F(ParityLeaf, ProxyOnTheAxis) {
  const Scene scene = three_beakers();
  for (const std::size_t v : {0, 1}) {
    Builder build(230);
    for (const double radius : {0.0, 5e-3, 8e-3}) {
      if (v == 0)
        for (int i = 0; i < 16; ++i) build.add(0).add((i / 16.0 + 1.0 / 64) * scene.vessels[v].height).add(0).add(radius);
      if (v == 1) build.add(0).add(scene.vessels[v].outline[0].center[1]).add(0).add(radius);
    }
    compare({.shader = "probe_sdf",
             .probe = PROBE_PROXY,
             .inputs = 4,
             .outputs = together(repeated("proxy", 3, REACH), std::vector<Output>{{"settled", 1, true}}),
             .exact = true},
            build.table, scene, v);
  }
}

// ---- the lattice ----

TEST_F(ParityLeaf, Lattice) {
  const Scene scene = vessels_scene();
  const Way way{OUTLINE_COPIED, 40};
  const auto core = make_core_evaluator(scene, {.lattice_samples = way.lattice_samples});
  const core_f64::Lattice lattice = core_f64::load_lattice(*core->lattice(VASE));
  const std::array<int, 3> counts{lattice.nx, lattice.ny, lattice.nz};
  const auto place = [&](int axis, double at) { return lattice.origin[axis] + lattice.spacing * at; };
  Builder points(240), samples(241), mixed(242), beyond(243);
  for (int i = 0; i < 1500; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double last = counts[axis] - 1;
      points.add(place(axis, points.random.uniform(-0.2, 1.2) * last));
      samples.add(std::floor(samples.random.uniform(0, 1) * counts[axis]));
    }
    beyond.uniform(-0.1 * REACH, REACH);
    for (int axis = 0; axis < 3; ++axis) beyond.add(beyond.random.uniform(0, 1) < 0.4 ? 0 : beyond.random.uniform(-REACH, REACH));
    mixed.uniform(-REACH, REACH).uniform(-REACH, REACH).add(i % 9 == 0 ? 0 : i % 9 == 1 ? 1 : mixed.random.uniform(0, 1));
  }
  // the box's corners and beyond each of its faces; a thousandth of a cell to either side of a sample
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const double last = (corner >> axis & 1) * (counts[axis] - 1);
      points.add(place(axis, last));
      samples.add(last);
    }
  }
  for (int i = 0; i < 300; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double node = std::floor(points.random.uniform(0, 1) * counts[axis]);
      points.add(place(axis, node + (points.random.uniform(-1, 1) < 0 ? -1e-3 : 1e-3)));
    }
  }
  std::vector<Output> cell = together(repeated("cell", 3, 1), repeated("fraction", 3, 40), repeated("outside", 3, REACH));
  for (std::size_t k = 0; k < 3; ++k) cell[k].discrete = true;
  compare({.shader = "probe_sdf", .probe = PROBE_LOCATE_CELL, .inputs = 3, .outputs = cell, .undecided = ONE_IN_A_THOUSAND},
          points.table, scene, VASE, way);
  // both twins read the same stored bits, so a sample is the same number or wrong
  for (const int bits : {32, 16}) {
    compare({.shader = "probe_sdf",
             .probe = PROBE_LATTICE_SAMPLE,
             .inputs = 3,
             .outputs = {{"sample", REACH, true}},
             .fixed = {0, 1, 2},
             .exact = true},
            samples.table, scene, VASE, {way.source, way.lattice_samples, bits});
  }
  compare({"probe_sdf", PROBE_DISTANCE_BEYOND, 4, {{"distance", 2 * REACH}}}, beyond.table, scene);
  compare({"probe_sdf", PROBE_MIX_REALS, 3, {{"mixed", 2 * REACH}}}, mixed.table, scene);
}

}  // namespace
}  // namespace wholehand
