// SPDX-License-Identifier: MIT
#include "tests/support/meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/files/json.h"
#include "core/meshes/check.h"
#include "core/meshes/distance.h"
#include "core/meshes/lattice.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double TURN = 2 * std::numbers::pi;

using Corners = std::array<std::uint32_t, 3>;

class Subdivision {
 public:
  Subdivision(TriangleMesh mesh, double radius) : mesh_(std::move(mesh)), radius_(radius) {
    for (Triple& p : mesh_.vertices) p = on_sphere(p);
  }

  void refine() {
    std::vector<Corners> finer;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh_.vertices.size()));
      if (is_new) {
        const Triple p = mesh_.vertices[a], q = mesh_.vertices[b];
        mesh_.vertices.push_back(on_sphere({p[0] + q[0], p[1] + q[1], p[2] + q[2]}));
      }
      return place->second;
    };
    for (const auto& [a, b, c] : mesh_.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {Corners{a, ab, ca}, Corners{b, bc, ab}, Corners{c, ca, bc}, Corners{ab, bc, ca}});
    }
    mesh_.triangles = std::move(finer);
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  Triple on_sphere(const Triple& p) const {
    const double length = norm(p);
    return {radius_ * p[0] / length, radius_ * p[1] / length, radius_ * p[2] / length};
  }

  TriangleMesh mesh_;
  double radius_;
};

std::vector<std::array<double, 2>> outline_points(const VesselData& vessel, double chord) {
  std::vector<std::array<double, 2>> points{{0, 0}};
  for (const PreparedElement& e : prepare_vessel(vessel, false).hull) {
    double from = 0, sweep = 0;
    int steps = 1;
    if (e.side != 0) {
      from = std::atan2(e.a[1] - e.center[1], e.a[0] - e.center[0]);
      sweep = std::remainder(std::atan2(e.b[1] - e.center[1], e.b[0] - e.center[0]) - from, TURN);
      if (std::abs(std::abs(sweep) - TURN / 2) < 1e-9) sweep = (e.b[1] > e.a[1]) == (e.side > 0) ? TURN / 2 : -TURN / 2;
      steps = std::max(1, static_cast<int>(std::ceil(e.radius * std::abs(sweep) / chord)));
    }
    for (int i = 1; i < steps; ++i) {
      const double angle = from + sweep * i / steps;
      points.push_back({e.center[0] + e.radius * std::cos(angle), e.center[1] + e.radius * std::sin(angle)});
    }
    points.push_back(e.b);
  }
  return points;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void add_fields(TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& rows) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      const std::size_t next = (j + 1) % rows[i].size();
      add(rows[i][j], rows[i + 1][j], rows[i + 1][next]);
      add(rows[i][j], rows[i + 1][next], rows[i][next]);
    }
}

TriangleMesh icosphere(double radius, int level) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  Subdivision sphere(mesh, radius);
  for (int i = 0; i < level; ++i) sphere.refine();
  return sphere.take();
}

TriangleMesh open_hemisphere(double radius, int level) {
  TriangleMesh octant;
  octant.vertices = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  octant.triangles = {{1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}};
  Subdivision sphere(octant, radius);
  for (int i = 0; i < level; ++i) sphere.refine();
  return sphere.take();
}

TriangleMesh wavy_bowl(double radius, int level, double wave) {
  TriangleMesh bowl = open_hemisphere(radius, level);
  for (Triple& p : bowl.vertices)
    if (p[1] == 0) p[1] = wave * std::cos(2 * std::atan2(p[2], p[0]));
  return bowl;
}

TriangleMesh torus(double large_radius, double small_radius, int around, int across) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows(across + 1);
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < around; ++j) {
      const double a = TURN * i / across, b = TURN * j / around, r = large_radius + small_radius * std::cos(a);
      rows[i].push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back({r * std::sin(b), small_radius * std::sin(a), r * std::cos(b)});
    }
  rows[across] = rows[0];
  add_fields(mesh, rows);
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

TriangleMesh box_mesh(const Triple& low, const Triple& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({(i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh turned_mesh(const VesselData& vessel, int around, double chord) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  for (const auto& [r, y] : outline_points(vessel, chord)) {
    std::vector<std::uint32_t>& row = rows.emplace_back();
    const bool on_axis = r < 1e-12;
    for (int j = 0; j < around; ++j) {
      if (j == 0 || !on_axis) mesh.vertices.push_back({r * std::sin(TURN * j / around), y, r * std::cos(TURN * j / around)});
      row.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  add_fields(mesh, rows);
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

TriangleMesh placed_mesh(TriangleMesh mesh, const Triple& turn, const Triple& move) {
  const LongRotation rotation = rotation_x(turn[0]) * rotation_y(turn[1]) * rotation_z(turn[2]);
  for (Triple& p : mesh.vertices) {
    const Long3 turned = rotation * Long3{p[0], p[1], p[2]};
    for (int k = 0; k < 3; ++k) p[k] = static_cast<double>(turned[k] + move[k]);
  }
  return mesh;
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto base = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({base + i, base + j, base + k});
  return a;
}

MeshBody body_of(const TriangleMesh& mesh) {
  const CheckedMesh checked = check_mesh(mesh, "body");
  MeshBody body;
  body.vertices = checked.mesh.vertices;
  body.triangles = checked.mesh.triangles;
  body.facts = checked.facts;
  body.volume = checked.facts.volume;
  body.center_of_mass = checked.facts.center_of_mass;
  return body;
}

VesselData vessel_of_mesh(const std::string& name, const TriangleMesh& mesh, double spacing) {
  auto body = std::make_shared<MeshBody>(body_of(mesh));
  if (spacing > 0) {
    const CheckedMesh checked = check_mesh(mesh, name);
    LatticeSpec spec;
    spec.spacing = spacing;
    spec.margin = lattice_margin(Scene());
    const MeshLattice made = lattice_of_mesh(MeshDistance(checked), checked, spec);
    body->lattice = made.lattice;
    body->lattice_error = made.error;
  }
  VesselData vessel;
  vessel.name = name;
  vessel.mesh.emplace();
  vessel.mesh->file = name + ".glb";
  vessel.base = body->facts.low[1];
  vessel.height = body->facts.high[1];
  vessel.mesh->body = std::move(body);
  return vessel;
}

std::string glb_text(std::string json, std::string binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  binary.append((4 - binary.size() % 4) % 4, '\0');
  std::string bytes = "glTF";
  append<std::uint32_t>(bytes, 2);
  append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size())));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  if (binary.empty()) return bytes;
  append(bytes, static_cast<std::uint32_t>(binary.size()));
  bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

std::string glb_text(const TriangleMesh& mesh) {
  std::string binary;
  for (const Triple& p : mesh.vertices)
    for (const double x : p) append(binary, static_cast<float>(x));
  const std::size_t positions = binary.size();
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) append(binary, i);
  const nlohmann::json json{
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", mesh.vertices.size()}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5125}, {"count", 3 * mesh.triangles.size()}, {"type", "SCALAR"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", positions}},
        {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", binary.size() - positions}}}},
      {"buffers", {{{"byteLength", binary.size()}}}}};
  return glb_text(json_text(json), binary);
}

std::string stl_text(const TriangleMesh& mesh) {
  std::string bytes = "solid body: some writers of binary files begin so";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t i : triangle)
      for (const double x : mesh.vertices[i]) append(bytes, static_cast<float>(x));
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ascii_stl_text(const TriangleMesh& mesh) {
  std::string text = "solid facet of a mesh\r\n";
  for (const auto& triangle : mesh.triangles) {
    text += "  facet normal 0 nan 0\r\n    outer loop\r\n";
    for (const std::uint32_t i : triangle) {
      const Triple& p = mesh.vertices[i];
      text += fmt::format("      vertex {:.9g} {:.9g} {:.9g}\r\n", p[0], p[1], p[2]);
    }
    text += "    endloop\r\n  endfacet\r\n";
  }
  return text + "endsolid facet of a mesh\r\n";
}

std::string obj_text(const TriangleMesh& mesh) {
  std::string text = "# a mesh\nmtllib other.mtl\no body\n";
  for (const Triple& p : mesh.vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\nvn 0 0 1\n", p[0], p[1], p[2]);
  text += "usemtl red\n";
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", a + 1, b + 1, c + 1);
  return text;
}

std::string ply_text(const TriangleMesh& mesh, PlyWriting writing) {
  const bool is_ascii = writing == PlyWriting::ascii;
  std::string body;
  const auto put = [&](auto value) {
    if (is_ascii) {
      body += fmt::format("{:.9g} ", static_cast<double>(value));
      return;
    }
    std::string bytes;
    append(bytes, value);
    if (writing == PlyWriting::big_endian) std::reverse(bytes.begin(), bytes.end());
    body += bytes;
  };
  for (const Triple& p : mesh.vertices) {
    put(std::uint8_t{10});  // a color, and an end of line where the header ends
    for (const double x : p) put(static_cast<float>(x));
    if (is_ascii) body += "\n";
  }
  for (const auto& triangle : mesh.triangles) {
    put(std::uint8_t{3});
    for (const std::uint32_t i : triangle) put(static_cast<std::int32_t>(i));
    put(std::int16_t{-1});
    if (is_ascii) body += "\n";
  }
  return fmt::format(
             "ply\nformat {} 1.0\ncomment TextureFile other.png\nelement vertex {}\nproperty uchar red\nproperty float x\nproperty "
             "float "
             "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nproperty short flags\nend_header\n",
             is_ascii                            ? "ascii"
             : writing == PlyWriting::big_endian ? "binary_big_endian"
                                                 : "binary_little_endian",
             mesh.vertices.size(), mesh.triangles.size()) +
         body;
}

std::string off_text(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n# a mesh\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Triple& p : mesh.vertices) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {} 255 0 0\n", a, b, c);
  return text;
}

std::string collada_text(const std::string& asset, const std::string& geometries, const std::string& nodes) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">\n<asset>" +
         asset + "</asset>\n<library_geometries>" + geometries +
         "</library_geometries>\n<library_visual_scenes><visual_scene id=\"shown\">" + nodes +
         "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url=\"#shown\"/></scene>\n</COLLADA>\n";
}

std::string collada_geometry(const std::vector<Triple>& points, const std::string& polygons) {
  std::string numbers;
  for (const Triple& p : points) numbers += fmt::format("{:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
  return fmt::format(
      "<geometry id=\"body\"><mesh>\n<source id=\"body-source\"><float_array id=\"body-array\" count=\"{}\">{}</float_array>\n"
      "<technique_common><accessor source=\"#body-array\" count=\"{}\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
      "name=\"Y\" "
      "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n<vertices "
      "id=\"body-points\"><input "
      "semantic=\"POSITION\" source=\"#body-source\"/></vertices>\n{}</mesh></geometry>",
      3 * points.size(), numbers, points.size(), polygons);
}

std::string collada_text(const TriangleMesh& mesh, double meters, const std::string& up) {
  std::string corners;  // each with a place in a texture before it
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) corners += fmt::format("0 {} ", corner);
  return collada_text(
      fmt::format("<unit name=\"unit\" meter=\"{}\"/><up_axis>{}</up_axis>", meters, up),
      collada_geometry(mesh.vertices,
                       fmt::format("<triangles count=\"{}\"><input semantic=\"TEXCOORD\" source=\"#none\" offset=\"0\"/><input "
                                   "semantic=\"VERTEX\" source=\"#body-points\" offset=\"1\"/><p>{}</p></triangles>",
                                   mesh.triangles.size(), corners)),
      "<node><instance_geometry url=\"#body\"/></node>");
}

}  // namespace wholehand
