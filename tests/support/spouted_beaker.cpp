// SPDX-License-Identifier: MIT
#include "tests/support/spouted_beaker.h"

#include <cmath>
#include <limits>

#include "core/scene.h"

namespace wholehand {
namespace spout {  // its short names are taken elsewhere
namespace {

constexpr double OUTSIDE = 35e-3, INSIDE = 33e-3, BEAKER_FLOOR = 3e-3, BEAKER_TOP = 100e-3;
constexpr double SPOUT_START = 80e-3;        // the height from which the wall is pulled
constexpr double SPOUT_HALF_ANGLE = PI / 6;  // of the sector that is pulled
constexpr double PULL = 8e-3, DROP = 4e-3;   // of the lip's middle: outward, and down
constexpr int BEAKER_SIDES = 192;
constexpr double ROW = 1e-3;      // between rows, where the wall is pulled
constexpr int ANGLE_STEPS = 400;  // of the sums, over half the spout; Simpson's rule
constexpr int HEIGHT_STEPS = 200;

double lateral_share(double angle) {
  const double from_middle = std::remainder(angle, 2 * PI);
  if (std::abs(from_middle) >= SPOUT_HALF_ANGLE) return 0;
  const double c = std::cos(PI / 2 * from_middle / SPOUT_HALF_ANGLE);
  return c * c;
}

double vertical_share(double y) {
  const double s = (y - SPOUT_START) / (BEAKER_TOP - SPOUT_START);
  return s <= 0 ? 0 : s * s * (3 - 2 * s);
}

double pull_at(double y, double lateral) { return PULL * lateral * vertical_share(y); }
double lowered(double y, double lateral) { return y - DROP * lateral * vertical_share(y); }

// The height, before the pull, of the point that comes to be at height y. Pulled heights rise with unpulled ones.
double unpulled(double y, double lateral) {
  double low = y, high = BEAKER_TOP;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (lowered(middle, lateral) < y ? low : high) = middle;
  }
  return (low + high) / 2;
}

template <class Function>
double simpson(double from, double to, int steps, const Function& f) {
  double sum = f(from) + f(to);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(from + (to - from) * i / steps);
  return sum * (to - from) / (3 * steps);
}

// The cavity's area at a height up to the brim.
double area(double y) {
  const double spout = simpson(0, SPOUT_HALF_ANGLE, ANGLE_STEPS, [&](double angle) {
    const double lateral = lateral_share(angle), r = INSIDE + pull_at(unpulled(y, lateral), lateral);
    return r * r;  // half of it over each half of the spout
  });
  return (PI - SPOUT_HALF_ANGLE) * INSIDE * INSIDE + spout;
}

// The volume of the glass: unpulled points (r, y) at an angle move to (r + pull, y - drop), which changes volumes by (r + pull) / r * d(lowered)/dy.
double glass() {
  const double spout = simpson(0, SPOUT_HALF_ANGLE, ANGLE_STEPS, [&](double angle) {
    const double lateral = lateral_share(angle);
    return simpson(SPOUT_START, BEAKER_TOP, HEIGHT_STEPS, [&](double y) {
      const double s = (y - SPOUT_START) / (BEAKER_TOP - SPOUT_START);
      const double stretch = 1 - DROP * lateral * 6 * s * (1 - s) / (BEAKER_TOP - SPOUT_START);
      const double pull = pull_at(y, lateral), outer = OUTSIDE + pull, inner = INSIDE + pull;
      return (outer * outer - inner * inner) * stretch;
    });
  });
  const double section = OUTSIDE * OUTSIDE - INSIDE * INSIDE;
  const double round = PI * OUTSIDE * OUTSIDE * BEAKER_FLOOR + PI * section * (SPOUT_START - BEAKER_FLOOR);
  return round + (PI - SPOUT_HALF_ANGLE) * section * (BEAKER_TOP - SPOUT_START) + spout;
}

}  // namespace
}  // namespace spout

VesselModel spouted_beaker(const std::string& name) {
  using namespace spout;
  const auto spouted = [](double r, double y, double angle) {
    const double lateral = lateral_share(angle), pull = r > 0 ? pull_at(y, lateral) : 0;
    return round_ring(r + pull, lowered(y, lateral), angle);
  };
  const auto wall = [](double r, double floor) {
    ProfilePoints points{{0, floor}, {r, floor}};
    for (const auto& point : divided({{r, SPOUT_START}, {r, BEAKER_TOP}}, ROW)) points.push_back(point);
    return points;
  };
  VesselModel model{.name = name, .is_round = false, .brim = BEAKER_TOP - DROP};
  model.mesh = walled_mesh(wall(OUTSIDE, 0), wall(INSIDE, BEAKER_FLOOR), BEAKER_SIDES, spouted, spouted);
  model.volume = glass();
  model.capacity = PI * INSIDE * INSIDE * (SPOUT_START - BEAKER_FLOOR) + simpson(SPOUT_START, model.brim, HEIGHT_STEPS, area);
  model.inner = {{0, BEAKER_FLOOR}, {INSIDE, BEAKER_FLOOR}};
  for (int i = 0; i <= HEIGHT_STEPS; ++i) {
    const double y = SPOUT_START + (model.brim - SPOUT_START) * i / HEIGHT_STEPS;
    model.inner.push_back({std::sqrt(area(y) / PI), y});
  }
  model.mesh_volume = model.mesh_capacity = std::numeric_limits<double>::quiet_NaN();  // facets of curved strips have no formula
  return model;
}

}  // namespace wholehand
