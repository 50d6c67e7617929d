// SPDX-License-Identifier: MIT
#include "core/meshes/distance.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "base/text/error.h"
#include "core/meshes/winding_tree.h"
#include "core/vectors.h"

namespace wholehand {
// A ray's direction, exact in single precision, and two vectors across it.
struct RayFrame {
  glm::dvec3 along, u, v;
};

namespace {

// Embree's boxes and queries are in single precision. The boxes are enlarged by this share of the mesh's extent, and the queries' distances as much:
// anything that Embree skips is then farther, and anything that it finds is computed in double.
constexpr double SINGLE_SLACK = 0x1p-21;
constexpr double THIN = 1e-24;         // squared: of the sine of a corner
constexpr double FIRM = 1e-8;          // the same: from it on, rounding turns a triangle's normal by 1e-12 at most
constexpr double DISK_SLACK = 1e-10;   // of a squared distance: rounding of the squares in it, which is 1e-11 with such normals
constexpr double CLEARLY_OFF = 1e-14;  // of the squared distance: an edge seen from a point turns clearly to one side
constexpr double COARSE_OPENING = 2, FINE_OPENING = 8;  // of clusters: to 0.06, to 0.001
constexpr double WINDING_DOUBT = 0.06;

// The squared distance between a segment and a point, which lies at `from` as seen from the segment's start.
inline double segment_distance_squared(const glm::dvec3& from, const glm::dvec3& along) {
  const double squared = glm::dot(along, along);
  const double t = squared > 0 ? std::clamp(glm::dot(from, along) / squared, 0.0, 1.0) : 0;
  const glm::dvec3 off = from - t * along;
  return glm::dot(off, off);
}

// Squared distance to the plane if p is over the inside, else to the nearest of the sides beyond which p lies; to all three sides if the triangle is
// so thin that its plane is rounding.
double triangle_distance_squared(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, bc = c - b, ca = a - c, pa = p - a, pb = p - b, pc = p - c, normal = glm::cross(ca, ab);
  const double squared = glm::dot(normal, normal);
  const bool is_thin = squared <= THIN * glm::dot(ab, ab) * glm::dot(ca, ca);
  const bool beyond_ab = is_thin || glm::dot(glm::cross(normal, ab), pa) < 0,
             beyond_bc = is_thin || glm::dot(glm::cross(normal, bc), pb) < 0,
             beyond_ca = is_thin || glm::dot(glm::cross(normal, ca), pc) < 0;
  if (!beyond_ab && !beyond_bc && !beyond_ca) {
    const double height = glm::dot(pa, normal);
    return height * height / squared;
  }
  double nearest = std::numeric_limits<double>::infinity();
  if (beyond_ab) nearest = segment_distance_squared(pa, ab);
  if (beyond_bc) nearest = std::min(nearest, segment_distance_squared(pb, bc));
  if (beyond_ca) nearest = std::min(nearest, segment_distance_squared(pc, ca));
  return nearest;
}

// A disk in a triangle's plane that contains it: about the mean of its corners. It is soon known to be too far away, as most
// triangles are that a search comes by.
struct TriangleDisk {
  glm::dvec3 middle, normal;  // the normal has length 1; 0 for a thin triangle, which makes a ball of the disk
  double radius;
};

TriangleDisk disk_about(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 middle = (a + b + c) / 3.0, normal = glm::cross(b - a, c - a);
  const double squared = glm::dot(normal, normal), sides = glm::dot(b - a, b - a) * glm::dot(c - a, c - a);
  const double radius = std::max({glm::length(a - middle), glm::length(b - middle), glm::length(c - middle)});
  return {middle, squared > FIRM * sides ? normal / std::sqrt(squared) : glm::dvec3(0), radius};
}

// Whether the disk is farther from p than the square root of `squared`, even after rounding.
bool is_beyond(const TriangleDisk& disk, const glm::dvec3& p, double squared) {
  const glm::dvec3 from = p - disk.middle;
  const double away = glm::dot(from, from), height = glm::dot(from, disk.normal);
  const double room = squared - height * height + DISK_SLACK * away;  // for the square of the way along the plane
  if (room < 0) return true;
  const double reach = disk.radius + std::sqrt(room);
  return away * (1 - DISK_SLACK) > height * height + reach * reach;
}

RayFrame frame_along(float x, float y, float z) {
  const glm::dvec3 along(x, y, z), u = glm::normalize(glm::cross(along, glm::dvec3(0.3, -0.5, 0.8)));
  return {along, u, glm::normalize(glm::cross(along, u))};
}

// None lies along an axis or a diagonal, as edges and faces often do.
const std::array<RayFrame, 8>& ray_frames() {
  static const std::array<RayFrame, 8> FRAMES{frame_along(0.86F, 0.37F, 0.35F),   frame_along(-0.41F, 0.83F, 0.37F),
                                              frame_along(0.29F, -0.43F, 0.85F),  frame_along(-0.67F, -0.61F, 0.42F),
                                              frame_along(0.53F, 0.19F, -0.82F),  frame_along(-0.23F, 0.71F, -0.66F),
                                              frame_along(0.13F, -0.93F, -0.34F), frame_along(-0.77F, -0.17F, -0.61F)};
  return FRAMES;
}

std::string embree_error(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return "";
  return code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", static_cast<int>(code));
}

}  // namespace

struct MeshDistance::Parts {
  explicit Parts(const CheckedMesh& checked);
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  glm::dvec3 corner(unsigned triangle, int k) const { return to_vec3(mesh.vertices[mesh.triangles[triangle][k]]); }
  double distance_squared(unsigned triangle, const glm::dvec3& p) const {
    return triangle_distance_squared(p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
  }
  void build();

  const TriangleMesh& mesh;
  std::vector<TriangleDisk> disks;  // of the triangles
  MeshSign sign;
  glm::dvec3 center;  // Embree's origin, so that its rounding is that of the mesh's size
  double extent;      // from there to the farthest corner of the box
  std::optional<WindingTree> winding;
  std::optional<WindingRim> rim;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

namespace {

MeshSign sign_of(const MeshFacts& facts) {
  if (!facts.closed) return MeshSign::winding;
  return facts.oriented ? MeshSign::crossings : MeshSign::parity;
}

}  // namespace

// What the callbacks of a query know.
struct MeshQueries {
  using Parts = MeshDistance::Parts;

  struct Closest {
    const Parts& parts;
    glm::dvec3 p;
    double squared;
    double slack;
    std::uint32_t nearest;

    float radius() const { return static_cast<float>(std::sqrt(squared) * (1 + SINGLE_SLACK) + slack); }
  };

  struct Crossings {
    RTCIntersectContext context;  // first, so that Embree's pointer to it is one to this
    const Parts* parts;
    glm::dvec3 p;
    const RayFrame* frame;
    int outward;  // crossings from inside to outside less the others
    int all;
    bool doubtful;  // the ray meets an edge, to rounding
  };

  static void bounds(const RTCBoundsFunctionArguments* asked) {
    const Parts& parts = *static_cast<const Parts*>(asked->geometryUserPtr);
    const glm::dvec3 a = parts.corner(asked->primID, 0) - parts.center, b = parts.corner(asked->primID, 1) - parts.center,
                     c = parts.corner(asked->primID, 2) - parts.center;
    const glm::dvec3 low = glm::min(a, glm::min(b, c)) - SINGLE_SLACK * parts.extent,
                     high = glm::max(a, glm::max(b, c)) + SINGLE_SLACK * parts.extent;
    RTCBounds& box = *asked->bounds_o;
    box.lower_x = static_cast<float>(low.x);
    box.lower_y = static_cast<float>(low.y);
    box.lower_z = static_cast<float>(low.z);
    box.upper_x = static_cast<float>(high.x);
    box.upper_y = static_cast<float>(high.y);
    box.upper_z = static_cast<float>(high.z);
  }

  static bool closest(RTCPointQueryFunctionArguments* asked) {
    Closest& search = *static_cast<Closest*>(asked->userPtr);
    if (is_beyond(search.parts.disks[asked->primID], search.p, search.squared)) return false;
    const double squared = search.parts.distance_squared(asked->primID, search.p);
    if (!(squared < search.squared)) return false;
    search.squared = squared;
    search.nearest = asked->primID;
    asked->query->radius = search.radius();
    return true;
  }

  // Where the ray from p along the frame's direction meets the triangle: p is on one side of all three edges, seen along the ray.
  static void cross(const RTCIntersectFunctionNArguments* asked) {
    if (asked->N != 1 || asked->valid[0] == 0) return;
    Crossings& ray = *reinterpret_cast<Crossings*>(asked->context);
    const RayFrame& frame = *ray.frame;
    std::array<double, 3> u{}, v{}, along{};
    double away = 0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 corner = ray.parts->corner(asked->primID, k) - ray.p;
      u[k] = glm::dot(frame.u, corner);
      v[k] = glm::dot(frame.v, corner);
      along[k] = glm::dot(frame.along, corner);
      away = std::max(away, glm::dot(corner, corner));
    }
    const std::array<double, 3> turn{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double least = *std::min_element(turn.begin(), turn.end()), most = *std::max_element(turn.begin(), turn.end());
    const double off = CLEARLY_OFF * away;
    if (least < -off && most > off) return;                         // passes beside it
    if (*std::max_element(along.begin(), along.end()) < 0) return;  // it lies behind
    if (least <= off && most >= -off) {
      ray.doubtful = true;
      return;
    }
    const double height = turn[0] * along[0] + turn[1] * along[1] + turn[2] * along[2];
    if (height / (turn[0] + turn[1] + turn[2]) <= 0) return;
    ++ray.all;
    ray.outward += least > 0 ? 1 : -1;
  }
};

MeshDistance::Parts::Parts(const CheckedMesh& checked)
    : mesh(checked.mesh),
      sign(sign_of(checked.facts)),
      center((to_vec3(checked.facts.low) + to_vec3(checked.facts.high)) / 2.0),
      extent(glm::length(to_vec3(checked.facts.high) - center)) {
  disks.reserve(mesh.triangles.size());
  for (unsigned i = 0; i < mesh.triangles.size(); ++i) disks.push_back(disk_about(corner(i, 0), corner(i, 1), corner(i, 2)));
  if (sign == MeshSign::winding) {
    winding.emplace(mesh);
    rim.emplace(mesh);
  }
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw failure_error("Embree cannot be started: " + embree_error(nullptr));
  try {
    build();
  } catch (...) {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    throw;
  }
}

// Triangles are user geometry: Embree brings the boxes in order, and what is in them is measured here in double precision.
void MeshDistance::Parts::build() {
  scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, MeshQueries::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, MeshQueries::cross);
  rtcSetGeometryPointQueryFunction(geometry, MeshQueries::closest);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // a ray that grazes a box is in it
  rtcCommitScene(scene);
  const std::string error = embree_error(device);
  if (!error.empty()) throw failure_error("Embree cannot take the mesh: " + error);
}

MeshDistance::Parts::~Parts() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

MeshDistance::MeshDistance(const CheckedMesh& mesh) : parts_(std::make_unique<Parts>(mesh)) {}
MeshDistance::~MeshDistance() = default;

MeshSign MeshDistance::sign() const { return parts_->sign; }

double MeshDistance::distance(const Triple& p, std::uint32_t& nearest) const {
  const glm::dvec3 there = to_vec3(p) - parts_->center;
  const double slack = SINGLE_SLACK * (glm::length(there) + parts_->extent);
  MeshQueries::Closest search{*parts_, to_vec3(p), parts_->distance_squared(nearest, to_vec3(p)), slack, nearest};
  RTCPointQuery query{};
  query.x = static_cast<float>(there.x);
  query.y = static_cast<float>(there.y);
  query.z = static_cast<float>(there.z);
  query.radius = search.radius();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(parts_->scene, &query, &context, nullptr, &search);
  nearest = search.nearest;
  return std::sqrt(search.squared);
}

double MeshDistance::winding_number(const Triple& p) const {
  if (!parts_->winding) return is_inside(p) ? 1 : 0;
  return parts_->winding->winding_number(to_vec3(p), FINE_OPENING);
}

// A ray that passes too near an edge for a certain count is replaced by one in another direction. If all do, p lies on an edge, and either answer is
// fine.
bool MeshDistance::is_inside(const Triple& p) const {
  if (parts_->winding) return side(p).is_inside;
  const glm::dvec3 there = to_vec3(p) - parts_->center;
  bool inside = false;
  for (const RayFrame& frame : ray_frames()) {
    MeshQueries::Crossings ray{{}, parts_.get(), to_vec3(p), &frame, 0, 0, false};
    rtcInitIntersectContext(&ray.context);
    RTCRayHit hit{};
    hit.ray.org_x = static_cast<float>(there.x);
    hit.ray.org_y = static_cast<float>(there.y);
    hit.ray.org_z = static_cast<float>(there.z);
    hit.ray.dir_x = static_cast<float>(frame.along.x);
    hit.ray.dir_y = static_cast<float>(frame.along.y);
    hit.ray.dir_z = static_cast<float>(frame.along.z);
    hit.ray.tfar = std::numeric_limits<float>::infinity();
    hit.ray.mask = ~0u;
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(parts_->scene, &ray.context, &hit);
    inside = parts_->sign == MeshSign::crossings ? ray.outward != 0 : ray.all % 2 != 0;
    if (!ray.doubtful) break;
  }
  return inside;
}

MeshSide MeshDistance::side(const Triple& p) const {
  if (!parts_->winding) return {is_inside(p), std::numeric_limits<double>::infinity()};
  double winding = parts_->winding->winding_number(to_vec3(p), COARSE_OPENING);
  if (!(std::abs(winding - 0.5) > WINDING_DOUBT)) winding = winding_number(p);
  return {winding > 0.5, std::abs(winding - 0.5) - WINDING_DOUBT};
}

double MeshDistance::winding_slope(const Triple& p, double radius) const {
  return parts_->rim ? parts_->rim->slope(to_vec3(p), radius) : 0;
}

double MeshDistance::signed_distance(const Triple& p) const {
  std::uint32_t nearest = 0;
  const double away = distance(p, nearest);
  return is_inside(p) ? -away : away;
}

}  // namespace wholehand
