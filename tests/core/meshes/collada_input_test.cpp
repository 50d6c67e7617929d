// SPDX-License-Identifier: MIT
// Collada files: which geometries are shown, and where their nodes, their unit and their up axis put them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/meshes/check.h"
#include "tests/support/gltf_making.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

constexpr double COLLADA_ROUNDING = 1e-6;  // single precision of numbers up to 10, read from decimal text

// Legs of 1, 2 and 3 along the axes; volume 1.
TriangleMesh leg_mesh() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TriangleMesh read_collada(const std::string& text) { return read_mesh(mesh_as_is(write_gltf("a.dae", text)), ""); }

std::string collada_refusal(const std::string& text) { return mesh_refusal(mesh_as_is(write_gltf("bad.dae", text))); }

const char* const LEG_TRIANGLES =
    "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#body-points\" offset=\"0\"/><p>0 2 1 0 1 3 0 3 2 1 2 "
    "3</p></triangles>";

// The legs, with something else in the scene.
std::string legs_with_nodes(const std::string& nodes) {
  return collada_text("", collada_geometry(leg_mesh().vertices, LEG_TRIANGLES), nodes);
}

std::string legs_with_polygons(const std::string& polygons) {
  return collada_text("", collada_geometry(leg_mesh().vertices, polygons), "<node><instance_geometry url=\"#body\"/></node>");
}

void expect_has_vertex(const TriangleMesh& mesh, const Triple& wanted) {
  double nearest = 1;
  for (const Triple& vertex : mesh.vertices)
    nearest = std::min(nearest, std::hypot(vertex[0] - wanted[0], vertex[1] - wanted[1], vertex[2] - wanted[2]));
  EXPECT_LT(nearest, COLLADA_ROUNDING) << wanted[0] << " " << wanted[1] << " " << wanted[2];
}

TEST(MeshCollada, UnitAndUpAxisAreThoseOfTheVesselFrame) {
  const TriangleMesh as_is = read_collada(collada_text(leg_mesh()));
  expect_has_vertex(as_is, {1, 0, 0});
  expect_has_vertex(as_is, {0, 0, 3});
  EXPECT_TRUE(as_is.says_what_is_up);
  const TriangleMesh z_up = read_collada(collada_text(leg_mesh(), 0.01, "Z_UP"));
  expect_has_vertex(z_up, {0.01, 0, 0});
  expect_has_vertex(z_up, {0, 0, -0.02});
  expect_has_vertex(z_up, {0, 0.03, 0});
  EXPECT_NEAR(mesh_volume(z_up), 1e-6, 1e-12);
  const TriangleMesh x_up = read_collada(collada_text(leg_mesh(), 0.0254, " X_UP\n"));
  expect_has_vertex(x_up, {0, 0.0254, 0});
  expect_has_vertex(x_up, {-0.0508, 0, 0});
  expect_has_vertex(x_up, {0, 0, 0.0762});
  EXPECT_NEAR(mesh_volume(x_up), 0.0254 * 0.0254 * 0.0254, 1e-10);
}

TEST(MeshCollada, NodesPlaceTheirGeometries) {
  const std::string shown = "<instance_geometry url=\"#body\"/>";
  // the parent moves and turns about z; the child scales and then moves
  const TriangleMesh mesh =
      read_collada(legs_with_nodes("<node><translate>10 0 0</translate><rotate>0 0 1 90</rotate><node><translate>0 1 0</translate>"
                                   "<scale>2 3 4</scale>" +
                                   shown + "</node></node>"));
  expect_has_vertex(mesh, {9, 0, 0});
  expect_has_vertex(mesh, {9, 2, 0});
  expect_has_vertex(mesh, {10 - 1 - 6, 0, 0});
  expect_has_vertex(mesh, {9, 0, 12});
  EXPECT_NEAR(mesh_volume(mesh), 24, 1e-4);
  const TriangleMesh rows =
      read_collada(legs_with_nodes("<node><matrix>0 0 1 5\n1 0 0 6\n0 1 0 7\n0 0 0 1</matrix>" + shown + "</node>"));
  expect_has_vertex(rows, {5, 7, 7});
  expect_has_vertex(rows, {8, 6, 7});
  const TriangleMesh mirrored = read_collada(legs_with_nodes("<node><scale>-1 1 1</scale>" + shown + "</node>"));
  EXPECT_NEAR(mesh_volume(mirrored), 1, COLLADA_ROUNDING);
  const TriangleMesh twice = read_collada(legs_with_nodes(
      "<node id=\"one\">" + shown + "</node><node><translate>5 0 0</translate><instance_node url=\"#one\"/></node>"));
  EXPECT_EQ(twice.triangles.size(), 8u);
  EXPECT_NEAR(mesh_volume(twice), 2, COLLADA_ROUNDING);
}

TEST(MeshCollada, EveryKindOfPolygon) {
  const auto with = [](const std::string& kind, const std::string& inside) {
    return mesh_volume(read_collada(legs_with_polygons(
        fmt::format("<{0} count=\"4\"><input semantic=\"VERTEX\" source=\"#body-points\" offset=\"0\"/>{1}</{0}>", kind, inside))));
  };
  EXPECT_NEAR(with("polylist", "<vcount>3 3 3 3</vcount><p>0 2 1 0 1 3 0 3 2 1 2 3</p>"), 1, COLLADA_ROUNDING);
  EXPECT_NEAR(with("polygons", "<p>0 2 1</p><p>0 1 3</p><p>0 3 2</p><p>1 2 3</p>"), 1, COLLADA_ROUNDING);
  EXPECT_NEAR(with("tristrips", "<p>0 2 1 3 0 2</p>"), 1, COLLADA_ROUNDING);
  EXPECT_NEAR(with("trifans", "<p>0 2 1 3 2</p><p>1 2 3</p>"), 1, COLLADA_ROUNDING);
  const std::string edges =
      "<lines count=\"1\"><input semantic=\"VERTEX\" source=\"#body-points\" offset=\"0\"/><p>0 1</p></lines>";
  EXPECT_NEAR(mesh_volume(read_collada(legs_with_polygons(edges + LEG_TRIANGLES))), 1, COLLADA_ROUNDING)
      << "as SketchUp draws edges";
  // an L, which a fan from its first corner would not fill
  std::vector<Triple> corners;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : std::vector<std::array<double, 2>>{{2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}})
      corners.push_back({x, y, z});
  const std::string ell =
      "<polylist count=\"8\"><input semantic=\"VERTEX\" source=\"#body-points\" offset=\"0\"/><vcount>6 6 4 4 4 4 4 4</vcount><p>";
  std::string indices = "0 1 2 3 4 5 11 10 9 8 7 6";
  for (int i = 0; i < 6; ++i) indices += fmt::format(" {0} {2} {3} {1}", i, (i + 1) % 6, i + 6, (i + 1) % 6 + 6);
  EXPECT_NEAR(std::abs(mesh_volume(read_collada(collada_text("", collada_geometry(corners, ell + indices + "</p></polylist>"),
                                                             "<node><instance_geometry url=\"#body\"/></node>")))),
              3, COLLADA_ROUNDING);
}

TEST(MeshCollada, WhatIsNoBodyIsRefused) {
  const std::string whole = collada_text(leg_mesh());
  const auto after = [&](const std::string& part, const std::string& other) {
    std::string text = whole;
    const std::size_t at = text.find(part);
    EXPECT_NE(at, text.npos) << part;
    return collada_refusal(at == text.npos ? text : text.replace(at, part.size(), other));
  };
  EXPECT_EQ(after("unit", "unit"), "read");
  EXPECT_SAYS(collada_refusal("<?xml version=\"1.0\"?><COLLADA><asset>"), "is damaged: ");
  EXPECT_SAYS(collada_refusal("<COLLADA/>"), "has no mesh in its scene");
  EXPECT_SAYS(after("count=\"4\" stride", "count=\"5\" stride"), "accessor reaches beyond its 12 numbers");
  EXPECT_SAYS(after("count=\"4\" stride", "count=\"2000000000\" stride"), "accessor reaches beyond its 12 numbers");
  EXPECT_SAYS(after("count=\"4\" stride", "count=\"-4\" stride"), "which is no count or index");
  EXPECT_SAYS(after("stride=\"3\"", "stride=\"4\""), "accessor reaches beyond");
  EXPECT_SAYS(after("stride=\"3\"", "stride=\"2\""), "fewer than three coordinates");
  EXPECT_SAYS(after("\"#body-array\"", "\"#body-points\""), "names '#body-points', which is no float_array of this file");
  EXPECT_SAYS(after("url=\"#body\"", "url=\"other.dae#body\""), "which is no geometry of this file");
  EXPECT_SAYS(after("<p>0 0", "<p>0 4"), "line 12: p has the index 4 and 4 points");
  EXPECT_SAYS(after("<p>0 0", "<p>0 -1"), "which is no count or index");
  EXPECT_SAYS(after("<p>0 0", "<p>0 0 0"), "no multiple of 2");
  EXPECT_SAYS(after("<p>0 0", "<p>0 1 0 0"), "p goes on after the last polygon");
  EXPECT_SAYS(after("0 2 0", "0 two 0"), "line 5: float_array has 'two', which is no finite number");
  EXPECT_SAYS(after("0 2 0", "0 1e39 0"), "no finite number");
  EXPECT_SAYS(after("meter=\"1\"", "meter=\"0\""), "unit has no length");
  EXPECT_SAYS(after("meter=\"1\"", "meter=\"2e38\""), "has a vertex that is not a finite number");
  EXPECT_SAYS(after("Y_UP", "UP"), "up_axis is 'UP'; allowed: X_UP, Y_UP or Z_UP");
  EXPECT_SAYS(after("<instance_geometry", "<skew>1 2 3 4 5 6 7</skew><instance_geometry"), "bake the transforms");
  EXPECT_SAYS(after("<instance_geometry", "<scale>1 2</scale><instance_geometry"), "scale has 2 numbers in place of 3");
  EXPECT_SAYS(after("<instance_geometry", "<instance_controller url=\"#skin\"/><instance_geometry"), "apply the armature");
  EXPECT_SAYS(collada_refusal(legs_with_nodes("<node id=\"one\"><instance_node url=\"#one\"/></node>")), "or one shows itself");
}

// As many triangles as memory has, in a few lines: each node shows the one before ten times.
TEST(MeshCollada, NodesThatMultiplyAreCounted) {
  std::string nodes = "<node id=\"n0\"><instance_geometry url=\"#body\"/></node>";
  for (int level = 1; level < 9; ++level) {
    nodes += fmt::format("<node id=\"n{}\">", level);
    for (int k = 0; k < 10; ++k) nodes += fmt::format("<instance_node url=\"#n{}\"/>", level - 1);
    nodes += "</node>";
  }
  EXPECT_SAYS(collada_refusal(legs_with_nodes(nodes)), "shows nodes more than 100,000 times");
}

}  // namespace
}  // namespace wholehand
