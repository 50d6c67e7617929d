// SPDX-License-Identifier: MIT
#include "evidence/trials/piece_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/meshes/mesh.h"
#include "core/vectors.h"
#include "evidence/trials/surface_bound.h"

namespace wholehand {
namespace {

constexpr double NO_LIMIT = std::numeric_limits<double>::infinity();

// A piece of the file with the distance to it.
struct FilePiece {
  CheckedMesh mesh;
  std::unique_ptr<MeshDistance> distance;  // refers to `mesh`
  ConvexHull hull;
};

[[noreturn]] void refuse_pieces(const VesselData& vessel, const std::string& file, const std::string& what) {
  throw usage_error(at_place(vessel.mesh->place, fmt::format("vessel '{}': {}: {}", vessel.name, file, what)));
}

constexpr const char* PIECES_REMEDY = "make convex parts of this mesh, as CoACD does, or remove the file";

Triple lowest_corner(const TriangleMesh& mesh) {
  Triple low{NO_LIMIT, NO_LIMIT, NO_LIMIT};
  for (const Corners& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], mesh.vertices[corner][k]);
  return low;
}

// The file's triangles where the mesh's own shift to the base moves them.
TriangleMesh read_in_frame(const VesselData& vessel, const std::string& file, const std::string& folder, const CheckedMesh& mesh) {
  MeshData data = *vessel.mesh;
  data.origin_at_base = false;
  Triple shift{};
  if (vessel.mesh->origin_at_base) {
    const Triple low = lowest_corner(read_mesh(data, folder));
    for (std::size_t k = 0; k < 3; ++k) shift[k] = mesh.facts.low[k] - low[k];
  }
  data.file = file;
  TriangleMesh read = read_mesh(data, folder);
  for (Triple& vertex : read.vertices)
    for (std::size_t k = 0; k < 3; ++k) vertex[k] += shift[k];
  return read;
}

// The triangles of each piece, in the order of the file. A piece ends where no edge of it is open: a convex body's surface is closed by its last
// triangle, and by none before.
std::vector<TriangleMesh> closed_runs(const TriangleMesh& mesh, bool& is_open) {
  std::map<Triple, std::uint32_t> places;
  std::vector<std::uint32_t> place;
  for (const Triple& vertex : mesh.vertices)
    place.push_back(places.try_emplace(vertex, static_cast<std::uint32_t>(places.size())).first->second);
  std::vector<TriangleMesh> runs;
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;
  TriangleMesh run;
  for (const Corners& triangle : mesh.triangles) {
    if (is_point_or_edge(mesh, triangle)) continue;
    const auto base = static_cast<std::uint32_t>(run.vertices.size());
    for (std::size_t k = 0; k < 3; ++k) {
      run.vertices.push_back(mesh.vertices[triangle[k]]);
      const std::pair<std::uint32_t, std::uint32_t> edge = std::minmax(place[triangle[k]], place[triangle[(k + 1) % 3]]);
      if (!open.erase(edge)) open.insert(edge);
    }
    run.triangles.push_back({base, base + 1, base + 2});
    if (!open.empty()) continue;
    runs.push_back(std::move(run));
    run = {};
  }
  is_open = !open.empty();
  return runs;
}

double box_distance(const MeshFacts& facts, const glm::dvec3& p) {
  glm::dvec3 outside(0);
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    outside[k] = std::max({0.0, facts.low[i] - p[k], p[k] - facts.high[i]});
  }
  return glm::length(outside);
}

// Bounds of a facet's distance outside all pieces: distances to one convex piece are largest at a corner.
FacetDistance facet_uncovered(const Facet& facet, const std::vector<FilePiece>& pieces) {
  const glm::dvec3 center = (facet[0] + facet[1] + facet[2]) / 3.0;
  double radius = 0;
  for (const glm::dvec3& corner : facet) radius = std::max(radius, glm::distance(corner, center));
  FacetDistance least{NO_LIMIT, NO_LIMIT};
  for (const FilePiece& piece : pieces) {
    if (box_distance(piece.mesh.facts, center) > std::min(least.at_center, least.most)) continue;
    double corners = 0;
    for (const glm::dvec3& corner : facet) corners = std::max(corners, piece.distance->signed_distance(to_triple(corner)));
    least.at_center = std::min(least.at_center, std::max(0.0, piece.distance->signed_distance(to_triple(center))));
    least.most = std::min(least.most, corners);
  }
  least.most = std::max(least.at_center, std::min(least.most, least.at_center + radius));
  return least;
}

std::vector<FilePiece> checked_pieces(const VesselData& vessel, const std::string& file, const std::vector<TriangleMesh>& runs) {
  std::vector<FilePiece> pieces(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    FilePiece& piece = pieces[k];
    const std::string name = fmt::format("piece {} of {}", k + 1, runs.size());
    piece.mesh = check_mesh(runs[k], at_place(vessel.mesh->place, file + ": " + name));
    piece.distance = std::make_unique<MeshDistance>(piece.mesh);
    const auto hull = convex_hull(piece.mesh.mesh.vertices);
    if (!hull) refuse_pieces(vessel, file, fmt::format("{} is flat; leave it out", name));
    piece.hull = *hull;
    const LargestDistance bulge = distance_outside(piece.hull, piece.mesh, *piece.distance, CONVEX_TOLERANCE, CONVEX_TOLERANCE);
    if (bulge.reached > CONVEX_TOLERANCE)
      refuse_pieces(vessel, file,
                    fmt::format("{} is not convex: its hull leaves it by {:.2f} mm or more; allowed: {:.2g} mm; {}", name,
                                1e3 * bulge.reached, 1e3 * CONVEX_TOLERANCE, PIECES_REMEDY));
  }
  return pieces;
}

}  // namespace

std::optional<std::string> piece_file_of(const MeshData& data, const std::string& folder) {
  for (const char* ending : {".obj", ".glb", ".gltf", ".stl", ".ply"}) {
    const std::string file = std::filesystem::path(data.file).replace_extension(std::string(".pieces") + ending).string();
    std::error_code none;
    if (std::filesystem::exists(std::filesystem::path(folder) / file, none)) return file;
  }
  return std::nullopt;
}

ConvexCover read_pieces(const VesselData& vessel, const std::string& file, const std::string& folder, const CheckedMesh& mesh,
                        const MeshDistance& body) {
  bool is_open = false;
  const std::vector<TriangleMesh> runs = closed_runs(read_in_frame(vessel, file, folder, mesh), is_open);
  if (is_open)
    refuse_pieces(vessel, file,
                  fmt::format("piece {} is not closed; write each piece as a closed body, one after the other", runs.size() + 1));
  if (runs.size() > MOST_FILE_PIECES)
    refuse_pieces(vessel, file,
                  fmt::format("has {}; allowed: {}", counted(runs.size(), "piece"), readable_number(MOST_FILE_PIECES)));
  const std::vector<FilePiece> pieces = checked_pieces(vessel, file, runs);
  ConvexCover cover;
  for (const FilePiece& piece : pieces) {
    const LargestDistance outside = distance_outside(piece.hull, mesh, body, MOST_PIECE_ERROR, NO_LIMIT);
    cover.error = std::max(cover.error, outside.most);
    cover.pieces.push_back(piece.hull);
  }
  if (cover.error > MOST_PIECE_ERROR)
    refuse_pieces(vessel, file,
                  fmt::format("its pieces reach {:.2f} mm out of the mesh; allowed: {:.2g} mm; {}", 1e3 * cover.error,
                              1e3 * MOST_PIECE_ERROR, PIECES_REMEDY));
  std::vector<Facet> skin;
  for (std::uint32_t t = 0; t < mesh.mesh.triangles.size(); ++t) skin.push_back(facet_of(mesh.mesh, t));
  const LargestDistance bare = largest_distance(
      skin, [&](const Facet& facet) { return facet_uncovered(facet, pieces); }, MOST_PIECE_ERROR, NO_LIMIT);
  if (bare.most > MOST_PIECE_ERROR)
    refuse_pieces(vessel, file,
                  fmt::format("the mesh reaches {:.2f} mm out of its pieces at ({:.1f}, {:.1f}, {:.1f}) mm; allowed: {:.2g} mm; {}",
                              1e3 * bare.most, 1e3 * bare.place.x, 1e3 * bare.place.y, 1e3 * bare.place.z, 1e3 * MOST_PIECE_ERROR,
                              PIECES_REMEDY));
  cover.error = std::max(cover.error, bare.most);
  return cover;
}

}  // namespace wholehand
