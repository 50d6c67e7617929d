// SPDX-License-Identifier: MIT
#include "core/meshes/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/meshes/distance.h"
#include "core/meshes/hints.h"
#include "core/meshes/mesh.h"
#include "core/meshes/sheet.h"
#include "core/meshes/vessel.h"
#include "core/prepare.h"
#include "core/reader/ranges.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr int COARSE_CELLS = 64;           // of the grid on which directions and parts are compared
constexpr double FAR_SMALLER_PART = 0.2;   // of the largest part's box, across
constexpr std::size_t MOST_TRIED = 64;     // parts that may reach into the vessel's walls
constexpr std::size_t MOST_COMPARED = 16;  // parts in which a cavity is sought
constexpr double AS_LARGE = 0.95;          // of a cavity: what leaves it so large is no contents
constexpr double WRITTEN = 1e-6;           // m: lengths in a scene are written to that

// Directions, the likeliest first: of equal rooms the first one counts.
constexpr std::array<AxisDirection, 6> DIRECTIONS{{{1, true}, {2, true}, {0, true}, {0, false}, {2, false}, {1, false}}};

Side side_of(const AxisDirection& up) { return static_cast<Side>(2 * up.axis + (up.is_positive ? 1 : 0)); }

// The keys that turn a direction up: docs/mesh.md, "Frames".
void raise(const AxisDirection& direction, MeshData& data) {
  if (direction.axis == 2 && direction.is_positive)
    data.z_is_up = data.says_up = true;
  else if (direction.axis == 2)
    data.rotate = {radians(90), 0, 0};
  else if (direction.axis == 0)
    data.rotate = {0, 0, direction.is_positive ? radians(90) : radians(-90)};
  else if (!direction.is_positive)
    data.rotate = {radians(180), 0, 0};
}

// The largest room of a mesh that is open to one of the directions.
struct OpenRoom {
  AxisDirection up;
  double volume = 0;
  Triple middle{};  // mean of its points
};

Triple middle_of(const RoomGrid& grid, const std::vector<std::size_t>& points) {
  Triple middle{};
  for (const std::size_t point : points)
    for (int k = 0; k < 3; ++k) middle[k] += grid.position(point)[k] / static_cast<double>(points.size());
  return middle;
}

OpenRoom largest_room(const CheckedMesh& mesh, std::span<const AxisDirection> directions) {
  constexpr double CLEARLY_LARGER = 1.01;
  const RoomGrid grid(mesh.mesh, mesh.facts.low, mesh.facts.high, COARSE_CELLS);
  OpenRoom best;
  for (const AxisDirection& up : directions) {
    const Rooms rooms = find_rooms(grid, up);
    if (rooms.largest && is_cavity(*rooms.largest, mesh.facts) && rooms.largest->volume > CLEARLY_LARGER * best.volume)
      best = {up, rooms.largest->volume, middle_of(grid, points_of(grid, *rooms.largest, up))};
  }
  return best;
}

// Whether more rays from a point to all sides meet the mesh an odd number of times than an even one.
bool leaves_by_one_surface(const TriangleMesh& mesh, const Triple& from) {
  constexpr int RAYS = 32;
  int odd = 0, even = 0;
  for (int ray = 0; ray < RAYS; ++ray) {
    // points of a spiral on the sphere, evenly spread
    const double y = 1 - (2 * ray + 1.0) / RAYS, r = std::sqrt(1 - y * y), azimuth = ray * PI * (3 - std::sqrt(5));
    const glm::dvec3 start = to_vec3(from), along(r * std::cos(azimuth), y, r * std::sin(azimuth));
    int crossings = 0;
    for (const Corners& triangle : mesh.triangles) {
      const auto at = [&](int k) { return to_vec3(mesh.vertices[triangle[k]]) - start; };
      const glm::dvec3 a = at(0), b = at(1), c = at(2);
      const double bc = glm::dot(along, glm::cross(b, c)), ca = glm::dot(along, glm::cross(c, a)),
                   ab = glm::dot(along, glm::cross(a, b));
      const bool is_through = (bc > 0 && ca > 0 && ab > 0) || (bc < 0 && ca < 0 && ab < 0);
      crossings += is_through && glm::dot(a, glm::cross(b, c)) / (bc + ca + ab) > 0 ? 1 : 0;
    }
    if (crossings > 0) ++(crossings % 2 == 1 ? odd : even);
  }
  return odd > even;
}

class Survey {
 public:
  explicit Survey(const SurveyRequest& request) : request_(request), file_{request.file, ""} {
    found_.data.file = request.file;
    std::sort(request_.parts.begin(), request_.parts.end());
    request_.parts.erase(std::unique(request_.parts.begin(), request_.parts.end()), request_.parts.end());
    if (request.z_is_up) {
      directions_ = {AxisDirection{*request.z_is_up ? 2 : 1, true}};
    } else {
      directions_.assign(DIRECTIONS.begin(), DIRECTIONS.end());
    }
  }

  MeshSurvey survey() {
    raw_ = read_triangles(file_);
    checked_ = check_mesh(raw_, request_.file);
    choose_parts();
    choose_unit();
    choose_walls();
    choose_up();
    stand_up();
    forecast_lattice();
    return std::move(found_);
  }

 private:
  // The part with the largest cavity, and those that reach into its walls and leave the cavity as large; all, if only together they have one.
  void choose_parts() {
    const MeshParts parts = find_parts(checked_.mesh);
    found_.parts = parts.parts;
    if (!request_.parts.empty()) return keep_parts(request_.parts);
    const int count = static_cast<int>(parts.parts.size());
    if (count < 2) return;
    const VesselPart found = find_vessel_part(parts);
    const int vessel = found.number;
    if ((vessel == 0 || found.is_open) && closed_with_cavity()) {
      found_.reasons.parts = "all are taken, as closing their holes leaves a cavity";
      return;
    }
    if (vessel == 0) {
      found_.reasons.parts = "all are taken, as none alone has a cavity";
      return;
    }
    const std::vector<int> taken = with_what_reaches_in(parts, found);
    const int left = count - static_cast<int>(taken.size());
    if (left == 0) {
      found_.reasons.parts = fmt::format("all are taken, as they reach into the walls of part {}", vessel);
      return;
    }
    found_.reasons.parts = fmt::format("part {} has the largest cavity{}; {} left out{}", vessel,
                                       taken.size() > 1 ? ", and the others reach into its walls" : "",
                                       left == 1 ? "1 part is" : fmt::format("{} parts are", readable_number(left)), found.others);
    keep_parts(taken);
  }

  struct PartRoom {
    double volume = 0;  // of the largest room, in the file's unit
    bool is_open = false;
  };
  // The part with the largest cavity.
  struct VesselPart {
    int number = 0;  // 0: none
    double volume = 0;
    bool is_open = false;
    std::string others;  // words about the others that have one
  };

  VesselPart find_vessel_part(const MeshParts& parts) const {
    VesselPart found;
    std::vector<int> with_cavity;
    for (int number = 1; number <= static_cast<int>(std::min(parts.parts.size(), MOST_COMPARED)); ++number) {
      const PartRoom room = is_far_smaller(parts, number) ? PartRoom{} : room_of(parts, {number});
      if (room.volume > 0) with_cavity.push_back(number);
      if (room.volume > found.volume) found = {number, room.volume, room.is_open, ""};
    }
    for (const int number : with_cavity)
      if (number != found.number)
        found.others += fmt::format("{}{}", found.others.empty() ? ", though it has a cavity too: part " : ", ", number);
    return found;
  }

  // The largest parts alone are tried: crumbs are no handles.
  std::vector<int> with_what_reaches_in(const MeshParts& parts, const VesselPart& vessel) const {
    std::vector<int> taken{vessel.number};
    for (int number = 1; number <= static_cast<int>(std::min(parts.parts.size(), MOST_TRIED)); ++number) {
      if (number == vessel.number || !reaches_into(checked_.mesh, parts, number, vessel.number)) continue;
      std::vector<int> with = taken;
      with.push_back(number);
      // what fills the cavity is its contents
      if (taken.size() >= MOST_COMPARED || room_of(parts, with).volume > AS_LARGE * vessel.volume) taken = with;
    }
    std::sort(taken.begin(), taken.end());
    return taken;
  }

  void keep_parts(const std::vector<int>& numbers) {
    found_.data.parts = numbers;
    take_parts(raw_, numbers, file_);
    checked_ = check_mesh(raw_, request_.file);
  }

  static bool is_far_smaller(const MeshParts& parts, int number) {
    const auto size_of = [](const MeshPart& part) { return distance(part.high, part.low); };
    return size_of(parts.parts[static_cast<std::size_t>(number - 1)]) < FAR_SMALLER_PART * size_of(parts.parts[0]);
  }

  // The largest room of some parts together; none if they are no body.
  PartRoom room_of(const MeshParts& parts, const std::vector<int>& numbers) const {
    try {
      const CheckedMesh alone = check_mesh(parts_alone(checked_.mesh, parts, numbers), request_.file);
      return {largest_room(alone, directions_).volume, alone.facts.open_edges > 0};
    } catch (const Error&) {
      return {};
    }
  }

  // The mesh with its holes closed, if that leaves a cavity.
  std::optional<CheckedMesh> closed_with_cavity() const {
    if (checked_.facts.open_edges == 0 || !checked_.facts.closable) return std::nullopt;
    CheckedMesh closed = check_mesh(raw_, request_.file, true);
    return largest_room(closed, directions_).volume > 0 ? std::optional(std::move(closed)) : std::nullopt;
  }

  void choose_unit() {
    const Triple numbers = checked_.facts.size();
    const double largest = *std::max_element(numbers.begin(), numbers.end());
    const std::vector<LengthUnit> units = graspable_units(numbers);
    const auto is_meters = [](const LengthUnit& unit) { return unit.meters == 1; };
    if (request_.scale) {
      found_.data.scale = *request_.scale;
      const double scale = *request_.scale;
      found_.reasons.unit = mesh_size_hint({scale * numbers[0], scale * numbers[1], scale * numbers[2]}, scale).text;
    } else if (raw_.says_what_is_up && std::any_of(units.begin(), units.end(), is_meters)) {
      found_.reasons.unit = "meters, as its format counts, which make it " + size_text(largest);
    } else if (units.empty()) {
      const LengthUnit unit = nearest_unit(numbers);
      found_.data.scale = unit.meters;
      found_.reasons.unit = fmt::format("{}, which make it {}; no unit makes it fit a hand, and this one is the nearest", unit.name,
                                        size_text(unit.meters * largest));
    } else {
      found_.data.scale = units[0].meters;
      found_.reasons.unit = fmt::format("{}, which make it {}", units[0].name, size_text(units[0].meters * largest));
      for (std::size_t k = 1; k < units.size(); ++k)
        found_.reasons.unit +=
            fmt::format("{} {} would make it {}", k == 1 ? ";" : " and", units[k].name, size_text(units[k].meters * largest));
    }
    apply_scale();
  }

  static std::string size_text(double length) { return fmt::format("{} mm large", plain_text(1e3 * length, 4)); }

  // From here on meshes are in m.
  void apply_scale() {
    const double scale = found_.data.scale;
    for (TriangleMesh* mesh : {&raw_, &checked_.mesh})
      for (Triple& vertex : mesh->vertices)
        for (double& coordinate : vertex) coordinate *= scale;
    MeshFacts& facts = checked_.facts;
    facts.area *= scale * scale;
    facts.volume *= scale * scale * scale;
    for (double* length : {&facts.widest_hole, &facts.widest_open_hole, &facts.widest_closed_hole}) *length *= scale;
    for (Triple* point : {&facts.low, &facts.high, &facts.center_of_mass})
      for (double& coordinate : *point) coordinate *= scale;
  }

  // An open mesh whose holes close to a body with a cavity has lost pieces of its walls. One that holds liquid as it is, is a sheet if most rays
  // from the middle of that room leave through one surface; those through a wall leave through two.
  void choose_walls() {
    if (request_.thickness) return give_thickness(*request_.thickness);
    if (checked_.facts.open_edges == 0) return;
    if (std::optional<CheckedMesh> closed = closed_with_cavity()) {
      checked_ = std::move(*closed);
      found_.data.close_holes = true;
      found_.reasons.holes =
          fmt::format("close_holes = true, as closing {}, up to {} mm across, leaves a cavity",
                      counted(checked_.facts.closed_holes, "hole"), plain_text(1e3 * checked_.facts.widest_closed_hole, 4));
      return;
    }
    const OpenRoom room = largest_room(checked_, directions_);
    if (!(room.volume > 0 && leaves_by_one_surface(checked_.mesh, room.middle))) return;
    found_.reasons.holes = fmt::format("the mesh is a sheet without thickness; {} mm is assumed, and thickness_mm sets another",
                                       plain_text(1e3 * SUPPOSED_THICKNESS, 4));
    give_thickness(SUPPOSED_THICKNESS);
  }

  void give_thickness(double thickness) {
    found_.data.thickness = thickness;
    checked_ = thickened(checked_, thickness, request_.file);
  }

  void choose_up() {
    if (request_.z_is_up) {
      found_.data.z_is_up = *request_.z_is_up;
      found_.data.says_up = true;
      return;
    }
    if (raw_.says_what_is_up && largest_room(checked_, std::span(DIRECTIONS).first(1)).volume > 0) {
      found_.reasons.up = "+y, as in its format, and a hollow opens there";
    } else if (const OpenRoom room = largest_room(checked_, directions_); room.volume > 0) {
      raise(room.up, found_.data);
      found_.reasons.up = fmt::format("{}, as its largest hollow opens there", side_name(side_of(room.up)));
    } else if (const std::optional<Side> open = raw_.says_what_is_up ? std::nullopt : open_side(checked_.mesh, checked_.facts)) {
      const int number = static_cast<int>(*open);
      raise({number / 2, number % 2 == 1}, found_.data);
      found_.reasons.up = fmt::format("{}, the only open side", side_name(*open));
    } else {
      found_.reasons.up =
          raw_.says_what_is_up ? "+y, as in its format" : "+y, as no single side opens; up = \"z\" if it lies on its side";
    }
  }

  // Turns the checked mesh as the scene will, and searches its cavity, whose axis becomes x = z = 0. The middle of the box needs no key for that.
  void stand_up() {
    MeshData turned = found_.data;
    turned.scale = 1;  // it has been applied
    turned.origin_at_base = false;
    checked_.mesh.vertices.push_back(checked_.facts.center_of_mass);
    place_mesh(checked_.mesh, turned, file_);
    checked_.facts.center_of_mass = checked_.mesh.vertices.back();
    checked_.mesh.vertices.pop_back();
    MeshFacts& facts = checked_.facts;
    facts.low = facts.high = checked_.mesh.vertices.front();
    for (const Triple& vertex : checked_.mesh.vertices)
      for (int k = 0; k < 3; ++k) {
        facts.low[k] = std::min(facts.low[k], vertex[k]);
        facts.high[k] = std::max(facts.high[k], vertex[k]);
      }
    const Triple base{(facts.low[0] + facts.high[0]) / 2, facts.low[1], (facts.low[2] + facts.high[2]) / 2};
    move(base);
    found_.cavity = find_cavity(checked_);
    if (found_.cavity.cavity) move_to_axis(base, found_.cavity.cavity->axis);
    found_.mesh = std::move(checked_);
  }

  void move_to_axis(const Triple& base, Triple& axis) {
    if (std::hypot(axis[0], axis[2]) < WRITTEN) {
      axis = {};
      return;
    }
    Triple origin{};
    for (const int k : {0, 2}) origin[k] = std::round((base[k] + axis[k]) / WRITTEN) * WRITTEN;
    origin[1] = base[1];
    move({origin[0] - base[0], 0, origin[2] - base[2]});
    axis = {};
    found_.data.origin_at_base = false;
    if (origin != Triple{}) found_.data.origin = origin;
  }

  void move(const Triple& origin) {
    const auto shift = [&](Triple& point) {
      for (int k = 0; k < 3; ++k) point[k] -= origin[k];
    };
    for (Triple& vertex : checked_.mesh.vertices) shift(vertex);
    for (Triple* point : {&checked_.facts.low, &checked_.facts.high, &checked_.facts.center_of_mass}) shift(*point);
  }

  void forecast_lattice() {
    struct Known {};  // ends the work once it is known how much it is
    LatticeSpec spec;
    spec.margin = lattice_margin(Scene{});
    spec.most_bytes = largest_lattice(std::numeric_limits<std::uint64_t>::max());
    const auto keep = [&](const LatticePlan& plan) {
      found_.lattice = plan;
      throw Known();
    };
    try {
      lattice_of_mesh(MeshDistance(found_.mesh), found_.mesh, spec, {}, {keep, {}, MOST_LATTICE_SECONDS});
    } catch (const Known&) {
    }
  }

  SurveyRequest request_;
  MeshFile file_;
  TriangleMesh raw_;
  CheckedMesh checked_;
  std::vector<AxisDirection> directions_;
  MeshSurvey found_;
};

void check_range(double value, const Quantity& range, const char* name, const char* unit) {
  if (!(value >= range.low && value <= range.high))
    throw usage_error(
        fmt::format("{} = {}; allowed: {} to {}{}", name, plain_text(value), plain_text(range.low), plain_text(range.high), unit));
}

}  // namespace

MeshSurvey survey_mesh(const SurveyRequest& request) {
  if (request.scale) check_range(*request.scale, ranges::MESH_SCALE, "scale", " m");
  if (request.thickness) check_range(1e3 * *request.thickness, ranges::WALL, "thickness", " mm");
  for (const int part : request.parts)
    check_range(part, {static_cast<double>(ranges::PART.low), static_cast<double>(ranges::PART.high)}, "part", "");
  return Survey(request).survey();
}

}  // namespace wholehand
