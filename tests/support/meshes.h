// SPDX-License-Identifier: MIT
// Bodies of triangles whose distance is known, and glTF files of them.
#pragma once

#include <string>
#include <vector>

#include "core/mesh_body.h"
#include "core/meshes/mesh.h"
#include "core/scene.h"

namespace wholehand {

// A sphere about the origin with outward faces; m. Each level has four times the triangles of the one before: 20 at level 0.
TriangleMesh icosphere(double radius, int level);
// About the y axis.
TriangleMesh torus(double large_radius, double small_radius, int around, int across);
TriangleMesh box_mesh(const Triple& low, const Triple& high);
// A vessel's outline, mouth included, turned about the y axis in `around` steps, arcs in chords of `chord` m at most.
TriangleMesh turned_mesh(const VesselData& vessel, int around, double chord);
// The upper half of a sphere without its base: open.
TriangleMesh open_hemisphere(double radius, int level);
// The same with a rim that goes up and down by `wave` m twice around: no plane holds it.
TriangleMesh wavy_bowl(double radius, int level, double wave);

// Turned by Rx Ry Rz (rad), then moved.
TriangleMesh placed_mesh(TriangleMesh mesh, const Triple& turn, const Triple& move);
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b);
// Adds a grid of points, rows x columns, closed in the columns: two triangles a field, those without area left out.
void add_fields(TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& rows);

// A vessel with that mesh as its body, checked as a file's would be, with a lattice of this spacing (m; 0: none).
VesselData vessel_of_mesh(const std::string& name, const TriangleMesh& mesh, double spacing);
// What drawings need of it.
MeshBody body_of(const TriangleMesh& mesh);

// A .glb of one mesh: 32-bit floats and 32-bit indices.
std::string glb_text(const TriangleMesh& mesh);
// A .glb of this JSON and these bytes.
std::string glb_text(std::string json, std::string binary);

// Other formats of the same triangles: single precision, or as many digits as that has.
std::string stl_text(const TriangleMesh& mesh);  // binary
std::string ascii_stl_text(const TriangleMesh& mesh);
std::string obj_text(const TriangleMesh& mesh);
enum class PlyWriting { ascii, little_endian, big_endian };
std::string ply_text(const TriangleMesh& mesh, PlyWriting writing);
std::string off_text(const TriangleMesh& mesh);
std::string collada_text(const TriangleMesh& mesh, double meters = 1, const std::string& up = "Y_UP");
// A Collada file of this asset, these geometries and this inside of its visual scene.
std::string collada_text(const std::string& asset, const std::string& geometries, const std::string& nodes);
// A geometry named "body"; `polygons`: <triangles> and the like, whose VERTEX is "#body-points".
std::string collada_geometry(const std::vector<Triple>& points, const std::string& polygons);

}  // namespace wholehand
