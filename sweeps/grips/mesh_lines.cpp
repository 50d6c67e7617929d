// SPDX-License-Identifier: MIT
#include "sweeps/grips/mesh_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"

namespace wholehand::sweeps {
namespace {

constexpr double EDGE_ON = 1e-6;      // cosine between a triangle's normal and the view: seen from its side
constexpr double LINE_DETAIL = 0.25;  // pixels
constexpr double SHORT_GAP = 4;       // pixels: a line hidden for less is drawn through
constexpr double SHORT_LINE = 3;      // pixels: a visible piece shorter than this, of a line hidden elsewhere, is not drawn

double length_between(const Flat& a, const Flat& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

double line_length(const std::vector<Flat>& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += length_between(line[i - 1], line[i]);
  return length;
}

double distance_to_segment(const Flat& p, const Flat& a, const Flat& b) {
  const Flat along{b[0] - a[0], b[1] - a[1]}, to{p[0] - a[0], p[1] - a[1]};
  const double squared = along[0] * along[0] + along[1] * along[1];
  const double t = squared > 0 ? std::clamp((to[0] * along[0] + to[1] * along[1]) / squared, 0.0, 1.0) : 0;
  return std::hypot(to[0] - t * along[0], to[1] - t * along[1]);
}

std::size_t count_points(const std::vector<std::vector<Flat>>& lines) {
  std::size_t count = 0;
  for (const auto& line : lines) count += line.size();
  return count;
}

// Simplifies lines further and further, up to four pixels, until they have few enough points; then leaves out the shortest.
void limit_points(std::vector<std::vector<Flat>>& lines, std::size_t most, double pixel) {
  for (double detail = 2 * LINE_DETAIL * pixel; count_points(lines) > most && detail <= 4 * pixel; detail *= 2)
    for (auto& line : lines) line = simplified(line, detail);
  if (count_points(lines) <= most) return;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < lines.size(); ++i) order.emplace_back(-line_length(lines[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<std::vector<Flat>> kept;
  for (const auto& [length, i] : order) {
    if (lines[i].size() > most) continue;
    most -= lines[i].size();
    kept.push_back(std::move(lines[i]));
  }
  lines = std::move(kept);
}

// Joins edges end to end, from each vertex where other than two of them meet, then the remaining rings.
class EdgeChains {
 public:
  EdgeChains(const std::vector<MeshEdge>& edges, std::size_t vertices)
      : edges_(edges), first_at_(vertices + 1), is_used_(edges.size()) {
    for (const MeshEdge& edge : edges) {
      ++first_at_[edge.from];
      ++first_at_[edge.to];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_at_) sum += std::exchange(first, sum);
    edges_at_.resize(sum);
    std::vector<std::uint32_t> next(first_at_.begin(), first_at_.end() - 1);
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      edges_at_[next[edges[e].from]++] = e;
      edges_at_[next[edges[e].to]++] = e;
    }
  }

  std::vector<std::vector<std::uint32_t>> take() {
    std::vector<std::vector<std::uint32_t>> chains;
    for (const bool of_rings : {false, true}) {
      for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        for (const std::uint32_t vertex : {edges_[e].from, edges_[e].to}) {
          if (!is_used_[e] && (of_rings || degree_of(vertex) != 2)) chains.push_back(follow(vertex, e));
        }
      }
    }
    return chains;
  }

 private:
  std::uint32_t degree_of(std::uint32_t vertex) const { return first_at_[vertex + 1] - first_at_[vertex]; }

  std::vector<std::uint32_t> follow(std::uint32_t vertex, std::uint32_t edge) {
    std::vector<std::uint32_t> chain{vertex};
    while (!is_used_[edge]) {
      is_used_[edge] = true;
      vertex = edges_[edge].from == vertex ? edges_[edge].to : edges_[edge].from;
      chain.push_back(vertex);
      if (degree_of(vertex) != 2) break;
      const std::uint32_t* here = &edges_at_[first_at_[vertex]];
      edge = here[0] == edge ? here[1] : here[0];
    }
    return chain;
  }

  const std::vector<MeshEdge>& edges_;
  std::vector<std::uint32_t> first_at_, edges_at_;  // edges at a vertex: from first_at_[vertex] to first_at_[vertex + 1]
  std::vector<bool> is_used_;
};

// A stretch of a line between two of its points or on the way, seen or hidden.
struct LineStretch {
  std::vector<Flat> line;
  bool is_seen = false;
};

// Appends a piece to the last stretch where that is as it is.
void extend(std::vector<LineStretch>& stretches, const Flat& from, const Flat& to, bool is_seen) {
  if (stretches.empty() || stretches.back().is_seen != is_seen) stretches.push_back({{from}, is_seen});
  stretches.back().line.push_back(to);
}

// Stretches of this kind that are too short take the other.
std::vector<LineStretch> without_short(const std::vector<LineStretch>& stretches, bool is_seen, double shortest) {
  std::vector<LineStretch> kept;
  for (const LineStretch& stretch : stretches) {
    const bool is_short = stretch.is_seen == is_seen && line_length(stretch.line) < shortest && stretches.size() > 1;
    for (std::size_t i = 1; i < stretch.line.size(); ++i)
      extend(kept, stretch.line[i - 1], stretch.line[i], stretch.is_seen != is_short);
  }
  return kept;
}

}  // namespace

std::vector<Flat> simplified(const std::vector<Flat>& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> is_kept(line.size());
  is_kept.front() = is_kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double away = distance_to_segment(line[i], line[first], line[last]);
      if (away > farthest) {
        farthest = away;
        at = i;
      }
    }
    if (at == first) continue;
    is_kept[at] = true;
    open.insert(open.end(), {{first, at}, {at, last}});
  }
  std::vector<Flat> kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (is_kept[i]) kept.push_back(line[i]);
  }
  return kept;
}

std::vector<Flat> simplified_loop(const std::vector<Flat>& loop, double tolerance) {
  if (loop.size() < 4) return loop;
  const auto far = static_cast<std::size_t>(
      std::max_element(loop.begin(), loop.end(),
                       [&](const Flat& a, const Flat& b) { return length_between(loop[0], a) < length_between(loop[0], b); }) -
      loop.begin());
  std::vector<Flat> there(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(far) + 1),
      back(loop.begin() + static_cast<std::ptrdiff_t>(far), loop.end());
  back.push_back(loop.front());
  std::vector<Flat> kept = simplified(there, tolerance);
  const std::vector<Flat> rest = simplified(back, tolerance);
  kept.insert(kept.end(), rest.begin() + 1, rest.end() - 1);
  return kept;
}

MeshView::MeshView(const MeshBody& body, const MeshEdges& edges, const Triple& right, const Triple& up, const Triple& toward,
                   double pixel)
    : body_(body),
      edges_(edges),
      right_(right),
      up_(up),
      toward_(toward),
      points_([&] {
        std::vector<Triple> points;
        points.reserve(body.vertices.size());
        for (const Triple& p : body.vertices) points.push_back({dot(right, p), dot(up, p), dot(toward, p)});
        return points;
      }()),
      depths_(points_, body.triangles, pixel) {}

Triple MeshView::seen(const Triple& p) const { return {dot(right_, p), dot(up_, p), dot(toward_, p)}; }

bool MeshView::faces_viewer(std::uint32_t triangle) const { return dot(edges_.normals[triangle], toward_) > EDGE_ON; }

double MeshView::cover_at(const Triple& p) const {
  const Triple at = seen(p);
  const double nearest = depths_.nearest_at({at[0], at[1]});
  return nearest == DepthMap::NOTHING ? nearest : nearest - at[2];
}

std::vector<std::vector<std::uint32_t>> MeshView::chains(bool of_contours) const {
  std::vector<MeshEdge> chosen;
  for (const MeshEdge& edge : edges_.edges) {
    const bool is_open = edge.right == NO_TRIANGLE, is_left_seen = faces_viewer(edge.left);
    const bool is_contour = is_open || is_left_seen != faces_viewer(edge.right);
    const bool is_crease = edge.is_crease && (is_left_seen || edges_.has_open);  // through an opening backs are seen
    if (of_contours ? is_contour : is_crease && !is_contour) chosen.push_back(edge);
  }
  return EdgeChains(chosen, body_.vertices.size()).take();
}

// A line lies on what it bounds, so it is hidden only if everything near it on the raster is nearer to the viewer.
void MeshView::add_visible(const std::vector<std::uint32_t>& chain, std::vector<std::vector<Flat>>& lines) const {
  const double pixel = depths_.pixel();
  std::vector<LineStretch> stretches;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Triple &a = points_[chain[i - 1]], &b = points_[chain[i]];
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) / pixel)));
    const auto at = [&](double t) { return point_between(a, b, t); };
    for (int k = 0; k < steps; ++k) {
      const Triple from = at(static_cast<double>(k) / steps), to = at((k + 1.0) / steps), middle = at((k + 0.5) / steps);
      const bool is_seen = middle[2] >= depths_.least_near({middle[0], middle[1]}) - pixel;
      extend(stretches, {from[0], from[1]}, {to[0], to[1]}, is_seen);
    }
  }
  stretches = without_short(without_short(stretches, false, SHORT_GAP * pixel), true, SHORT_LINE * pixel);
  for (const LineStretch& stretch : stretches) {
    if (stretch.is_seen) lines.push_back(simplified(stretch.line, LINE_DETAIL * pixel));
  }
}

MeshLines MeshView::lines() const {
  MeshLines lines;
  for (const auto& chain : chains(true)) add_visible(chain, lines.contours);
  for (const auto& chain : chains(false)) add_visible(chain, lines.creases);
  const double pixel = depths_.pixel();
  for (auto* some : {&lines.contours, &lines.creases})
    std::erase_if(*some, [&](const std::vector<Flat>& line) { return line_length(line) < LINE_DETAIL * pixel; });
  for (const auto& border : depths_.borders()) lines.covered.push_back(simplified_loop(border, pixel));
  limit_points(lines.contours, MOST_LINE_POINTS, pixel);
  limit_points(lines.creases, MOST_LINE_POINTS - count_points(lines.contours), pixel);
  limit_points(lines.covered, MOST_LINE_POINTS, pixel);
  return lines;
}

}  // namespace wholehand::sweeps
