// SPDX-License-Identifier: MIT
#include "tests/support/sampled_outline.h"

#include <algorithm>
#include <utility>

namespace wholehand {

std::vector<Piece> pieces_of(const VesselData& vessel) {
  std::vector<Piece> pieces;
  double r = 0, y = 0;
  for (const OutlineElement& element : vessel.outline) {
    Piece piece{element.is_arc, r, y, element.end[0], element.end[1], element.center[0], element.center[1], 0, 0, 0};
    if (piece.is_arc) {
      piece.radius = std::hypot(r - piece.cr, y - piece.cy);
      piece.from = std::atan2(y - piece.cy, r - piece.cr);
      piece.sweep = std::remainder(std::atan2(piece.by - piece.cy, piece.br - piece.cr) - piece.from, 2 * PI);
      const bool is_half = std::abs(std::abs(piece.sweep) - PI) < 1e-9;  // then the way further from the axis
      if (is_half && std::cos(piece.from + piece.sweep / 2) < 0) piece.sweep = -piece.sweep;
    }
    pieces.push_back(piece);
    r = element.end[0];
    y = element.end[1];
  }
  return pieces;
}

std::vector<Piece> open_pieces(const VesselData& vessel) {
  std::vector<Piece> pieces = pieces_of(vessel);
  pieces.pop_back();
  return pieces;
}

Sampled::Sampled(std::vector<Piece> pieces, int samples) : pieces_(std::move(pieces)) {
  double total = 0;
  for (const Piece& piece : pieces_) total += piece.length();
  for (const Piece& piece : pieces_) {
    const int n = std::max(16, static_cast<int>(samples * piece.length() / total));
    std::vector<double> r, y;
    for (int i = 0; i <= n; ++i) {
      const Vec2 q = piece.at(static_cast<double>(i) / n);
      r.push_back(q.x);
      y.push_back(q.y);
    }
    spacing_ = std::max(spacing_, piece.length() / n);
    r_.push_back(r);
    y_.push_back(y);
  }
}

double Sampled::distance(Vec2 q) const {
  std::vector<double> least(pieces_.size());
  std::vector<std::size_t> where(pieces_.size());
  double bound = 1e300;
  for (std::size_t e = 0; e < pieces_.size(); ++e) {
    double best = 1e300;
    for (std::size_t i = 0; i < r_[e].size(); ++i) {
      const double dr = r_[e][i] - q.x, dy = y_[e][i] - q.y;
      const double d = dr * dr + dy * dy;
      where[e] = d < best ? i : where[e];
      best = d < best ? d : best;
    }
    least[e] = std::sqrt(best);
    bound = std::min(bound, least[e]);
  }
  double result = bound;
  for (std::size_t e = 0; e < pieces_.size(); ++e) {
    if (least[e] > bound + spacing_) continue;
    const double n = static_cast<double>(r_[e].size() - 1), i = static_cast<double>(where[e]);
    double low = std::max(0.0, (i - 1) / n), high = std::min(1.0, (i + 1) / n);
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    const auto far = [&](double t) { return glm::distance(pieces_[e].at(t), q); };
    for (int step = 0; step < 60; ++step) {
      const double left = high - ratio * (high - low), right = low + ratio * (high - low);
      (far(left) < far(right) ? high : low) = far(left) < far(right) ? right : left;
    }
    result = std::min({result, far(low), far(high)});
  }
  return result;
}

bool Sampled::inside(Vec2 q) const {
  const double c = std::cos(1.0), s = std::sin(1.0);
  const auto along = [&](double r, double y) { return (r - q.x) * c + (y - q.y) * s; };
  const auto across = [&](double r, double y) { return (y - q.y) * c - (r - q.x) * s; };
  bool odd = false;
  double last_r = -1, last_y = pieces_.front().ay;
  const auto edge = [&](double r, double y) {
    const double v0 = across(last_r, last_y), v1 = across(r, y);
    if ((v0 < 0) != (v1 < 0)) {
      const double u0 = along(last_r, last_y), u1 = along(r, y);
      if (u0 + (u1 - u0) * v0 / (v0 - v1) > 0) odd = !odd;
    }
    last_r = r;
    last_y = y;
  };
  for (std::size_t e = 0; e < pieces_.size(); ++e) {
    for (std::size_t i = 0; i < r_[e].size(); ++i) edge(r_[e][i], y_[e][i]);
  }
  edge(-1, pieces_.back().by);
  edge(-1, pieces_.front().ay);
  return odd;
}

Vec3 around(Vec2 q, double azimuth) { return {q.x * std::cos(azimuth), q.y, q.x * std::sin(azimuth)}; }

Vec2 point_in_box(const VesselData& vessel, Random& random) {
  const double wide = 1.5 * largest_radius(vessel), high = vessel.height;
  return {random.uniform(0, wide), random.uniform(-0.4 * high, 1.4 * high)};
}

std::vector<Vec2> queries(const VesselData& vessel, const std::vector<Piece>& pieces, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) points.push_back(point_in_box(vessel, random));
  for (int i = 0; i < 20; ++i) points.push_back({0, random.uniform(-0.2, 1.2) * vessel.height});
  for (const Piece& piece : pieces) {
    for (const double t : {0.0, 0.1, 0.5, 1.0}) {
      for (const double off : {0.0, 1e-3, -1e-3, 1e-6, -1e-6, 1e-8, -1e-8}) {
        const Vec2 q = piece.at(t) + off * piece.normal(t);
        if (q.x >= 0) points.push_back(q);
      }
    }
    for (const double r : {0.0, 5e-3, 21e-3, 33e-3, 60e-3}) points.push_back({r, piece.by});  // level with an element's end
    if (piece.is_arc) points.push_back({piece.cr, piece.cy});
  }
  points.push_back({1, 0});
  points.push_back({3, -100});
  points.push_back({0, 100});
  return points;
}

}  // namespace wholehand
