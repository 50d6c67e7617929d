// SPDX-License-Identifier: MIT
// The inner offset of an outline as exact curves. At a height y every element blocks the radii within `wall` of it; the cavity reaches from the axis
// to the first blocked radius. That boundary consists of few kinds of curve (the circle about an element's end, the element's own offset on either
// side), each known in closed form, so only the heights where one replaces another must be searched.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/text/error.h"
#include "core/prepare.h"

namespace wholehand {
namespace {

// One boundary curve of the blocked radii.
struct Curve {
  int element = -1;
  int kind = 0;  // 0: circle about a, 1: circle about b, 2: offset to the left of a -> b, 3: offset to its right
  bool operator==(const Curve&) const = default;
};

struct Boundary {
  double radius = 0;
  Curve curve;
};

// The curve's lowest radius at y, if it has one there.
std::optional<double> curve_radius(const PreparedElement& element, int kind, double wall, double y) {
  if (kind < 2) {
    const auto& end = kind == 0 ? element.a : element.b;
    const double rise = y - end[1];
    if (std::abs(rise) > wall) return std::nullopt;
    return end[0] - std::sqrt((wall - rise) * (wall + rise));
  }
  if (element.side == 0) {
    const double dr = element.b[0] - element.a[0], dy = element.b[1] - element.a[1];
    if (dy == 0) return std::nullopt;  // its offsets are horizontal; the circles about its ends bound the radii
    const double length = std::hypot(dr, dy);
    const double turn = kind == 2 ? 1 : -1;
    const double shift_r = -turn * dy / length * wall, shift_y = turn * dr / length * wall;
    const double t = (y - element.a[1] - shift_y) / dy;
    if (t < 0 || t > 1) return std::nullopt;
    return element.a[0] + shift_r + t * dr;
  }
  const double radius = element.radius + (kind == 2 ? -wall : wall);
  const double rise = y - element.center[1];
  if (radius <= 0 || std::abs(rise) > radius) return std::nullopt;
  const double foot = rise * element.radius / radius + element.center[1];
  if (foot < std::min(element.a[1], element.b[1]) || foot > std::max(element.a[1], element.b[1])) return std::nullopt;
  return element.center[0] + element.side * std::sqrt((radius - rise) * (radius + rise));
}

// First blocked radius at y; nothing if no element reaches that height. Curves that touch (an offset and the circle that continues it) count as
// different only beyond rounding, the offset first, so that no sliver of the other appears at their joint.
constexpr double SAME_RADIUS = 1e-13;  // m

// Elements whose curves may be met at heights from low to high: none is further than the wall from its element.
std::vector<std::size_t> elements_near(const std::vector<PreparedElement>& open, double wall, double low, double high) {
  const double reach = wall * (1 + 1e-9) + 1e-12;
  std::vector<std::size_t> near;
  for (std::size_t e = 0; e < open.size(); ++e) {
    const auto [bottom, top] = std::minmax(open[e].a[1], open[e].b[1]);
    if (bottom - reach <= high && top + reach >= low) near.push_back(e);
  }
  return near;
}

std::optional<Boundary> first_blocked(const std::vector<PreparedElement>& open, const std::vector<std::size_t>& near, double wall,
                                      double y) {
  std::optional<Boundary> first;
  for (const std::size_t e : near) {
    for (const int kind : {2, 3, 0, 1}) {
      const auto radius = curve_radius(open[e], kind, wall, y);
      if (radius && (!first || *radius < first->radius - SAME_RADIUS)) first = Boundary{*radius, {static_cast<int>(e), kind}};
    }
  }
  return first;
}

// Heights at which some curve begins or ends.
std::vector<double> critical_heights(const std::vector<PreparedElement>& open, double wall, double floor, double mouth) {
  std::set<double> heights{floor, mouth};
  const auto add = [&](double y) {
    if (y > floor && y < mouth) heights.insert(y);
  };
  for (const auto& e : open) {
    for (const auto& end : {e.a, e.b}) {
      add(end[1] - wall);
      add(end[1] + wall);
      if (e.side == 0) {
        const double dr = e.b[0] - e.a[0], dy = e.b[1] - e.a[1], length = std::hypot(dr, dy);
        add(end[1] + dr / length * wall);
        add(end[1] - dr / length * wall);
      } else {
        const double sine = (end[1] - e.center[1]) / e.radius;
        add(e.center[1] + sine * (e.radius - wall));
        add(e.center[1] + sine * (e.radius + wall));
        add(e.center[1] + (e.radius - wall));
        add(e.center[1] - (e.radius - wall));
      }
    }
  }
  return {heights.begin(), heights.end()};
}

PreparedElement piece_of(const PreparedElement& element, Curve curve, double wall, double low, double high) {
  const auto radius_at = [&](double y) { return std::max(0.0, curve_radius(element, curve.kind, wall, y).value_or(0)); };
  PreparedElement piece;
  piece.a = {radius_at(low), low};
  piece.b = {radius_at(high), high};
  if (curve.kind < 2) {
    piece.center = curve.kind == 0 ? element.a : element.b;
    piece.radius = wall;
    piece.side = -1;
  } else if (element.side != 0) {
    piece.center = element.center;
    piece.radius = element.radius + (curve.kind == 2 ? -wall : wall);
    piece.side = element.side;
  }
  return piece;
}

// Rounding makes a curve's value just beyond its ends absent: evaluates slightly inside, and extends the exact curve to the end.
double settle(const PreparedElement& piece, double y) {
  if (piece.side == 0) {
    const double dy = piece.b[1] - piece.a[1];
    return piece.a[0] + (piece.b[0] - piece.a[0]) * ((y - piece.a[1]) / dy);
  }
  const double rise = y - piece.center[1];
  return piece.center[0] + piece.side * std::sqrt(std::max(0.0, (piece.radius - rise) * (piece.radius + rise)));
}

// Distance to the nearest of the named elements.
double distance_to(const std::vector<PreparedElement>& open, const std::vector<std::size_t>& near, double r, double y) {
  double best = 1e300;
  for (const std::size_t k : near) {
    const auto& e = open[k];
    const double to_ends = std::min(std::hypot(r - e.a[0], y - e.a[1]), std::hypot(r - e.b[0], y - e.b[1]));
    best = std::min(best, to_ends);
    if (e.side == 0) {
      const double dr = e.b[0] - e.a[0], dy = e.b[1] - e.a[1], squared = dr * dr + dy * dy;
      const double t = ((r - e.a[0]) * dr + (y - e.a[1]) * dy) / squared;
      if (t > 0 && t < 1) best = std::min(best, std::abs(dr * (y - e.a[1]) - dy * (r - e.a[0])) / std::sqrt(squared));
    } else {
      const double x = r - e.center[0], rise = y - e.center[1], distance = std::hypot(x, rise);
      const double foot = distance > 0 ? e.center[1] + rise * e.radius / distance : e.center[1];
      if (e.side * x >= 0 && foot >= std::min(e.a[1], e.b[1]) && foot <= std::max(e.a[1], e.b[1]))
        best = std::min(best, std::abs(distance - e.radius));
    }
  }
  return best;
}

// Radii of the hull at y, ascending: where a horizontal line crosses it.
std::vector<double> crossings(const std::vector<PreparedElement>& hull, double y) {
  std::vector<double> radii;
  for (const auto& e : hull) {
    const double low = std::min(e.a[1], e.b[1]), high = std::max(e.a[1], e.b[1]);
    if (y < low || y >= high) continue;
    radii.push_back(
        e.side == 0 ? e.a[0] + (e.b[0] - e.a[0]) * (y - e.a[1]) / (e.b[1] - e.a[1])
                    : e.center[0] + e.side * std::sqrt(std::max(0.0, e.radius * e.radius - (y - e.center[1]) * (y - e.center[1]))));
  }
  std::sort(radii.begin(), radii.end());
  return radii;
}

// The curve that bounds the room inside the wall, followed from the floor up to the mouth.
class InnerWall {
 public:
  InnerWall(const std::vector<PreparedElement>& hull, double wall, const VesselData& vessel)
      : hull_(hull), open_(hull.begin(), hull.end() - 1), wall_(wall), mouth_(hull.back().a[1]), vessel_(vessel) {}

  void follow() {
    const auto critical = critical_heights(open_, wall_, vessel_.floor, mouth_);
    // each critical height, and 32 steps between two of them
    constexpr int STEPS = 32;
    std::vector<double> heights;
    for (std::size_t i = 0; i + 1 < critical.size(); ++i)
      for (int k = 0; k < STEPS; ++k) heights.push_back(critical[i] + (critical[i + 1] - critical[i]) * k / STEPS);
    heights.push_back(mouth_);
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      if (i % STEPS == 0) near_ = elements_near(open_, wall_, heights[i], critical[i / STEPS + 1]);
      if (heights[i + 1] - heights[i] > 1e-15) follow_step(heights[i], heights[i + 1]);
    }
    finish_piece(mouth_);
  }

  void check_room() const {
    if (pieces_.empty()) throw refusal("no room is left inside; it must be less than the radius and the height");
    if (vessel_.floor > 0 && pieces_.front().a[1] > vessel_.floor) {
      throw refusal("the wall fills the vessel up to " + std::to_string(pieces_.front().a[1] * 1e3) +
                    " mm; floor_mm = " + std::to_string(vessel_.floor * 1e3) + " must be that or more");
    }
  }

  // The cavity has one radius per height: no free room may lie beyond it.
  void check_folds() const {
    const double floor = pieces_.front().a[1];
    for (int i = 0; i < 128; ++i) {
      const double y = floor + (mouth_ - floor) * (i + 0.5) / 128;
      const auto radii = crossings(hull_, y);
      const std::vector<std::size_t> within = elements_near(open_, wall_, y, y);  // no other is nearer than the wall
      const double inner = first_blocked(open_, within, wall_, y).value_or(Boundary{}).radius;
      for (std::size_t k = 0; k < radii.size(); k += 2) {
        const double from = k == 0 ? inner : radii[k - 1];
        for (int j = 0; j < 64; ++j) {
          const double r = from + (radii[k] - from) * (j + 0.5) / 64;
          if (distance_to(open_, within, r, y) > wall_ * (1 + 1e-9) + 1e-12)
            throw refusal("the inner wall folds over itself at " + std::to_string(y * 1e3) +
                          " mm; the cavity must have one radius at each height");
        }
      }
    }
  }

  const std::vector<PreparedElement>& pieces() const { return pieces_; }

 private:
  Error refusal(const std::string& what) const {
    return usage_error(
        at_place(vessel_.cavity_place, "vessel '" + vessel_.name + "': wall_mm = " + std::to_string(wall_ * 1e3) + ": " + what));
  }

  // None: closed.
  std::optional<Curve> curve_at(double y) const {
    const auto blocked = first_blocked(open_, near_, wall_, y);
    return !blocked || blocked->radius <= 0 ? std::nullopt : std::optional<Curve>(blocked->curve);
  }

  // From the curve just above `low` to the one just below `high`; at most one change lies between them.
  void follow_step(double low, double high) {
    const double inset = (high - low) * 1e-7;
    double at = low + inset;
    while (true) {
      const std::optional<Curve> curve = curve_at(at);
      if (curve != current_) {
        const double y = at <= low + inset ? low : at;
        finish_piece(y);
        if (!curve && was_open_)
          throw refusal("the wall closes the vessel at " + std::to_string(y * 1e3) +
                        " mm; it must leave an opening up to the mouth, or floor_mm lie above");
        current_ = curve;
        begin_ = y;
        was_open_ = was_open_ || curve.has_value();
      }
      if (curve_at(high - inset) == current_) break;
      at = end_of_current(at, high - inset);
    }
  }

  // Where the current curve ends, which exists at `below` and not at `above`: by bisection.
  double end_of_current(double below, double above) const {
    for (int step = 0; step < 200 && above - below > 1e-17; ++step) {
      const double middle = 0.5 * (below + above);
      if (middle <= below || middle >= above) break;
      (curve_at(middle) == current_ ? below : above) = middle;
    }
    return above;
  }

  void finish_piece(double y) {
    if (!current_ || !(y > begin_)) return;
    PreparedElement piece =
        piece_of(open_[current_->element], *current_, wall_, begin_ + (y - begin_) * 1e-9, y - (y - begin_) * 1e-9);
    const double low = settle(piece, begin_), high = settle(piece, y);
    piece.a = {std::max(0.0, low), begin_};
    piece.b = {std::max(0.0, high), y};
    pieces_.push_back(piece);
  }

  const std::vector<PreparedElement>& hull_;
  std::vector<PreparedElement> open_;  // without the lid
  double wall_, mouth_;
  const VesselData& vessel_;
  std::vector<std::size_t> near_;  // the same for all steps between two critical heights
  std::vector<PreparedElement> pieces_;
  std::optional<Curve> current_;  // none: closed
  double begin_ = 0;
  bool was_open_ = false;
};

}  // namespace

std::vector<PreparedElement> inner_offset(const std::vector<PreparedElement>& hull, double wall, const VesselData& vessel) {
  InnerWall inner(hull, wall, vessel);
  inner.follow();
  inner.check_room();
  inner.check_folds();
  return inner.pieces();
}

}  // namespace wholehand
