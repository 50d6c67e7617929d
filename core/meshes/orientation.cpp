// SPDX-License-Identifier: MIT
#include "core/meshes/orientation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "core/meshes/winding_tree.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr double FOLDED = 0.99;           // cosine of the angle between two triangles, about their edge, that lie upon each other
constexpr double SAME_AREA = 1e-9;        // difference of two area vectors of the same edges, of their length: rounding
constexpr double PARALLEL = 0.9999;       // cosine of the angle between two patches of a flat sheet
constexpr double MOST_BEND = 1.05;        // area of a flat patch, of its area vector's length
constexpr double ROUNDED_VOLUME = 1e-12;  // of a part's area to the power 3/2: a flat one has so much, of either sign
constexpr double JUST_OUTSIDE = 1e-6;     // from an outermost corner to a point outside, of the mesh's extent
constexpr double CLEAR_OPENING = 16;      // of the winding number's clusters: it is then rounded to an integer

// Sets that are joined, each member with a parity to the set's root.
class Union {
 public:
  explicit Union(std::size_t count) : above_(count), parity_(count) { std::iota(above_.begin(), above_.end(), 0u); }

  std::pair<std::uint32_t, bool> root(std::uint32_t member) {
    std::uint32_t top = member;
    bool parity = false;
    while (above_[top] != top) {
      parity ^= parity_[top];
      top = above_[top];
    }
    for (bool left = parity; above_[member] != top && member != top;) {  // each then hangs directly below the root
      const std::uint32_t next = above_[member];
      const bool own = parity_[member];
      above_[member] = top;
      parity_[member] = left;
      left ^= own;
      member = next;
    }
    return {top, parity};
  }

  void join(std::uint32_t a, std::uint32_t b, bool differs) {
    const auto [root_a, parity_a] = root(a);
    const auto [root_b, parity_b] = root(b);
    if (root_a == root_b) return;
    above_[root_b] = root_a;
    parity_[root_b] = parity_a ^ parity_b ^ differs;
  }

 private:
  std::vector<std::uint32_t> above_;
  std::vector<bool> parity_;
};

// Numbers the sets from 0, in the order of their first members.
std::vector<std::uint32_t> set_numbers(Union& sets, std::size_t count, std::uint32_t& found) {
  constexpr std::uint32_t NONE = ~0u;
  std::vector<std::uint32_t> number_of_root(count, NONE), numbers(count);
  found = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t& number = number_of_root[sets.root(i).first];
    if (number == NONE) number = found++;
    numbers[i] = number;
  }
  return numbers;
}

glm::dvec3 corner_of(const TriangleMesh& mesh, std::uint32_t triangle, int k) {
  return to_vec3(mesh.vertices[mesh.triangles[triangle][k]]);
}

glm::dvec3 area_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const glm::dvec3 a = corner_of(mesh, triangle, 0);
  return glm::cross(corner_of(mesh, triangle, 1) - a, corner_of(mesh, triangle, 2) - a) / 2.0;
}

// Turns the triangles that are chosen.
template <class Choice>
void turn(TriangleMesh& mesh, std::vector<EdgeUse>& uses, std::vector<bool>& turned, const Choice& is_chosen) {
  std::vector<bool> turns(mesh.triangles.size());
  for (std::uint32_t t = 0; t < turns.size(); ++t) {
    turns[t] = is_chosen(t);
    if (!turns[t]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    turned[t].flip();
  }
  for (EdgeUse& use : uses) use.is_forward ^= turns[use.triangle];
}

// ---- sheets with two sides ----

// Whether the two triangles of an edge lie upon each other, as the sides of a sheet do at its rim.
bool is_folded(const TriangleMesh& mesh, std::span<const EdgeUse> edge) {
  const glm::dvec3 from = to_vec3(mesh.vertices[edge[0].low]), along = to_vec3(mesh.vertices[edge[0].high]) - from;
  const auto away = [&](const EdgeUse& use) {
    const glm::dvec3 side = glm::cross(along, area_of(mesh, use.triangle) * (use.is_forward ? 1.0 : -1.0));
    const double length = glm::length(side);
    return length > 0 ? side / -length : glm::dvec3(0);
  };
  return glm::dot(away(edge[0]), away(edge[1])) > FOLDED;
}

// A part of the surface that edges of two triangles join, folds excluded.
struct Patch {
  std::uint32_t first = 0, count = 0;              // of its triangles, in Patches::triangles
  std::size_t first_corner = 0, corner_count = 0;  // likewise; each corner once, ascending
  glm::dvec3 area{};                               // summed area vectors
  double all_area = 0;

  bool is_flat() const { return all_area <= MOST_BEND * glm::length(area); }
};

struct Patches {
  std::vector<Patch> patches;
  std::vector<std::uint32_t> triangles, corners;

  std::span<const std::uint32_t> triangles_of(std::uint32_t patch) const {
    return std::span(triangles).subspan(patches[patch].first, patches[patch].count);
  }
  std::span<const std::uint32_t> corners_of(std::uint32_t patch) const {
    return std::span(corners).subspan(patches[patch].first_corner, patches[patch].corner_count);
  }
};

Patches find_patches(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  const std::size_t count = mesh.triangles.size();
  Union joined(count);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && !is_folded(mesh, edge)) joined.join(edge[0].triangle, edge[1].triangle, false);
  });
  std::uint32_t found = 0;
  const std::vector<std::uint32_t> numbers = set_numbers(joined, count, found);
  Patches all;
  all.patches.resize(found);
  for (const std::uint32_t number : numbers) ++all.patches[number].count;
  for (std::uint32_t i = 1; i < found; ++i) all.patches[i].first = all.patches[i - 1].first + all.patches[i - 1].count;
  all.triangles.resize(count);
  std::vector<std::uint32_t> placed(found);
  for (std::uint32_t t = 0; t < count; ++t) all.triangles[all.patches[numbers[t]].first + placed[numbers[t]]++] = t;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < found; ++i) {
    Patch& patch = all.patches[i];
    corners.clear();
    for (const std::uint32_t t : all.triangles_of(i)) {
      corners.insert(corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
      const glm::dvec3 area = area_of(mesh, t);
      patch.area += area;
      patch.all_area += glm::length(area);
    }
    std::sort(corners.begin(), corners.end());
    patch.first_corner = all.corners.size();
    all.corners.insert(all.corners.end(), corners.begin(), std::unique(corners.begin(), corners.end()));
    patch.corner_count = all.corners.size() - patch.first_corner;
  }
  return all;
}

// Finds duplicate surfaces. A patch's summed area vector depends only on its rim, so those of patches with the same rim are equal or opposite.
class Doubles {
 public:
  Doubles(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses)
      : uses_(uses), all_(find_patches(mesh, uses)), sheet_(mesh.triangles.size(), NO_SHEET), left_out_(mesh.triangles.size()) {
    match_patches();
    drop_backs();
  }

  const std::vector<bool>& left_out() const { return left_out_; }
  const DoubledTriangles& found() const { return found_; }

 private:
  static constexpr std::uint32_t NO_SHEET = ~0u;

  void leave_out(std::uint32_t patch, std::size_t& counter) {
    for (const std::uint32_t t : all_.triangles_of(patch)) left_out_[t] = true;
    counter += all_.patches[patch].count;
  }

  void match_patches() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < all_.patches.size(); ++i)
      if (all_.patches[i].is_flat()) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const auto a = all_.corners_of(i), b = all_.corners_of(j);
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    const auto is_alike = [&](std::uint32_t i, std::uint32_t j) {
      const auto a = all_.corners_of(i), b = all_.corners_of(j);
      return std::equal(a.begin(), a.end(), b.begin(), b.end());
    };
    for (std::size_t first = 0, next = 0; first < order.size(); first = next) {
      for (next = first + 1; next < order.size() && is_alike(order[first], order[next]);) ++next;
      match_alike(std::span(order).subspan(first, next - first));
    }
  }

  // Patches of the same corners.
  void match_alike(std::span<const std::uint32_t> alike) {
    const glm::dvec3 front = all_.patches[alike[0]].area;
    const double near = SAME_AREA * glm::length(front);
    std::uint32_t back = NO_SHEET;
    for (const std::uint32_t other : alike.subspan(1)) {
      const glm::dvec3 area = all_.patches[other].area;
      const bool is_opposite = glm::length(front + area) <= near;
      if (is_opposite && back == NO_SHEET) {
        back = other;
      } else if (is_opposite || glm::length(front - area) <= near) {
        leave_out(other, found_.copies);
      }
    }
    if (back == NO_SHEET) return;
    for (const std::uint32_t side : {alike[0], back})
      for (const std::uint32_t t : all_.triangles_of(side)) sheet_[t] = static_cast<std::uint32_t>(backs_.size());
    backs_.push_back(back);
  }

  // Sheets that share edges stay or go together. Edges with an odd number of other triangles need one side of the sheet to be closed; edges with an
  // even number are closed without it. A flat sheet that touches nothing else, such as a label, encloses nothing with one side or two: it stays,
  // because one side would open a closed mesh.
  void drop_backs() {
    Union joined(backs_.size());
    for_each_edge(uses_, [&](std::span<const EdgeUse> edge) {
      std::uint32_t first = NO_SHEET;
      for (const EdgeUse& use : edge) {
        const std::uint32_t sheet = sheet_[use.triangle];
        if (sheet == NO_SHEET) continue;
        if (first != NO_SHEET) joined.join(first, sheet, false);
        first = sheet;
      }
    });
    const auto normal_of = [&](std::uint32_t sheet) { return glm::normalize(all_.patches[backs_[sheet]].area); };
    // for each root sheet: edges that need one side, less the others, and whether it is more than a flat sheet alone
    std::vector<std::int64_t> needed(backs_.size());
    std::vector<bool> is_body(backs_.size());
    for_each_edge(uses_, [&](std::span<const EdgeUse> edge) {
      std::uint32_t sheet = NO_SHEET;
      std::size_t others = 0;
      for (const EdgeUse& use : edge) {
        if (left_out_[use.triangle]) continue;
        if (sheet_[use.triangle] == NO_SHEET) {
          ++others;
        } else {
          sheet = sheet_[use.triangle];
        }
      }
      if (sheet == NO_SHEET || others == 0) return;
      const std::uint32_t root = joined.root(sheet).first;
      needed[root] += others % 2 == 1 ? 1 : -1;
      is_body[root] = true;
    });
    for (std::uint32_t sheet = 0; sheet < backs_.size(); ++sheet) {
      const std::uint32_t root = joined.root(sheet).first;
      if (!(std::abs(glm::dot(normal_of(sheet), normal_of(root))) > PARALLEL)) is_body[root] = true;
    }
    for (std::uint32_t sheet = 0; sheet < backs_.size(); ++sheet) {
      const std::uint32_t root = joined.root(sheet).first;
      if (is_body[root] && needed[root] >= 0) leave_out(backs_[sheet], found_.backs);
    }
  }

  const std::vector<EdgeUse>& uses_;
  const Patches all_;
  std::vector<std::uint32_t> sheet_;  // of each triangle: the sheet of which it is one side
  std::vector<std::uint32_t> backs_;  // of each sheet: the patch that is its back
  std::vector<bool> left_out_;
  DoubledTriangles found_;
};

// ---- outward ----

// The parts of a consistent mesh: joined over edges of two triangles that turn the same way.
struct Part {
  double volume = 0;  // with each hole closed by a cone to the rim's middle
  double area = 0;
  bool is_closed = true;
  std::array<std::uint32_t, 6> outermost{};  // corners: least and largest x, y, z

  bool is_inverted() const { return volume < -ROUNDED_VOLUME * area * std::sqrt(area); }
};

std::vector<Part> measure_parts(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses,
                                const std::vector<std::uint32_t>& numbers, std::uint32_t count, const glm::dvec3& rim) {
  std::vector<Part> parts(count);
  std::vector<bool> is_seen(count);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Part& part = parts[numbers[t]];
    part.volume += glm::dot(corner_of(mesh, t, 0) - rim, glm::cross(corner_of(mesh, t, 1) - rim, corner_of(mesh, t, 2) - rim)) / 6;
    part.area += glm::length(area_of(mesh, t));
    if (!is_seen[numbers[t]]) part.outermost.fill(mesh.triangles[t][0]);
    is_seen[numbers[t]] = true;
    for (const std::uint32_t corner : mesh.triangles[t])
      for (int k = 0; k < 3; ++k) {
        if (mesh.vertices[corner][k] < mesh.vertices[part.outermost[2 * k]][k]) part.outermost[2 * k] = corner;
        if (mesh.vertices[corner][k] > mesh.vertices[part.outermost[2 * k + 1]][k]) part.outermost[2 * k + 1] = corner;
      }
  }
  std::vector<std::pair<std::uint32_t, int>> ways;  // parts at an edge, and in which direction they use it
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    ways.clear();
    for (const EdgeUse& use : edge) ways.emplace_back(numbers[use.triangle], use.is_forward ? 1 : -1);
    std::sort(ways.begin(), ways.end());
    for (std::size_t first = 0, next = 0; first < ways.size(); first = next) {
      int sum = 0;
      for (next = first; next < ways.size() && ways[next].first == ways[first].first; ++next) sum += ways[next].second;
      if (sum != 0) parts[ways[first].first].is_closed = false;
    }
  });
  return parts;
}

// How often the other parts go round a closed part, at that of its outermost points where they do so least: 0 where it lies within none.
double winding_about(const WindingTree& tree, const TriangleMesh& mesh, const Part& part, double extent) {
  double least = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 6; ++side) {
    Triple p = mesh.vertices[part.outermost[side]];
    p[side / 2] += (side % 2 == 0 ? -1 : 1) * JUST_OUTSIDE * extent;
    const double winding = std::round(tree.winding_number(to_vec3(p), CLEAR_OPENING));
    if (std::abs(winding) < std::abs(least)) least = winding;
  }
  return least;
}

double extent_of(const TriangleMesh& mesh) {
  double extent = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                                                 [k](const Triple& a, const Triple& b) { return a[k] < b[k]; });
    extent = std::max(extent, (*high)[k] - (*low)[k]);
  }
  return extent;
}

}  // namespace

DoubledTriangles drop_doubled(TriangleMesh& mesh, std::vector<EdgeUse>& uses) {
  const Doubles doubles(mesh, uses);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!doubles.left_out()[i]) mesh.triangles[kept++] = mesh.triangles[i];
  mesh.triangles.resize(kept);
  uses = edge_uses(mesh.triangles);
  return doubles.found();
}

void make_consistent(TriangleMesh& mesh, std::vector<EdgeUse>& uses, std::vector<bool>& turned) {
  const std::size_t count = mesh.triangles.size();
  Union joined(count);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) joined.join(edge[0].triangle, edge[1].triangle, edge[0].is_forward == edge[1].is_forward);
  });
  std::vector<double> balance(count);  // of a root: area that turns as it does, less the other
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [root, differs] = joined.root(t);
    balance[root] += (differs ? -1 : 1) * glm::length(area_of(mesh, t));
  }
  turn(mesh, uses, turned, [&](std::uint32_t t) {
    const auto [root, differs] = joined.root(t);
    return differs == (balance[root] >= 0);
  });
}

void turn_outward(TriangleMesh& mesh, std::vector<EdgeUse>& uses, const Triple& rim, std::vector<bool>& turned) {
  const std::size_t triangles = mesh.triangles.size();
  Union joined(triangles);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].is_forward != edge[1].is_forward) joined.join(edge[0].triangle, edge[1].triangle, false);
  });
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> numbers = set_numbers(joined, triangles, count);
  const std::vector<Part> parts = measure_parts(mesh, uses, numbers, count, to_vec3(rim));
  double open_volume = 0;
  bool has_inverted = false;
  for (const Part& part : parts) {
    if (!part.is_closed) open_volume += part.volume;
    has_inverted = has_inverted || (part.is_closed && part.is_inverted());
  }
  if (!has_inverted && !(open_volume < 0)) return;
  const WindingTree tree(mesh);
  const double extent = extent_of(mesh);
  std::vector<bool> turns(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double about = parts[i].is_closed ? winding_about(tree, mesh, parts[i], extent) : 0;
    turns[i] = about != 0 ? about < 0 : parts[i].is_closed ? parts[i].is_inverted() : open_volume < 0;
  }
  turn(mesh, uses, turned, [&](std::uint32_t t) { return turns[numbers[t]]; });
}

}  // namespace wholehand
