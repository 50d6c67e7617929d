// SPDX-License-Identifier: MIT
// Numbers are millimeters where they make profiles, and meters elsewhere.
#include "tests/support/vessel_models.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/scene.h"
#include "tests/support/meshes.h"
#include "tests/support/spouted_beaker.h"

namespace wholehand {
namespace vessel_making {  // its short names are taken elsewhere
namespace {

constexpr double NO_FORMULA = std::numeric_limits<double>::quiet_NaN();
constexpr int SIDES = 96;
constexpr int COARSE_SIDES = 12;
constexpr int FINE_SIDES = 512;

// A wall between two profiles that end at one height, or in one point.
VesselModel walled(const std::string& name, const TurnedProfile& outer, const TurnedProfile& inner, int sides = SIDES) {
  const ProfilePoints outer_points = outer.points();
  VesselModel model{.name = name, .inner = inner.points()};
  model.mesh = walled_mesh(outer_points, model.inner, sides);
  model.volume = outer.volume() - inner.volume();
  model.capacity = inner.volume();
  model.brim = model.inner.back()[1];
  model.mesh_volume = polygon_share(sides) * (frustums(outer_points) - frustums(model.inner));
  model.mesh_capacity = polygon_share(sides) * frustums(model.inner);
  return model;
}

// A body without a mouth.
VesselModel full(const std::string& name, const TurnedProfile& outer, const std::string& refusal) {
  VesselModel model{.name = name, .refusal = refusal};
  model.mesh = swept_mesh(outer.points(), SIDES);
  model.volume = outer.volume();
  model.mesh_volume = polygon_share(SIDES) * frustums(outer.points());
  return model;
}

// A closed void in the glass: its surface faces into it.
VesselModel with_void(VesselModel model, const TurnedProfile& gap) {
  model.mesh = joined(model.mesh, inside_out(swept_mesh(gap.points(), SIDES)));
  model.volume -= gap.volume();
  model.mesh_volume -= polygon_share(SIDES) * frustums(gap.points());
  return model;
}

// Another body, which is no part of the vessel.
VesselModel beside(VesselModel model, const TriangleMesh& other) {
  model.vessel_triangles = model.mesh.triangles.size();
  model.mesh = joined(model.mesh, other);
  return model;
}

VesselModel raised(VesselModel model, double by) {
  model.mesh = placed_mesh(model.mesh, {}, {0, by, 0});
  for (auto& [r, y] : model.inner) y += by;
  model.brim += by;
  return model;
}

// ---- mugs and cups ----
constexpr double MUG_RADIUS = 40, MUG_HEIGHT = 95;  // mm

TurnedProfile mug_outside() { return TurnedProfile(0, 0).line(MUG_RADIUS, 0).line(MUG_RADIUS, MUG_HEIGHT); }
TurnedProfile mug_inside() { return TurnedProfile(0, 5).line(36, 5).line(36, MUG_HEIGHT); }

VesselModel mug(const std::string& name, int sides = SIDES) { return walled(name, mug_outside(), mug_inside(), sides); }

// The handle is a part of its own, whose ends lie in the wall: in the glass, but not in the cavity.
VesselModel mug_with_handle() {
  VesselModel model = mug("mug_with_handle");
  const Handle handle{.bar = 4e-3, .bend = 20e-3, .end_x = 38e-3, .center_x = 48e-3, .center_y = 50e-3};
  model.mesh = joined(model.mesh, handle.mesh());
  model.volume += handle.volume_outside(MUG_RADIUS * 1e-3);
  model.mesh_volume += handle.mesh_volume();
  return model;
}

// Its lip is a half circle.
VesselModel tapered_cup(const std::string& name) {
  return walled(name, TurnedProfile(0, 0).line(30, 0).line(42, 90).arc(40.5, 91.5, 40.5, 90),
                TurnedProfile(0, 4).line(27.5, 4).line(39, 90).arc(40.5, 91.5, 40.5, 90));
}

VesselModel conical_tumbler() {
  return walled("conical_tumbler", TurnedProfile(0, 0).line(22, 0).line(45, 120), TurnedProfile(0, 6).line(20.5, 6).line(43, 120));
}

VesselModel domed_floor_cup() {
  return walled("domed_floor_cup", mug_outside(), TurnedProfile(0, 20).cap(30, 6).line(36, 6).line(36, MUG_HEIGHT));
}

VesselModel thin_cup() {
  return walled("thin_cup", TurnedProfile(0, 0).line(28, 0).line(38, 100), TurnedProfile(0, 0.4).line(27.64, 0.4).line(37.6, 100));
}

VesselModel thermos_cup() {
  return with_void(
      walled("thermos_cup", TurnedProfile(0, 0).line(42, 0).line(42, 110), TurnedProfile(0, 12).line(33, 12).line(33, 110)),
      TurnedProfile(0, 4).line(39.5, 4).line(39.5, 104).line(36, 104).line(36, 9).line(0, 9));
}

VesselModel vase() {
  // both walls bend about one center
  constexpr double CENTER_R = 251, WAIST = 60, INSIDE = 232, FLOOR = 5, END = 120;
  return walled("vase", TurnedProfile(0, 0).line(30, 0).arc(30, END, CENTER_R, WAIST).line(34, 135),
                TurnedProfile(0, FLOOR)
                    .line(inner_side(CENTER_R, WAIST, INSIDE, FLOOR), FLOOR)
                    .arc(inner_side(CENTER_R, WAIST, INSIDE, END), END, CENTER_R, WAIST)
                    .line(31, 135));
}

// ---- flasks, bottles and tubes ----
VesselModel erlenmeyer() {
  return walled("erlenmeyer_flask", TurnedProfile(0, 0).line(42, 0).line(42, 5).line(14, 85).line(14, 115),
                TurnedProfile(0, 2).line(37, 2).arc(40, 5, 37, 5).line(12, 85).line(12, 115));
}

VesselModel round_flask() {
  constexpr double CENTER = 45, OUTSIDE = 45, INSIDE = 43, NECK = 14, BORE = 12, TOP = 130;
  return walled("round_flask", TurnedProfile(0, 0).arc(NECK, outer_side(CENTER, 0, OUTSIDE, NECK), 0, CENTER).line(NECK, TOP),
                TurnedProfile(0, CENTER - INSIDE).arc(BORE, outer_side(CENTER, 0, INSIDE, BORE), 0, CENTER).line(BORE, TOP));
}

// From the edge of the base to the mouth: a straight wall, a rounded shoulder, a fillet, a neck.
TurnedProfile bottle_outside(TurnedProfile base) {
  return base.line(36, 0).line(36, 140).arc(20, 156, 20, 140).arc(14, 162, 20, 162).line(14, 215);
}
TurnedProfile bottle_inside(TurnedProfile floor) {
  return floor.line(33, 140).arc(20, 153, 20, 140).arc(11, 162, 20, 162).line(11, 215);
}

VesselModel bottle() {
  return walled("bottle", bottle_outside(TurnedProfile(0, 0)), bottle_inside(TurnedProfile(0, 4).line(33, 4)));
}

// Its floor rises in the middle, and the recess below is no cavity.
VesselModel punted_bottle() {
  return walled("punted_bottle", bottle_outside(TurnedProfile(0, 18).cap(26, 0)),
                bottle_inside(TurnedProfile(0, 24).cap(29, 4).arc(33, 8, 29, 8)));
}

VesselModel test_tube() {
  return walled("test_tube", TurnedProfile(0, 0).arc(8, 8, 0, 8).line(8, 150), TurnedProfile(0, 1).arc(7, 8, 0, 8).line(7, 150));
}

// ---- stemware ----
VesselModel wine_glass() {
  constexpr double WIDEST = 122, OUTSIDE = 36, INSIDE = 34.5, STEM = 4, TOP = 170;
  constexpr double BEND = 136;  // the radius at which the bowl narrows, about a point 100 mm beyond the axis
  constexpr double WALL = OUTSIDE - INSIDE;
  return walled("wine_glass",
                TurnedProfile(0, 0)
                    .line(34, 0)
                    .line(34, 1.5)
                    .line(8, 5)
                    .arc(STEM, 9, 8, 9)
                    .line(STEM, inner_side(WIDEST, 0, OUTSIDE, STEM))
                    .arc(OUTSIDE, WIDEST, 0, WIDEST)
                    .arc(outer_side(OUTSIDE - BEND, WIDEST, BEND, TOP), TOP, OUTSIDE - BEND, WIDEST),
                TurnedProfile(0, WIDEST - INSIDE)
                    .arc(INSIDE, WIDEST, 0, WIDEST)
                    .arc(outer_side(OUTSIDE - BEND, WIDEST, BEND - WALL, TOP), TOP, OUTSIDE - BEND, WIDEST));
}

VesselModel champagne_flute() {
  return walled("champagne_flute",
                TurnedProfile(0, 0)
                    .line(30, 0)
                    .line(30, 1.5)
                    .line(7, 4)
                    .arc(3.5, 7.5, 7, 7.5)
                    .line(3.5, 70)
                    .line(22, 110)
                    .line(24, 150)
                    .line(21, 215),
                TurnedProfile(0, 78).line(20.2, 110).line(22.4, 150).line(19.6, 215));
}

VesselModel martini_glass() {
  return walled("martini_glass",
                TurnedProfile(0, 0).line(36, 0).line(36, 1.5).line(7, 4).arc(3.5, 7.5, 7, 7.5).line(3.5, 90).line(55, 140),
                TurnedProfile(0, 90).line(53, 140));
}

// ---- bowls ----
VesselModel hemispherical_bowl() {
  return walled("hemispherical_bowl", TurnedProfile(0, 0).arc(60, 60, 0, 60), TurnedProfile(0, 3).arc(57, 60, 0, 60));
}

// The recess within its foot ring is open below: no cavity.
VesselModel footed_bowl() {
  return walled("footed_bowl", TurnedProfile(0, 6).line(22, 6).line(24, 0).line(28, 0).line(30, 7).cap(75, 45),
                TurnedProfile(0, 10).cap(72, 45));
}

// ---- cavities that are not round, or not about the vessel's axis ----
VesselModel square_cup() {
  constexpr double SIDE = 70e-3, BORE = 64e-3, HEIGHT = 90e-3, FLOOR = 4e-3;
  VesselModel model{.name = "square_cup", .is_round = false, .brim = HEIGHT};
  const double equal = BORE / std::sqrt(PI);  // the radius of the circle of equal area
  model.mesh = walled_mesh({{0, 0}, {SIDE / 2, 0}, {SIDE / 2, HEIGHT}}, {{0, FLOOR}, {BORE / 2, FLOOR}, {BORE / 2, HEIGHT}}, SIDES,
                           square_ring, square_ring);
  model.capacity = BORE * BORE * (HEIGHT - FLOOR);
  model.volume = SIDE * SIDE * HEIGHT - model.capacity;
  model.inner = {{0, FLOOR}, {equal, FLOOR}, {equal, HEIGHT}};
  model.mesh_volume = model.volume;  // flat walls have exact facets
  model.mesh_capacity = model.capacity;
  return model;
}

VesselModel oval_cup() {
  constexpr double WIDER = 1.4;  // along x
  VesselModel model =
      walled("oval_cup", TurnedProfile(0, 0).line(28, 0).line(30, 80), TurnedProfile(0, 4).line(25.1, 4).line(27, 80));
  for (Triple& p : model.mesh.vertices) p[0] *= WIDER;
  for (double* value : {&model.volume, &model.capacity, &model.mesh_volume, &model.mesh_capacity}) *value *= WIDER;
  for (auto& [r, y] : model.inner) r *= std::sqrt(WIDER);
  model.is_round = false;
  return model;
}

VesselModel off_axis_cup() {
  VesselModel model = mug("off_axis_cup");
  const auto shifted = [](double r, double y, double angle) {
    const Triple p = round_ring(r, y, angle);
    return Triple{p[0] + 5e-3, p[1], p[2]};
  };
  TurnedProfile outer = TurnedProfile(0, 0).line(43, 0).line(43, MUG_HEIGHT);
  model.mesh = walled_mesh(outer.points(), model.inner, SIDES, shifted);
  model.volume = outer.volume() - model.capacity;
  model.mesh_volume = polygon_share(SIDES) * model.volume;  // no arcs
  return model;
}

// Its true shape is the prism of 12 sides, as they are wide enough to be meant.
VesselModel coarse_cup() {
  VesselModel model = mug("coarse_cup", COARSE_SIDES);
  model.volume = model.mesh_volume;
  model.capacity = model.mesh_capacity;
  for (auto& [r, y] : model.inner) r *= std::sqrt(polygon_share(COARSE_SIDES));
  model.is_round = false;
  return model;
}

// ---- several bodies ----
VesselModel cup_and_saucer() {
  constexpr double GAP = 0.1e-3, SAUCER_FLOOR = 5e-3;  // so that no face of the cup lies in one of the saucer
  const TurnedProfile below = TurnedProfile(0, 0).line(40, 0).line(70, 14), above = TurnedProfile(0, 5).line(40, 5).line(69, 14);
  return beside(raised(tapered_cup("cup_and_saucer"), SAUCER_FLOOR + GAP), walled_mesh(below.points(), above.points(), SIDES));
}

// A rod with a bulb, pressed flat and laid on the ground.
TriangleMesh spoon() {
  constexpr double FLATTER = 0.3, WIDEST = 16e-3;
  TriangleMesh mesh = swept_mesh(TurnedProfile(0, 0).line(4, 0).line(4, 110).line(16, 130).arc(0, 146, 0, 130).points(), SIDES);
  for (Triple& p : mesh.vertices) p[2] *= FLATTER;
  return placed_mesh(mesh, {PI / 2, 0, 0}, {70e-3, FLATTER * WIDEST, -70e-3});
}

VesselModel cup_and_spoon() { return beside(tapered_cup("cup_and_spoon"), spoon()); }

// ---- sheets and holes ----
VesselModel sheet_cup(const std::string& name) {
  constexpr double THICKNESS = 2, HEIGHT = 90, BOTTOM = 30, TOP = 42;  // mm
  // the inner wall is parallel: its radius is less by the thickness over the slope's cosine
  const double slope = (TOP - BOTTOM) / HEIGHT, narrower = THICKNESS * std::hypot(1, slope);
  const TurnedProfile outer = TurnedProfile(0, 0).line(BOTTOM, 0).line(TOP, HEIGHT);
  const TurnedProfile inner =
      TurnedProfile(0, THICKNESS).line(BOTTOM + slope * THICKNESS - narrower, THICKNESS).line(TOP - narrower, HEIGHT);
  VesselModel model = walled(name, outer, inner);
  model.mesh = swept_mesh(outer.points(), SIDES);
  model.thickness = THICKNESS * 1e-3;
  model.mesh_volume = model.mesh_capacity = NO_FORMULA;
  return model;
}

VesselModel two_sided_sheet_cup() {
  VesselModel model = sheet_cup("two_sided_sheet_cup");
  model.mesh = two_sided(std::move(model.mesh));
  return model;
}

// Values of vessels with a hole are those of the whole one; a sum over the triangles that are left has no formula.
VesselModel broken(VesselModel model, TriangleMesh mesh) {
  model.mesh = std::move(mesh);
  model.mesh_volume = NO_FORMULA;
  return model;
}

VesselModel cup_without_base() {
  VesselModel model = tapered_cup("cup_without_base");
  return broken(model, without_base(model.mesh));
}

// A hole in the outer surface only: the cavity's is whole. Rows are so close that its edge has many steps.
VesselModel holed_mug(const std::string& name, const Triple& center, double radius) {
  constexpr double ROW = 4e-3;
  return broken(mug(name), with_hole(walled_mesh(divided(mug_outside().points(), ROW), divided(mug_inside().points(), ROW), SIDES),
                                     center, radius));
}

VesselModel cup_with_a_hole_in_its_wall() { return holed_mug("cup_with_a_hole_in_its_wall", {60e-3, 50e-3, 0}, 23.5e-3); }

// Where wall and base meet.
VesselModel cup_with_a_broken_edge() { return holed_mug("cup_with_a_broken_edge", {44e-3, -3e-3, 0}, 10e-3); }

// ---- what holds nothing ----
VesselModel closed_can() {
  return with_void(full("closed_can", TurnedProfile(0, 0).line(33, 0).line(33, 115).line(0, 115), SAYS_SEALED),
                   TurnedProfile(0, 1).line(32, 1).line(32, 114).line(0, 114));
}

VesselModel cup_upside_down() {
  VesselModel model = mug("cup_upside_down");
  model.mesh = placed_mesh(model.mesh, {PI, 0, 0}, {0, model.brim, 0});
  model.inner.clear();
  model.capacity = model.mesh_capacity = model.brim = 0;
  model.refusal = SAYS_UPSIDE_DOWN;
  return model;
}

VesselModel pipe() {
  constexpr double OUTSIDE = 40e-3, INSIDE = 36e-3, HEIGHT = 95e-3;
  VesselModel model{.name = "pipe", .refusal = SAYS_NO_FLOOR};
  model.mesh = swept_mesh({{INSIDE, 0}, {OUTSIDE, 0}, {OUTSIDE, HEIGHT}, {INSIDE, HEIGHT}, {INSIDE, 0}}, SIDES);
  model.volume = PI * (OUTSIDE * OUTSIDE - INSIDE * INSIDE) * HEIGHT;
  model.mesh_volume = polygon_share(SIDES) * model.volume;
  return model;
}

std::vector<VesselModel> all() {
  std::vector<VesselModel> models{mug("straight_mug"),
                                  mug_with_handle(),
                                  tapered_cup("tapered_cup"),
                                  conical_tumbler(),
                                  spouted_beaker("beaker_with_spout"),
                                  erlenmeyer(),
                                  round_flask(),
                                  bottle(),
                                  punted_bottle(),
                                  wine_glass(),
                                  champagne_flute(),
                                  martini_glass(),
                                  hemispherical_bowl(),
                                  footed_bowl(),
                                  thermos_cup(),
                                  vase(),
                                  test_tube(),
                                  square_cup(),
                                  oval_cup(),
                                  off_axis_cup(),
                                  domed_floor_cup(),
                                  thin_cup(),
                                  coarse_cup(),
                                  mug("fine_mug", FINE_SIDES),
                                  cup_and_saucer(),
                                  cup_and_spoon(),
                                  sheet_cup("sheet_cup"),
                                  two_sided_sheet_cup(),
                                  cup_without_base(),
                                  cup_with_a_hole_in_its_wall(),
                                  cup_with_a_broken_edge(),
                                  full("solid_hull", TurnedProfile(0, 0).line(30, 0).line(42, 90).line(0, 90), SAYS_NO_CAVITY),
                                  closed_can(),
                                  cup_upside_down(),
                                  pipe()};
  for (VesselModel& model : models)
    if (model.vessel_triangles == 0) model.vessel_triangles = model.mesh.triangles.size();
  return models;
}

}  // namespace
}  // namespace vessel_making

const std::vector<VesselModel>& vessel_models() {
  static const std::vector<VesselModel> models = vessel_making::all();
  return models;
}

const VesselModel& vessel_model(const std::string& name) {
  for (const VesselModel& model : vessel_models())
    if (model.name == name) return model;
  throw std::out_of_range("no vessel model '" + name + "'");
}

}  // namespace wholehand
