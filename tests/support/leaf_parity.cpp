// SPDX-License-Identifier: MIT
#include "tests/support/leaf_parity.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <sstream>

namespace wholehand {
namespace {

// A row's inputs count as known to so many roundings of the largest in their column: the longest leaf function rounds an input in a
// sum of that column's size no more than this often on its way through (a finger's tip: base, three segments, radius).
constexpr double BACKWARD = 4;
// Roundings of an output's scale. A finger's chain is the longest sum: three segments with an angle, its sine and cosine (2 units
// each, shaders/trig.glsl), two products and three sums each, at 1 unit; Vulkan's division and root add up to 3 units each.
constexpr double FORWARD = 32;
// A tolerance that lets anything pass tests nothing: in float, nine of ten stay under this share of their scale.
constexpr double SHARP = 1e-3;

double apart(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? HUGE_VAL : difference;
}

bool contains(const std::vector<int>& columns, int column) { return std::ranges::find(columns, column) != columns.end(); }

std::string failure(const Leaf& leaf, const Table& table, std::size_t row, std::size_t output, double a, double b, double tolerance,
                    const std::string& where) {
  std::ostringstream text;
  text.precision(17);
  text << leaf.shader << " " << leaf.probe << ", " << where << ", row " << row << ": " << leaf.outputs[output].name << " is " << a
       << " on the device, " << b << " on the core, apart " << apart(a, b) << ", tolerance " << tolerance << "; given";
  for (int k = 0; k < leaf.inputs; ++k) text << " " << table[row * leaf.inputs + k];
  return text.str();
}

}  // namespace

std::vector<Output> repeated(const std::string& name, int count, double scale) {
  std::vector<Output> outputs;
  for (int i = 0; i < count; ++i) outputs.push_back({name + std::to_string(i), scale});
  return outputs;
}

std::vector<Precision> ParityLeaf::precisions() {
  if (!device->info().float64) return {Precision::single};
  return {Precision::single, Precision::full};
}

Table ParityLeaf::rounded(Table table, Precision precision) {
  if (precision == Precision::single)
    for (double& value : table) value = static_cast<double>(static_cast<float>(value));
  return table;
}

Table ParityLeaf::on_core(const Leaves& leaves, const Leaf& leaf, const Table& table) {
  const std::size_t rows = table.size() / leaf.inputs;
  Table answers(rows * leaf.outputs.size());
  for (std::size_t i = 0; i < rows; ++i) leaves.evaluate(leaf.probe, &table[i * leaf.inputs], &answers[i * leaf.outputs.size()]);
  return answers;
}

// Largest change of the core's double answers when an input moves.
Table ParityLeaf::spread_of(const Leaves& leaves, const Leaf& leaf, const Table& table, const Table& truth, double epsilon,
                            double stop) {
  Table spread(truth.size(), 0.0);
  const std::size_t rows = table.size() / leaf.inputs;
  for (int column = 0; column < leaf.inputs; ++column) {
    if (contains(leaf.fixed, column)) continue;
    double largest = 0;
    for (std::size_t i = 0; i < rows; ++i) largest = std::max(largest, std::abs(table[i * leaf.inputs + column]));
    const double shift = BACKWARD * epsilon * largest + (contains(leaf.stopped, column) ? 2 * stop * leaf.stop_scale : 0);
    for (const double sign : {-1.0, 1.0}) {
      Table moved = table;
      for (std::size_t i = 0; i < rows; ++i) {
        double& value = moved[i * leaf.inputs + column];
        value += sign * shift;
        if (leaf.takes && !leaf.takes(&moved[i * leaf.inputs])) value = table[i * leaf.inputs + column];
      }
      const Table answers = on_core(leaves, leaf, moved);
      for (std::size_t k = 0; k < spread.size(); ++k) spread[k] = std::max(spread[k], apart(answers[k], truth[k]));
    }
  }
  return spread;
}

// In place of a spread where nothing moves: only a decision that hinges on rounding may differ. The others are the same in either
// precision.
Table ParityLeaf::hinging_rows(const Leaf& leaf, const Table& table, const Table& b, const Table& truth) {
  const std::size_t width = leaf.outputs.size();
  Table spread(truth.size(), 0.0);
  for (std::size_t at = 0; at < truth.size(); ++at) {
    if (!leaf.outputs[at % width].discrete) continue;
    const bool hinges = leaf.hinges && leaf.hinges(&table[at / width * leaf.inputs]);
    spread[at] = hinges ? 1 : 0;
    if (!hinges) {
      EXPECT_EQ(b[at], truth[at]) << leaf.outputs[at % width].name << " of row " << at / width << " is not decided exactly";
    }
  }
  return spread;
}

void ParityLeaf::compare(const Leaf& leaf, const Table& exact_table, const Scene& scene, std::size_t vessel, Way way) {
  for (const Precision precision : precisions()) {
    const bool single = precision == Precision::single;
    const Table table = rounded(exact_table, precision);
    const std::size_t rows = table.size() / leaf.inputs, width = leaf.outputs.size();
    const auto reference = make_double_leaves(scene, vessel, way.lattice_samples, way.lattice_bits);
    const auto leaves = single ? make_float_leaves(scene, vessel, way.lattice_samples, way.lattice_bits)
                               : make_double_leaves(scene, vessel, way.lattice_samples, way.lattice_bits);
    const LeafProbe probe(*device, scene, vessel, precision, way.source, way.lattice_samples, way.lattice_bits);
    const Table a = probe.run(leaf.shader, leaf.probe, table, rows, leaf.inputs, static_cast<int>(width));
    const Table b = on_core(*leaves, leaf, table);
    const double epsilon = single ? FLT_EPSILON : DBL_EPSILON;
    const Table truth = on_core(*reference, leaf, table);
    const double stop = single ? STOP_TOLERANCE_F32 : STOP_TOLERANCE_F64;
    const Table spread =
        leaf.exact ? hinging_rows(leaf, table, b, truth) : spread_of(*reference, leaf, table, truth, epsilon, stop);
    judge(leaf, table, a, b, spread, epsilon, std::string(single ? "float " : "double ") + scene.vessels[vessel].name);
  }
}

void ParityLeaf::judge(const Leaf& leaf, const Table& table, const Table& a, const Table& b, const Table& spread, double epsilon,
                       const std::string& where) {
  const std::size_t width = leaf.outputs.size(), rows = a.size() / width;
  std::size_t undecided = 0, sharp = 0, numbers = 0;
  double worst_ratio = 0, worst = 0;
  std::string worst_name;
  for (std::size_t i = 0; i < rows; ++i) {
    bool left_out = false;
    for (std::size_t k = 0; k < width; ++k) {
      const std::size_t at = i * width + k;
      if (!leaf.outputs[k].discrete || a[at] == b[at]) continue;
      EXPECT_NE(spread[at], 0) << failure(leaf, table, i, k, a[at], b[at], 0, where);
      left_out = true;
    }
    undecided += left_out ? 1 : 0;
    if (left_out) continue;
    const double more = leaf.more ? leaf.more(&table[i * leaf.inputs], epsilon) : 0;
    for (std::size_t k = 0; k < width; ++k) {
      if (leaf.outputs[k].discrete) continue;
      const std::size_t at = i * width + k;
      const double tolerance = FORWARD * epsilon * leaf.outputs[k].scale + 2 * spread[at] + more;
      const double ratio = apart(a[at], b[at]) / tolerance;
      ++numbers;
      sharp += tolerance <= SHARP * leaf.outputs[k].scale ? 1 : 0;
      if (ratio <= worst_ratio) continue;
      worst_ratio = ratio;
      worst = apart(a[at], b[at]);
      worst_name = leaf.outputs[k].name;
      EXPECT_LE(ratio, 1) << failure(leaf, table, i, k, a[at], b[at], tolerance, where);
    }
  }
  EXPECT_LE(static_cast<double>(undecided), std::max(1.0, leaf.undecided * static_cast<double>(rows))) << where;
  EXPECT_GE(static_cast<double>(sharp), leaf.sharp_share * static_cast<double>(numbers))
      << where << ": tolerances too wide to tell anything";
  std::ostringstream measured;
  measured << worst_name << " " << worst << " (" << worst_ratio << " of its tolerance), " << undecided << " of " << rows
           << " undecided, sharp " << static_cast<double>(sharp) / static_cast<double>(std::max<std::size_t>(numbers, 1));
  RecordProperty("worst_" + std::to_string(leaf.probe) + "_" + where, measured.str());
}

// ---- tables ----

Triple Builder::direction() {
  const double y = random.uniform(-1, 1), angle = random.uniform(-PI, PI), r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

Builder& Builder::frame(const Triple& base) {
  const Triple forward = direction();
  Triple across = direction();
  const double along = across[0] * forward[0] + across[1] * forward[1] + across[2] * forward[2];
  double size = 0;
  for (int k = 0; k < 3; ++k) {
    across[k] -= along * forward[k];
    size += across[k] * across[k];
  }
  for (double& value : across) value /= std::sqrt(size);
  return vec(base).vec(forward).vec(across);
}

Scene vessels_scene() {
  Scene scene = three_beakers();
  VesselData bent = vase();
  scene.vessels.push_back(bent);
  scene.vessels.push_back(shell_of(beaker2()));
  return scene;
}

Table points_about(const VesselData& vessel, std::uint64_t seed) {
  Builder build(seed);
  const double radius = largest_radius(vessel);
  for (int i = 0; i < 700; ++i)
    build.uniform(-1.6 * radius, 1.6 * radius)
        .uniform(-0.3 * vessel.height, 1.3 * vessel.height)
        .uniform(-1.6 * radius, 1.6 * radius);
  for (int i = 0; i < 61; ++i) build.add(0).uniform(-0.2 * vessel.height, 1.2 * vessel.height).add(0);
  for (int i = 0; i < 60; ++i) build.point(2);
  for (const OutlineElement& element : vessel.outline) {
    build.add(element.end[0]).add(element.end[1]).add(0);
    for (const double off : {-1e-4, -1e-7, 1e-7, 1e-4}) build.add(0).add(element.end[1]).add(element.end[0] + off);
  }
  return build.table;
}

}  // namespace wholehand
