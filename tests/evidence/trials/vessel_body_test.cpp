// SPDX-License-Identifier: MIT
// The vessel as the engine takes it: its form is that of the distance, its mass and its center are those of the kernels.
// sanitizers: none
#include "evidence/trials/vessel_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/text/error.h"
#include "core/mesh_body.h"
#include "core/vectors.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

std::vector<PieceShape> shapes_of(const VesselData& vessel) {
  std::vector<PieceShape> shapes;
  for (const ConvexPiece& piece : convex_pieces(vessel)) shapes.push_back(piece.shape);
  return shapes;
}

TEST(VesselBody, IsCutWhereItsOutlineIsNotConvex) {
  using enum PieceShape;
  EXPECT_EQ(shapes_of(beaker1()), std::vector<PieceShape>{cylinder});
  EXPECT_EQ(shapes_of(beaker2()), (std::vector<PieceShape>{ball, cylinder}));  // a sphere and a neck
  EXPECT_EQ(shapes_of(beaker3()), (std::vector<PieceShape>{hull, cylinder}));  // a cone and a neck
}

// A place on a piece that is no hull: at a share of its height, and of a turn.
Triple place_on(const ConvexPiece& piece, double share, double turn) {
  const double y = piece.low + share * (piece.high - piece.low), middle = (piece.low + piece.high) / 2;
  const double r =
      piece.shape == PieceShape::cylinder ? piece.radius : std::sqrt(piece.radius * piece.radius - (y - middle) * (y - middle));
  return {r * std::cos(turn), y, r * std::sin(turn)};
}

// What the engine has a shape for lies on the surface, or within the piece that it meets.
TEST(VesselBody, BallsAndCylindersAreExact) {
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3()}) {
    const auto evaluator = make_core_evaluator(scene_of({vessel}));
    for (const ConvexPiece& piece : convex_pieces(vessel)) {
      if (piece.shape == PieceShape::hull) continue;
      int on_it = 0;
      for (int k = 0; k <= 20; ++k) {
        const double away = evaluator->distance(0, place_on(piece, k / 20.0, 0.3 * k));
        EXPECT_LT(away, 1e-9) << vessel.name << k;
        on_it += away > -1e-9;
      }
      EXPECT_GE(on_it, 19) << vessel.name;  // a ball's top is within the neck
    }
  }
}

// A ball goes on to its own top only where the pieces above it hold that: no neck too short or too narrow does, nor a wall that meets
// the ball below its middle.
TEST(VesselBody, ABallThatWouldStickOutIsAHull) {
  const double neck = 17, meets = 42.5 + std::sqrt(42.5 * 42.5 - neck * neck);
  const OutlineElement arc = arc_to(neck, meets, 0, 42.5);
  EXPECT_EQ(shapes_of(vessel_of("high", {arc, line_to(neck, 85.1), line_to(0, 85.1)}, 1.5)).front(), PieceShape::ball);
  EXPECT_EQ(shapes_of(vessel_of("low", {arc, line_to(neck, 84.9), line_to(0, 84.9)}, 1.5)).front(), PieceShape::hull);
  EXPECT_EQ(shapes_of(vessel_of("narrow", {arc, line_to(12, 83), line_to(12, 140), line_to(0, 140)}, 1.5)).front(),
            PieceShape::hull);
  const OutlineElement low_arc = arc_to(30, 42.5 - std::sqrt(42.5 * 42.5 - 30 * 30), 0, 42.5);
  EXPECT_EQ(shapes_of(vessel_of("wide", {low_arc, line_to(36, 13), line_to(36, 120), line_to(0, 120)}, 1.5)).front(),
            PieceShape::hull);
}

// Every vertex lies on the surface, or within a piece where two meet; and the middle of a side is no deeper than the sides allow.
TEST(VesselBody, HasTheFormOfTheDistance) {
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3()}) {
    const auto evaluator = make_core_evaluator(scene_of({vessel}));
    for (const auto& [shape, vertices, of_radius, low, high] : convex_pieces(vessel)) {
      const double side = 1 - std::cos(PI / (shape == PieceShape::ball ? ROUNDED_SIDES : FORM_SIDES));
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        EXPECT_LT(evaluator->distance(0, vertices[k]), 1e-9) << vessel.name;
        const Triple next = vertices[(k + 1) % vertices.size()];
        if (next[1] != vertices[k][1] || vertices[k][1] == 0) continue;
        const double radius = std::hypot(vertices[k][0], vertices[k][2]);
        if (evaluator->distance(0, vertices[k]) < -1e-6) continue;  // a ring within the other piece
        EXPECT_GT(evaluator->distance(0, midpoint(vertices[k], next)), -side * radius - 1e-9) << vessel.name;
      }
    }
  }
}

// Between its rings too: an arc is no further from its cones than the tolerance.
TEST(VesselBody, ConesKeepToAnArc) {
  const auto evaluator = make_core_evaluator(scene_of({beaker2()}));
  double deepest = 0;
  const std::vector<Triple> vertices = convex_pieces(beaker2()).front().vertices;
  for (std::size_t k = 0; k + ROUNDED_SIDES < vertices.size(); ++k)
    if (evaluator->distance(0, vertices[k]) > -1e-6 && evaluator->distance(0, vertices[k + ROUNDED_SIDES]) > -1e-6)
      deepest = std::max(deepest, -evaluator->distance(0, midpoint(vertices[k], vertices[k + ROUNDED_SIDES])));
  EXPECT_GT(deepest, 0.2 * FORM_TOLERANCE);
  EXPECT_LE(deepest, 1.01 * FORM_TOLERANCE);
}

std::string refusal_of(const VesselData& vessel) {
  try {
    convex_pieces(vessel);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "none";
}

// A mesh of two triangles a side of a box, with its top pressed in by `dent` m at the middle.
VesselData dented_box(double dent) {
  auto body = std::make_shared<MeshBody>();
  body->vertices = {{-0.02, 0, -0.02},   {0.02, 0, -0.02},   {0.02, 0, 0.02},     {-0.02, 0, 0.02},   {-0.02, 0.05, -0.02},
                    {0.02, 0.05, -0.02}, {0.02, 0.05, 0.02}, {-0.02, 0.05, 0.02}, {0, 0.05 - dent, 0}};
  body->triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 6}, {2, 6, 3},
                     {3, 6, 7}, {3, 7, 0}, {0, 7, 4}, {4, 8, 5}, {5, 8, 6}, {6, 8, 7}, {7, 8, 4}};
  VesselData vessel;
  vessel.name = "box";
  vessel.mesh = MeshData{};
  vessel.mesh->body = body;
  return vessel;
}

TEST(VesselBody, WhatHasNoModelIsRefusedWithItsNameAndTheReason) {
  EXPECT_NE(refusal_of(shell_of(beaker1())).find("its surface is a shell"), std::string::npos);
  EXPECT_NE(refusal_of(ledges()).find("goes down again"), std::string::npos) << refusal_of(ledges());
  EXPECT_EQ(refusal_of(dented_box(0)), "none");
  EXPECT_EQ(refusal_of(dented_box(2e-3)), "none");
  EXPECT_EQ(convex_pieces(dented_box(0.4e-3)).size(), 1u);
  EXPECT_GT(convex_pieces(dented_box(2e-3)).size(), 1u);
}

TEST(VesselBody, WeighsWhatTheKernelsWeigh) {
  const Scene scene = three_beakers();
  const auto evaluator = make_core_evaluator(scene);
  const Triple pour{0, 0, -1};
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselLoad load(scene, *evaluator, v, pour);
    for (const double fill : {0.0, 0.5, 1.0}) {
      for (const double tilt : {0.0, radians(60)}) {
        const LiquidResult liquid = evaluator->liquid(v, fill, tilt);
        const RigidLoad found = load.at(fill, tilt, std::nan(""));
        const double glass = evaluator->empty_mass(v), mass = glass + liquid.mass;
        EXPECT_NEAR(found.mass, mass, 1e-12);
        EXPECT_NEAR(found.center[1], (glass * evaluator->empty_center_of_mass(v)[1] + liquid.mass * liquid.height) / mass, 1e-12);
        EXPECT_NEAR(found.center[2], -liquid.mass * liquid.lean / mass, 1e-12);
        EXPECT_NEAR(load.at(fill, tilt, 0.1).mass, 0.1, 1e-15);
      }
    }
  }
}

// A full cylinder of glass: m r^2 / 2 about its axis, m (3 r^2 + h^2) / 12 across it.
TEST(VesselBody, ASolidCylinderHasItsInertia) {
  VesselData rod = cylinder("rod", 40, 100, 0);
  rod.wall = 0;
  const Scene scene = scene_of({rod});
  const auto evaluator = make_core_evaluator(scene);
  const RigidLoad load = VesselLoad(scene, *evaluator, 0, {0, 0, -1}).at(0, 0, std::nan(""));
  const double m = PI * 0.02 * 0.02 * 0.1 * rod.density;
  EXPECT_NEAR(load.mass, m, 1e-9 * m);
  EXPECT_NEAR(load.inertia[4], m * 0.02 * 0.02 / 2, 1e-4 * load.inertia[4]);
  EXPECT_NEAR(load.inertia[0], m * (3 * 0.02 * 0.02 + 0.1 * 0.1) / 12, 1e-4 * load.inertia[0]);
  EXPECT_EQ(load.inertia[0], load.inertia[8]);
}

// Upright and round about the axis at x = z = 0: m r^2 / 2 along it, m (3 r^2 + h^2) / 12 across.
RigidLoad full_cylinder(double mass, double radius, double low, double high) {
  const double h = high - low, along = mass * radius * radius / 2, across = mass * (3 * radius * radius + h * h) / 12;
  return {mass, {0, (low + high) / 2, 0}, {across, 0, 0, 0, along, 0, 0, 0, across}};
}

void expect_same_load(const RigidLoad& found, const RigidLoad& wanted, double share) {
  EXPECT_NEAR(found.mass, wanted.mass, share * wanted.mass);
  EXPECT_LT(distance(found.center, wanted.center), share * 0.1);
  const double size = std::max({wanted.inertia[0], wanted.inertia[4], wanted.inertia[8]});
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(found.inertia[k], wanted.inertia[k], share * size) << k;
}

// What is not glass weighs less than nothing.
RigidLoad pot_of_glass(const VesselData& pot, double radius, double height) {
  const double inner = radius - pot.wall, floor = pot.wall;
  RigidLoad hollow = full_cylinder(-PI * inner * inner * (height - floor) * pot.density, inner, floor, height);
  return joined(full_cylinder(PI * radius * radius * height * pot.density, radius, 0, height), hollow);
}

TEST(VesselBody, AWallAndALiquidHaveTheirInertia) {
  VesselData pot = cylinder("pot", 80, 110, 0);
  pot.wall = 4e-3;
  Scene scene = scene_of({pot});
  scene.liquid = three_beakers().liquid;
  const auto evaluator = make_core_evaluator(scene);
  const VesselLoad load(scene, *evaluator, 0, {0, 0, -1});
  const RigidLoad glass = pot_of_glass(pot, 0.04, 0.11);
  expect_same_load(load.at(0, 0, std::nan("")), glass, 1e-4);
  for (const double fill : {0.03, 0.5, 1.0}) {
    const LiquidResult held = evaluator->liquid(0, fill, 0);
    const double inner = 0.04 - pot.wall, height = held.volume / (PI * inner * inner);
    const RigidLoad liquid = full_cylinder(held.mass, inner, pot.wall, pot.wall + height);
    expect_same_load(load.at(fill, 0, std::nan("")), joined(glass, liquid), 1e-4);
  }
}

RigidLoad load_of(const VesselData& vessel) {
  const Scene scene = scene_of({vessel});
  const auto evaluator = make_core_evaluator(scene);
  return VesselLoad(scene, *evaluator, 0, {0, 0, -1}).at(0, 0, std::nan(""));
}

TEST(VesselBody, AMeshHasTheInertiaOfItsTriangles) {
  const Triple low{-0.03, 0, -0.02}, high{0.03, 0.1, 0.02};
  const double m = 0.06 * 0.1 * 0.04 * VesselData{}.density;
  const auto side = [&](double a, double b) { return m * (a * a + b * b) / 12; };
  const RigidLoad box{m, {0, 0.05, 0}, {side(0.1, 0.04), 0, 0, 0, side(0.06, 0.04), 0, 0, 0, side(0.06, 0.1)}};
  expect_same_load(load_of(vessel_of_mesh("box", box_mesh(low, high), 2e-3)), box, 1e-6);
  // turned about the upright axis, its products are those of the turned tensor
  const double turn = 0.5, c = std::cos(turn), s = std::sin(turn), x = box.inertia[0], z = box.inertia[8];
  RigidLoad turned = box;
  turned.inertia = {c * c * x + s * s * z, 0, c * s * (z - x), 0, box.inertia[4], 0, c * s * (z - x), 0, s * s * x + c * c * z};
  expect_same_load(load_of(vessel_of_mesh("turned", placed_mesh(box_mesh(low, high), {0, turn, 0}, {}), 2e-3)), turned, 1e-6);
  // its sides are 0.4 % within the circle
  VesselData rod = cylinder("rod", 40, 100, 0);
  rod.wall = 0;
  const double mass = PI * 0.02 * 0.02 * 0.1 * rod.density;
  expect_same_load(load_of(vessel_of_mesh("rod", turned_mesh(rod, 64, 1e-4), 2e-3)), full_cylinder(mass, 0.02, 0, 0.1), 6e-3);
}

TEST(VesselBody, TwoBodiesJoinedTurnAboutTheirCommonCenter) {
  const RigidLoad a{1, {0, 0.1, 0}, {}}, b{3, {0, 0.2, 0.04}, {}};
  const RigidLoad whole = joined(a, b);
  EXPECT_DOUBLE_EQ(whole.mass, 4);
  EXPECT_DOUBLE_EQ(whole.center[1], 0.175);
  EXPECT_DOUBLE_EQ(whole.center[2], 0.03);
  const double reduced = 0.75;  // 1 x 3 / 4
  EXPECT_NEAR(whole.inertia[0], reduced * (0.1 * 0.1 + 0.04 * 0.04), 1e-15);
  EXPECT_NEAR(whole.inertia[4], reduced * 0.04 * 0.04, 1e-15);
  EXPECT_NEAR(whole.inertia[5], -reduced * 0.1 * 0.04, 1e-15);
}

}  // namespace
}  // namespace wholehand
