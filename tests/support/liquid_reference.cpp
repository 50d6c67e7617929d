// SPDX-License-Identifier: MIT
#include "tests/support/liquid_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wholehand::liquid_reference {
namespace {

constexpr Wide WIDE_PI = std::numbers::pi_v<Wide>;
constexpr Wide SPLIT = 1e-6L;  // m: a nearer end is meant to be the circle's largest radius and off by rounding

struct Node {
  Wide x, weight;  // on [-1, 1]
};

// Tanh-sinh: x = tanh(pi/2 sinh t). Takes algebraic and logarithmic ends; the step leaves under 1e-13 of the integrals here, which
// tests/core/liquid_test.cpp shows against closed forms.
const std::vector<Node>& nodes() {
  static const std::vector<Node> all = [] {
    std::vector<Node> result;
    const Wide step = 0.125L;
    for (int k = -27; k <= 27; ++k) {
      const Wide t = k * step, stretch = WIDE_PI / 2 * std::sinh(t);
      result.push_back({std::tanh(stretch), step * WIDE_PI / 2 * std::cosh(t) / (std::cosh(stretch) * std::cosh(stretch))});
    }
    return result;
  }();
  return all;
}

// Height at which the radius is r, on a piece whose radius is not constant; its nearer end beyond its range.
Wide height_at(const Piece& piece, Wide r) {
  const bool widens = piece.high_radius > piece.low_radius;
  if (r <= std::min(piece.low_radius, piece.high_radius)) return widens ? piece.low : piece.high;
  if (r >= std::max(piece.low_radius, piece.high_radius)) return widens ? piece.high : piece.low;
  if (piece.side == 0)
    return piece.low + (r - piece.low_radius) / (piece.high_radius - piece.low_radius) * (piece.high - piece.low);
  const Wide across = r - piece.center_r;
  const Wide along = std::sqrt(std::max(Wide(0), (piece.radius - across) * (piece.radius + across)));
  // the half of the circle that this piece lies on
  return (piece.low + piece.high) / 2 > piece.center_y ? piece.center_y + along : piece.center_y - along;
}

// Area of the slice at n = x under the plane, and its first moment by height, of one piece.
void add_slice(const Piece& piece, Wide x, Wide level, Wide sine, Wide cosine, Wide& area, Wide& moment) {
  const Wide distance = std::abs(x);
  if (std::max(piece.low_radius, piece.high_radius) <= distance) return;
  Wide from = piece.low, to = piece.high;
  if (std::min(piece.low_radius, piece.high_radius) < distance) {
    (piece.high_radius > piece.low_radius ? from : to) = height_at(piece, distance);
  }
  if (cosine > 0) {
    to = std::min(to, (level + sine * x) / cosine);
  } else if (cosine < 0) {
    from = std::max(from, (level + sine * x) / cosine);
  } else if (-sine * x > level) {
    return;
  }
  if (to <= from) return;
  const Wide middle = (from + to) / 2, half = (to - from) / 2;
  for (const Node& node : nodes()) {
    const Wide y = middle + half * node.x, r = radius_at(piece, y);
    const Wide chord = 2 * half * node.weight * std::sqrt(std::max(Wide(0), (r - distance) * (r + distance)));
    area += chord;
    moment += chord * y;
  }
}

// Where the plane meets a wall in the half plane: cos y - sin sigma r = level on the piece; adds sigma r.
void add_crossings(const Piece& piece, Wide sigma, Wide level, Wide sine, Wide cosine, std::vector<Wide>& breaks) {
  const auto add = [&](Wide y) {
    if (y > piece.low && y < piece.high) breaks.push_back(sigma * radius_at(piece, y));
  };
  const Wide lateral = -sine * sigma;  // the plane: cosine y + lateral r = level
  if (piece.side == 0) {
    const Wide slope = (piece.high_radius - piece.low_radius) / (piece.high - piece.low);
    add((level - lateral * (piece.low_radius - slope * piece.low)) / (cosine + lateral * slope));
    return;
  }
  const Wide distance = level - cosine * piece.center_y - lateral * piece.center_r;
  if (std::abs(distance) >= piece.radius) return;
  const Wide half = std::sqrt(piece.radius * piece.radius - distance * distance);
  for (const Wide sign : {-1, 1}) {
    const Wide r = piece.center_r + distance * lateral - sign * half * cosine;
    if ((r - piece.center_r) * piece.side >= 0) add(piece.center_y + distance * cosine + sign * half * lateral);
  }
}

}  // namespace

Piece line_piece(Wide low, Wide low_radius, Wide high, Wide high_radius) {
  return {low, high, low_radius, high_radius, 0, 0, 0, 0};
}

Piece arc_piece(Wide low, Wide high, Wide center_r, Wide center_y, Wide radius, int side) {
  Piece piece{low, high, 0, 0, side, center_r, center_y, radius};
  piece.low_radius = radius_at(piece, low);
  piece.high_radius = radius_at(piece, high);
  return piece;
}

Wide radius_at(const Piece& piece, Wide y) {
  if (piece.side == 0) {
    return piece.low_radius + (piece.high_radius - piece.low_radius) * ((y - piece.low) / (piece.high - piece.low));
  }
  const Wide along = y - piece.center_y;
  return std::max(Wide(0),
                  piece.center_r + piece.side * std::sqrt(std::max(Wide(0), (piece.radius - along) * (piece.radius + along))));
}

Cavity beaker1_cavity() { return {line_piece(1.5e-3L, 38.5e-3L, 110e-3L, 38.5e-3L)}; }

Cavity beaker2_cavity() {
  const Wide R = 42.5e-3L, wall = 1.5e-3L, neck = 17e-3L, rise = std::sqrt((R - neck) * (R + neck));
  const Wide corner = R + rise;                   // height of the corner between sphere and neck
  const Wide leaves = R + rise * (R - wall) / R;  // of the inner sphere's end, on the corner's radius to the sphere's middle
  return {arc_piece(wall, R, 0, R, R - wall, 1), arc_piece(R, leaves, 0, R, R - wall, 1),
          arc_piece(leaves, corner, neck, corner, wall, -1), line_piece(corner, neck - wall, 140e-3L, neck - wall)};
}

Cavity beaker3_cavity() {
  const Wide wall = 1.5e-3L, base = 42.5e-3L, neck = 17e-3L, upright = 4e-3L, shoulder = 105e-3L;
  const Wide slant = std::hypot(base - neck, shoulder - upright);
  const Wide sine = (base - neck) / slant, cosine = (shoulder - upright) / slant;  // of the cone's angle to the axis
  // the inner cone runs `wall` inside the line through (base, upright) and (neck, shoulder), whose inward normal is (-cosine,
  // -sine)
  const Wide meets = upright - wall * (1 - cosine) / sine;  // where it meets the inner upright wall
  const Wide leaves = shoulder - wall * sine;
  return {line_piece(wall, base - wall, meets, base - wall), line_piece(meets, base - wall, leaves, neck - wall * cosine),
          arc_piece(leaves, shoulder, neck, shoulder, wall, -1), line_piece(shoulder, neck - wall, 145e-3L, neck - wall)};
}

Cavity cavity_of(const std::vector<PreparedElement>& elements) {
  Cavity cavity;
  for (const PreparedElement& e : elements) {
    if (!(e.b[1] > e.a[1])) continue;
    if (e.side == 0) {
      cavity.push_back(line_piece(e.a[1], e.a[0], e.b[1], e.b[0]));
    } else if (e.center[1] > e.a[1] + SPLIT && e.center[1] < e.b[1] - SPLIT) {
      cavity.push_back(arc_piece(e.a[1], e.center[1], e.center[0], e.center[1], e.radius, e.side));
      cavity.push_back(arc_piece(e.center[1], e.b[1], e.center[0], e.center[1], e.radius, e.side));
    } else {
      cavity.push_back(arc_piece(e.a[1], e.b[1], e.center[0], e.center[1], e.radius, e.side));
    }
  }
  return cavity;
}

Body below(const Cavity& cavity, Wide level, Wide tilt) {
  const Wide sine = std::sin(tilt), cosine = std::cos(tilt);
  Wide largest = 0;
  for (const Piece& piece : cavity) largest = std::max({largest, piece.low_radius, piece.high_radius});

  // between these the slice's area is a smooth function of n
  std::vector<Wide> breaks{-largest, 0, largest};
  for (const Piece& piece : cavity) {
    for (const Wide r : {piece.low_radius, piece.high_radius}) breaks.insert(breaks.end(), {-r, r});
    if (sine != 0) {
      for (const Wide y : {piece.low, piece.high}) breaks.push_back((cosine * y - level) / sine);
      for (const Wide sigma : {-1, 1}) add_crossings(piece, sigma, level, sine, cosine, breaks);
    }
  }
  for (Wide& x : breaks) x = std::clamp(x, -largest, largest);
  std::sort(breaks.begin(), breaks.end());

  Wide volume = 0, lean = 0, height = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const Wide middle = (breaks[i] + breaks[i + 1]) / 2, half = (breaks[i + 1] - breaks[i]) / 2;
    if (half <= 0) continue;
    for (const Node& node : nodes()) {
      const Wide x = middle + half * node.x;
      Wide area = 0, moment = 0;
      for (const Piece& piece : cavity) add_slice(piece, x, level, sine, cosine, area, moment);
      volume += half * node.weight * area;
      lean += half * node.weight * area * x;
      height += half * node.weight * moment;
    }
  }
  return volume > 0 ? Body{volume, lean / volume, height / volume} : Body{};
}

Body revolved(const Cavity& cavity) {
  Wide volume = 0, moment = 0;
  for (const Piece& p : cavity) {
    if (p.side == 0) {
      // r^2 of a frustum is a parabola in y: Simpson's rule is exact for it and for y r^2
      const Wide h = p.high - p.low, mid_y = (p.low + p.high) / 2, mid_r = (p.low_radius + p.high_radius) / 2;
      const Wide a = p.low_radius * p.low_radius, m = 4 * mid_r * mid_r, b = p.high_radius * p.high_radius;
      volume += WIDE_PI * h / 6 * (a + m + b);
      moment += WIDE_PI * h / 6 * (a * p.low + m * mid_y + b * p.high);
      continue;
    }
    // with v = y - center_y: r^2 = c^2 + R^2 - v^2 + 2 side c sqrt(R^2 - v^2), integrated term by term
    const auto integrals = [&](Wide y, Wide& zeroth, Wide& first) {
      const Wide R = p.radius, c = p.center_r, v = std::clamp(y - p.center_y, -R, R), root = std::sqrt((R - v) * (R + v));
      zeroth = (c * c + R * R) * v - v * v * v / 3 + p.side * c * (v * root + R * R * std::atan2(v, root));
      first = (c * c + R * R) * v * v / 2 - v * v * v * v / 4 - 2 * p.side * c * root * root * root / 3;
    };
    Wide zeroth_high, first_high, zeroth_low, first_low;
    integrals(p.high, zeroth_high, first_high);
    integrals(p.low, zeroth_low, first_low);
    volume += WIDE_PI * (zeroth_high - zeroth_low);
    moment += WIDE_PI * (first_high - first_low + p.center_y * (zeroth_high - zeroth_low));
  }
  return {volume, 0, moment / volume};
}

Wide lip_level(const Cavity& cavity, Wide tilt) {
  return cavity.back().high * std::cos(tilt) - cavity.back().high_radius * std::sin(tilt);
}

}  // namespace wholehand::liquid_reference
