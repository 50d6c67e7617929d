// SPDX-License-Identifier: MIT
#include "core/meshes/cavity_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/text/readable.h"
#include "core/meshes/free_radius.h"
#include "core/meshes/room.h"

namespace wholehand {
namespace {

constexpr int GRID_CELLS = 96;
constexpr AxisDirection UP{};
constexpr double LEAST_REACH = 1e-3;    // m, of a room whose outline a scene can hold
constexpr double LEAST_CAVITY = 0.01;   // of the mesh's box: smaller ones are grooves and the rings under feet
constexpr double ROUND_AXIS = 0.05e-3;  // m: an axis so near the middle of the box is that one
constexpr int AXIS_HEIGHTS = 33, PROFILE_HEIGHTS = 257, BRIM_HEIGHTS = 65, BRIM_ROUNDS = 3;
constexpr std::size_t MOST_HEIGHTS = 4096;  // of a profile: a rough inside has a jump everywhere
constexpr double JUMP_SHARE = 2e-3;    // of the room's size: neighboring heights that differ by more get another in their middle
constexpr double LEVEL_SHARE = 1e-5;   // of it: heights that are nearer differ by rounding
constexpr double MOST_PASSING = 0.1;   // of the rays at one height: beyond, the wall is open there
constexpr double CLEARLY_MORE = 1.05;  // the grid's count errs by less

// What the rays at one height say.
struct RayLevel {
  double least = 0, most = 0;  // m
  double area = 0;             // m2
  int passing = 0;             // rays that pass through a hole
};

std::vector<double> levels(double low, double high, int count) {
  std::vector<double> heights;
  for (int k = 0; k < count; ++k) heights.push_back(low + (high - low) * k / (count - 1));
  return heights;
}

// Gives rays that reach beyond `reach` the radius of their nearest neighbor before them that does not. Returns their number.
int close_gaps(FreeRadii& radii, double reach) {
  const auto is_passing = [&](double r) { return r > reach; };
  const int passing = static_cast<int>(std::count_if(radii.begin(), radii.end(), is_passing));
  if (passing == 0 || passing == static_cast<int>(radii.size())) return passing;
  const std::size_t first = static_cast<std::size_t>(std::find_if_not(radii.begin(), radii.end(), is_passing) - radii.begin());
  for (std::size_t k = 1; k < radii.size(); ++k) {
    double& radius = radii[(first + k) % radii.size()];
    if (is_passing(radius)) radius = radii[(first + k - 1) % radii.size()];
  }
  return passing;
}

class CavityFinder {
 public:
  CavityFinder(const CheckedMesh& mesh, const RoomGrid& grid, const Room& room)
      : mesh_(mesh.mesh), facts_(mesh.facts), grid_(grid), points_(points_of(grid, room, UP)) {
    for (const std::size_t point : points_) {
      const Triple p = grid.position(point);
      bottom_ = std::min(bottom_, p[1]);
      top_ = std::max(top_, p[1]);
      for (int k = 0; k < 3; ++k) middle_[k] += p[k] / static_cast<double>(points_.size());
    }
    found_.counted = room.volume;
  }

  CavitySearch find() {
    find_axis();
    find_reach();
    if (!find_floor())
      return {{},
              "holds liquid only around its middle, which no outline about an upright axis describes: give it an inner_outline of "
              "your own"};
    find_brim();
    if (!(found_.brim > found_.floor))
      return {{}, "holds liquid only beneath the floor's height on its axis: give it an inner_outline of your own"};
    measure();
    if (found_.passing_rays > MOST_PASSING * RAY_AZIMUTHS)
      return {{},
              fmt::format("has an open wall at a height of {:.4g} mm, which leaks: close it in a modeling program",
                          1e3 * found_.passing_height)};
    std::optional<CavityOutline> outline = outline_within(found_.profile);
    if (!outline && reach_ < LEAST_REACH)
      return {{}, "is too small: a scene has lengths to a micrometer, so give the mesh its size by mesh_scale"};
    if (!outline)
      return {{}, "has an inside too rough for an outline about its axis: smooth it, or give it an inner_outline of your own"};
    found_.outline = std::move(*outline);
    return {std::move(found_), ""};
  }

 private:
  // The center of the room, then of its rays: rays from a point that is off a circle's center by d vary by d times the cosine.
  void find_axis() {
    double x = middle_[0], z = middle_[2];
    const double height = top_ - bottom_;
    const std::vector<double> heights = levels(bottom_ + 0.2 * height, bottom_ + 0.9 * height, AXIS_HEIGHTS);
    for (int round = 0; round < 3; ++round) {
      std::vector<double> dx, dz;
      for (const FreeRadii& radii : free_radii(mesh_, x, z, heights)) {
        if (!std::isfinite(*std::max_element(radii.begin(), radii.end()))) continue;
        double cosine = 0, sine = 0;
        for (int k = 0; k < RAY_AZIMUTHS; ++k) {
          cosine += 2 * radii[k] * std::cos(2 * PI * k / RAY_AZIMUTHS) / RAY_AZIMUTHS;
          sine += 2 * radii[k] * std::sin(2 * PI * k / RAY_AZIMUTHS) / RAY_AZIMUTHS;
        }
        dx.push_back(cosine);
        dz.push_back(sine);
      }
      if (dx.empty()) break;
      const auto median = [](std::vector<double>& values) {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
        return values[values.size() / 2];
      };
      x += median(dx);
      z += median(dz);
    }
    const double box_x = (facts_.low[0] + facts_.high[0]) / 2, box_z = (facts_.low[2] + facts_.high[2]) / 2;
    if (std::hypot(x - box_x, z - box_z) < ROUND_AXIS) x = box_x, z = box_z;
    found_.axis = {x, 0, z};
  }

  void find_reach() {
    double reach = 0;
    for (const std::size_t point : points_) {
      const Triple p = grid_.position(point);
      reach = std::max(reach, std::hypot(p[0] - found_.axis[0], p[2] - found_.axis[2]));
    }
    reach_ = reach + 2 * grid_.step();
    level_ = LEVEL_SHARE * std::max(reach_, top_ - bottom_);
  }

  // The highest surface on the axis below the room's highest point there.
  bool find_floor() {
    double highest = -std::numeric_limits<double>::infinity();
    for (const std::size_t point : points_) {
      const Triple p = grid_.position(point);
      if (std::max(std::abs(p[0] - found_.axis[0]), std::abs(p[2] - found_.axis[2])) <= 0.5 * grid_.step())
        highest = std::max(highest, p[1]);
    }
    const std::vector<double> heights = heights_on_line(mesh_, found_.axis[0], found_.axis[2]);
    const auto above = std::upper_bound(heights.begin(), heights.end(), highest);
    if (!std::isfinite(highest) || above == heights.begin()) return false;
    found_.floor = *(above - 1);
    for (const std::size_t point : points_)
      if (grid_.position(point)[1] < found_.floor) found_.beneath += grid_.cell();
    return true;
  }

  std::vector<FreeRadii> rays(const std::vector<double>& heights) const {
    return free_radii(mesh_, found_.axis[0], found_.axis[2], heights);
  }

  // Where the first ray escapes: searched among equal steps, then among steps of the one in which it lies. The grid's layer counts where no ray escapes
  // near it, as under a spout that begins behind a bend, or where rays pass through a hole below it.
  void find_brim() {
    double low = top_ - grid_.step(), high = top_ + 2 * grid_.step();
    for (int round = 0; round < BRIM_ROUNDS; ++round) {
      const std::vector<double> heights = levels(low, high, BRIM_HEIGHTS);
      const std::vector<FreeRadii> radii = rays(heights);
      std::size_t closed = 0;
      while (closed < heights.size() && *std::max_element(radii[closed].begin(), radii[closed].end()) <= reach_) ++closed;
      if (round == 0 && (closed == 0 || closed == heights.size())) {
        found_.is_brim_rough = true;
        found_.brim = top_;
        return;
      }
      high = heights[std::min(closed, heights.size() - 1)];
      low = heights[closed > 0 ? closed - 1 : 0];
    }
    found_.brim = low;
  }

  void take(std::map<double, RayLevel>& taken, const std::vector<double>& heights) const {
    std::vector<FreeRadii> radii = rays(heights);
    const std::vector<double> least = least_radii(mesh_, found_.axis[0], found_.axis[2], heights);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      RayLevel level;
      level.passing = close_gaps(radii[k], reach_);
      level.least = std::min(least[k], reach_);
      for (const double r : radii[k]) {
        level.most = std::max(level.most, std::min(r, reach_));
        level.area += PI * std::min(r, reach_) * std::min(r, reach_) / RAY_AZIMUTHS;
      }
      taken.emplace(heights[k], level);
    }
  }

  // Equal steps, and the heights of the mesh's corners, between which the least radius has no corner of its own.
  std::vector<double> first_heights() const {
    std::vector<double> heights = levels(found_.floor + level_, found_.brim, PROFILE_HEIGHTS), corners;
    for (const Triple& vertex : mesh_.vertices)
      if (vertex[1] > found_.floor + level_ && vertex[1] < found_.brim) corners.push_back(vertex[1]);
    std::sort(corners.begin(), corners.end());
    const auto is_level = [this](double a, double b) { return b - a < level_; };
    corners.erase(std::unique(corners.begin(), corners.end(), is_level), corners.end());
    if (corners.size() <= MOST_HEIGHTS / 4) heights.insert(heights.end(), corners.begin(), corners.end());
    std::sort(heights.begin(), heights.end());
    return heights;
  }

  void measure() {
    const double jump = JUMP_SHARE * std::max(reach_, top_ - bottom_);
    std::map<double, RayLevel> taken;
    take(taken, first_heights());
    while (taken.size() < MOST_HEIGHTS) {
      std::vector<double> between;
      for (auto one = taken.begin(), next = std::next(one); next != taken.end(); ++one, ++next)
        if (std::abs(next->second.least - one->second.least) > jump && next->first - one->first > level_)
          between.push_back((one->first + next->first) / 2);
      if (between.empty()) break;
      take(taken, between);
    }
    found_.profile = {{0, found_.floor}};
    double volume = taken.begin()->second.area * level_;
    for (auto at = taken.begin(); at != taken.end(); ++at) {
      const auto& [y, level] = *at;
      found_.profile.push_back({level.least, y});
      if (const double spread = level.most - level.least; spread > found_.off_round)
        found_.off_round = spread, found_.off_round_height = y;
      if (level.passing > found_.passing_rays) found_.passing_rays = level.passing, found_.passing_height = y;
      if (at != taken.begin()) volume += (level.area + std::prev(at)->second.area) / 2 * (y - std::prev(at)->first);
    }
    // a level floor shows as a step as high as level_
    if (found_.profile.size() > 2 && found_.profile[1][0] > 0) found_.profile[1][1] = found_.floor;
    found_.capacity = found_.beneath + volume;
    const double layer = taken.rbegin()->second.area * grid_.step();  // a shallow room's count errs by so much
    if (found_.counted > CLEARLY_MORE * found_.capacity + layer) {
      found_.off_rays = found_.counted - found_.capacity;
      found_.capacity = found_.counted;
    }
  }

  const TriangleMesh& mesh_;
  const MeshFacts& facts_;
  const RoomGrid& grid_;
  std::vector<std::size_t> points_;
  Triple middle_{};
  double bottom_ = std::numeric_limits<double>::infinity(), top_ = -bottom_;
  double reach_ = 0;  // m: no ray that stays in the room is longer
  double level_ = 0;  // m: heights that are nearer are the same
  FoundCavity found_;
};

std::string reason_for_none(const CheckedMesh& mesh, const RoomGrid& grid, const Rooms& rooms) {
  for (const Room& room : rooms.sealed)
    if (is_cavity(room, mesh.facts) && !is_enclosed(mesh.mesh, grid.position(room.seed)))
      return fmt::format(
          "is closed above: the room of {} mL within it has no opening of {} mm or more; cut one in a modeling program",
          fixed_text(1e6 * room.volume, 0), fixed_text(1e3 * grid.step(), 1));
  const Rooms below = find_rooms(grid, {1, false});
  if (below.largest && is_cavity(*below.largest, mesh.facts))
    return "opens downward, so it stands upside down: rotate_deg = [180, 0, 0] turns it over";
  const Triple middle{(mesh.facts.low[0] + mesh.facts.high[0]) / 2, 0, (mesh.facts.low[2] + mesh.facts.high[2]) / 2};
  if (heights_on_line(mesh.mesh, middle[0], middle[2]).empty())
    return "has no floor, as nothing lies on the upright line through its middle: close it below in a modeling program";
  return "has no hollow that is open above";
}

}  // namespace

bool is_cavity(const Room& room, const MeshFacts& facts) {
  const Triple size = facts.size();
  return room.volume > LEAST_CAVITY * size[0] * size[1] * size[2];
}

CavitySearch find_cavity(const CheckedMesh& mesh) {
  const RoomGrid grid(mesh.mesh, mesh.facts.low, mesh.facts.high, GRID_CELLS);
  const Rooms rooms = find_rooms(grid, UP);
  if (!rooms.largest || !is_cavity(*rooms.largest, mesh.facts)) return {{}, reason_for_none(mesh, grid, rooms)};
  return CavityFinder(mesh, grid, *rooms.largest).find();
}

}  // namespace wholehand
