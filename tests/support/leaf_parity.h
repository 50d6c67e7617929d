// SPDX-License-Identifier: MIT
// Leaf functions of the shaders beside the core's, on tables of inputs and in both precisions: the same inputs, rounded to that
// precision, through a probe shader and through the core compiled with it.
//
// Arithmetic that rounds is taken for exact arithmetic on inputs a few roundings away. So a number may differ by
//   2 x how far the core's double answer moves when each input moves by BACKWARD roundings (and one that stands for an early stop
// by
//   two stop tolerances), which is the conditioning at that very row, and
//   FORWARD roundings of the quantity's scale, for the operations behind it.
// A discrete answer may differ only where it differs between such neighbors too; such rows are counted and bounded.
// Where the inputs are such that the arithmetic up to a decision is exact, nothing is moved: the decision is the same or wrong.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shaders/layout.h"
#include "tests/support/leaf_facade.h"
#include "tests/support/leaf_probe.h"
#include "tests/support/scenes.h"

namespace wholehand {

// Rows in which a discrete answer differs between neighbors, of a table: as many as lie within roundings of a boundary by chance.
constexpr double UNDECIDED = 0.01;

constexpr double REACH = 0.3;  // m: scale of positions, hand and vessel together

struct Output {
  std::string name;
  double scale = 1;  // largest value that the sum behind it passes through
  bool discrete = false;
};

struct Leaf {
  std::string shader;
  int probe = 0;
  int inputs = 0;
  std::vector<Output> outputs;
  std::vector<int> stopped{};  // the inputs that an early stop of an iteration is as good as moving, by two stop tolerances
  double stop_scale = 1;       // .. times this, where such an input is no length
  double sharp_share = 0.9;    // of outputs whose tolerance is sharp (float)
  double undecided = UNDECIDED;
  std::vector<int> fixed{};                    // inputs that are whole numbers: not moved
  std::function<bool(const double*)> takes{};  // what the function takes: an input is not moved out of that
  // Decisions come from exact arithmetic on every row but those for which `hinges` holds.
  bool exact = false;
  std::function<bool(const double*)> hinges{};
  // What the tolerance of a row is larger by, at a precision's epsilon: where rounding is not as good as moved inputs.
  std::function<double(const double*, double)> more{};
};

std::vector<Output> repeated(const std::string& name, int count, double scale);

template <class... Lists>
std::vector<Output> together(const Lists&... lists) {
  std::vector<Output> outputs;
  (outputs.insert(outputs.end(), lists.begin(), lists.end()), ...);
  return outputs;
}

// How the vessel's distance is found.
struct Way {
  OutlineSource source = OUTLINE_COPIED;
  int lattice_samples = 0;
  int lattice_bits = 32;
};

using Table = std::vector<double>;

class ParityLeaf : public testing::Test {
 protected:
  static void SetUpTestSuite() { device = std::make_unique<host::Device>("vulkan"); }
  static void TearDownTestSuite() { device.reset(); }

  static std::vector<Precision> precisions();
  static Table rounded(Table table, Precision precision);
  static Table on_core(const Leaves& leaves, const Leaf& leaf, const Table& table);

  // The leaf on the device against the core's, for a vessel of the scene, in each precision that the device has.
  static void compare(const Leaf& leaf, const Table& exact_table, const Scene& scene, std::size_t vessel = 0, Way way = {});

  static inline std::unique_ptr<host::Device> device;

 private:
  static Table spread_of(const Leaves& leaves, const Leaf& leaf, const Table& table, const Table& truth, double epsilon,
                         double stop);
  static Table hinging_rows(const Leaf& leaf, const Table& table, const Table& b, const Table& truth);
  static void judge(const Leaf& leaf, const Table& table, const Table& a, const Table& b, const Table& spread, double epsilon,
                    const std::string& where);
};

// ---- tables; their sizes are no multiple of a work group ----

struct Builder {
  explicit Builder(std::uint64_t seed) : random(seed) {}
  Builder& add(double value) {
    table.push_back(value);
    return *this;
  }
  Builder& uniform(double low, double high) { return add(random.uniform(low, high)); }
  Builder& vec(const Triple& v) { return add(v[0]).add(v[1]).add(v[2]); }
  Builder& point(double size) { return uniform(-size, size).uniform(-size, size).uniform(-size, size); }
  Builder& element(const PreparedElement& e) {
    return add(e.a[0])
        .add(e.a[1])
        .add(e.b[0])
        .add(e.b[1])
        .add(e.center[0])
        .add(e.center[1])
        .add(e.radius)
        .add(ELEMENT_CODE(e.side, e.supports));
  }

  Triple direction();
  // A finger's plane: base near the hand, two unit vectors at right angles.
  Builder& frame() { return frame({random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.15), random.uniform(-0.1, 0.1)}); }
  Builder& frame(const Triple& base);

  Random random;
  Table table;
};

// The three beakers, the vase and a shell.
Scene vessels_scene();
constexpr std::size_t VASE = 3, SHELL = 4;

// Points about a vessel: outside and in, on the axis, close to the wall, far away, on an end of an element.
Table points_about(const VesselData& vessel, std::uint64_t seed);

}  // namespace wholehand
