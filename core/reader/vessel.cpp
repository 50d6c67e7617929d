// SPDX-License-Identifier: MIT
// [[vessel]]: form, wall, mass, and what the live task needs.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/reader/parts.h"

namespace wholehand {
namespace {

constexpr std::array<std::string_view, 28> VESSEL_KEYS{
    "name",        "shape",         "diameter_mm", "height_mm",         "neck_mm",       "upright_mm",
    "shoulder_mm", "outline",       "mesh",        "mesh_scale",        "rotate_deg",    "up",
    "close_holes", "origin",        "grid_mm",     "inner_outline",     "wall_mm",       "floor_mm",
    "surface",     "density_kg_m3", "mass_kg",     "center_of_mass_mm", "force_range_N", "guidance_mm",
    "place_mm",    "liquid",        "part",        "thickness_mm"};
constexpr std::array<std::string_view, 5> SHAPE_KEYS{"diameter_mm", "height_mm", "neck_mm", "upright_mm", "shoulder_mm"};
constexpr std::array<std::string_view, 8> MESH_KEYS{"mesh_scale", "up",      "close_holes", "rotate_deg",
                                                    "origin",     "grid_mm", "part",        "thickness_mm"};

void refuse_keys(const SceneTable& table, std::span<const std::string_view> keys, const std::string& without) {
  for (const auto key : keys) {
    if (table.has(key))
      table.file().refuse(table.place(key), fmt::format("{} is given without {}", key, without),
                          fmt::format("allowed: leave out {}", key));
  }
}

// A number, or several.
void read_parts(const SceneTable& table, std::vector<int>& parts) {
  const toml::node* node = table.find("part");
  if (!node) return;
  if (!node->is_array()) {
    std::int64_t number = 0;
    table.read("part", ranges::PART, number);
    parts = {static_cast<int>(number)};
    return;
  }
  for (const toml::node& one : *table.array("part", 1, ranges::LARGEST_PARTS, "numbers from 1")) {
    const std::optional<std::int64_t> number = one.value_exact<std::int64_t>();
    if (!number || *number < ranges::PART.low || *number > ranges::PART.high)
      table.file().refuse(place_of(one), "an entry of part " + found(one),
                          fmt::format("allowed: a whole number, {} to {}", ranges::PART.low, ranges::PART.high));
    parts.push_back(static_cast<int>(*number));
  }
}

MeshData read_mesh(const SceneTable& table) {
  MeshData mesh;
  table.read_path("mesh", mesh.file);
  mesh.place = table.file().text_of(table.place("mesh"));
  table.read("mesh_scale", ranges::MESH_SCALE, mesh.scale);
  table.read("up", {{"y", false}, {"z", true}}, mesh.z_is_up);
  mesh.says_up = table.has("up");
  table.read("rotate_deg", ranges::ROTATION, "[x, y, z]", mesh.rotate);
  table.read_flag("close_holes", mesh.close_holes);
  if (const toml::node* origin = table.find("origin"); origin && origin->is_array()) {
    table.read("origin", ranges::MESH_ORIGIN, "[x, y, z]", mesh.origin.emplace());
  } else {
    table.read("origin", {{"base", true}, {"as_is", false}}, mesh.origin_at_base);
  }
  read_parts(table, mesh.parts);
  if (table.has("thickness_mm")) table.need("thickness_mm", ranges::WALL, mesh.thickness.emplace());
  if (mesh.thickness && mesh.close_holes)
    table.file().refuse(table.place("thickness_mm"), "both close_holes and thickness_mm are given",
                        "allowed: thickness_mm for a sheet, whose mouth stays open, or close_holes");
  if (table.has("grid_mm")) table.need("grid_mm", ranges::LATTICE_SPACING, mesh.lattice_spacing.emplace());
  // what is in the file is hull and wall at once
  for (const char* key : {"wall_mm", "floor_mm", "surface"}) {
    if (table.has(key))
      table.file().refuse(
          table.place(key), fmt::format("{} is given for a mesh", key),
          "allowed: with 'shape' or 'outline'; a mesh has the walls of its file, and 'inner_outline' gives its cavity");
  }
  return mesh;
}

// Exactly one of shape, outline and mesh.
void read_form(const SceneTable& table, VesselData& vessel, Silhouette& silhouette) {
  std::vector<std::string_view> forms;
  for (const std::string_view key : {"shape", "outline", "mesh"}) {
    if (table.has(key)) forms.push_back(key);
  }
  if (forms.empty()) {
    table.file().refuse(table.place(), fmt::format("vessel '{}' has no form", vessel.name),
                        "allowed: one of 'shape', 'outline' and 'mesh'");
  }
  if (forms.size() > 1) {
    table.file().refuse(table.place(forms[1]), fmt::format("vessel '{}' has both '{}' and '{}'", vessel.name, forms[0], forms[1]),
                        "allowed: one of 'shape', 'outline' and 'mesh'");
  }
  if (forms[0] != "shape") refuse_keys(table, SHAPE_KEYS, "'shape'");
  if (forms[0] != "mesh") refuse_keys(table, MESH_KEYS, "'mesh'");
  if (forms[0] == "mesh") {
    vessel.mesh = read_mesh(table);
    return;
  }
  if (forms[0] == "shape") {
    std::string shape;
    table.read("shape", {{"cylinder", "cylinder"}, {"flask", "flask"}, {"conical", "conical"}}, shape);
    silhouette = read_shape(table, shape);
  } else {
    silhouette = read_outline(table);
  }
  vessel.outline = silhouette.elements;
  vessel.height = silhouette.height;
}

void read_mass(const SceneTable& table, VesselData& vessel) {
  const bool has_mass = table.has("mass_kg"), has_center = table.has("center_of_mass_mm");
  if (has_center && !has_mass)
    table.file().refuse(table.place("center_of_mass_mm"), "center_of_mass_mm without mass_kg",
                        "allowed: both or neither; a mesh may have mass_kg alone");
  if (has_mass && !has_center && !vessel.mesh)
    table.file().refuse(table.place("mass_kg"), "mass_kg without center_of_mass_mm",
                        "allowed: both or neither; a mesh may have mass_kg alone");
  if (has_mass && table.has("density_kg_m3")) {
    table.file().refuse(table.place("density_kg_m3"), "both density_kg_m3 and mass_kg are given", "allowed: one of the two");
  }
  table.read("density_kg_m3", ranges::VESSEL_DENSITY, vessel.density);
  if (has_mass) {
    table.need("mass_kg", ranges::MASS, vessel.mass.emplace());
    vessel.center_of_mass.fill(std::numeric_limits<double>::quiet_NaN());  // not given: that of what the mesh encloses
    table.read("center_of_mass_mm", ranges::CENTER_OF_MASS, "[x, y, z]", vessel.center_of_mass);
  } else if (!vessel.has_cavity() && !vessel.mesh) {  // a mesh has its volume
    table.file().refuse(table.place(), fmt::format("vessel '{}' has no mass", vessel.name),
                        "allowed: 'wall_mm' or 'inner_outline', or 'mass_kg' and 'center_of_mass_mm'");
  }
}

void read_guidance(const SceneTable& table, VesselData& vessel) {
  const auto* points = table.array("guidance_mm", 1, ranges::LARGEST_GUIDANCE, "each [height_mm, azimuth_deg]");
  if (!points) return;
  for (const toml::node& node : *points) {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() != 2) {
      table.file().refuse(place_of(node),
                          "an entry of guidance_mm " + (pair ? fmt::format("has {} entries", pair->size()) : found(node)),
                          "allowed: [height_mm, azimuth_deg]");
    }
    vessel.guidance.push_back({read_number(table.file(), (*pair)[0], "height in guidance_mm", ranges::GRIP_HEIGHT),
                               read_number(table.file(), (*pair)[1], "azimuth in guidance_mm", ranges::ROTATION)});
  }
}

VesselData read_vessel(const SceneTable& table) {
  VesselData vessel;
  vessel.line = table.place().line;
  vessel.column = table.place().column;
  table.need("name", "a name for the vessel");
  table.read_name("name", vessel.name);
  Silhouette silhouette;
  read_form(table, vessel, silhouette);
  read_cavity(table, silhouette, vessel);
  read_mass(table, vessel);
  if (table.has("force_range_N")) table.need("force_range_N", ranges::FORCE_RANGE, vessel.force_range.emplace());
  read_guidance(table, vessel);
  table.read("place_mm", ranges::PLACE, "[x, y, z]", vessel.place);
  read_own_liquid(table, vessel);
  return vessel;
}

}  // namespace

void read_vessels(const SceneTable& root, Scene& scene) {
  root.need("vessel", "1 to 64 tables [[vessel]]");
  const auto* vessels = root.array("vessel", 1, ranges::LARGEST_VESSELS, "tables [[vessel]]");
  std::map<std::string, int> lines;
  for (const toml::node& node : *vessels) {
    const toml::table* table = node.as_table();
    if (!table) root.file().refuse(place_of(node), "an entry of vessel " + found(node), "allowed: tables [[vessel]]");
    const SceneTable checked(root.file(), *table, "[[vessel]]", {VESSEL_KEYS.begin(), VESSEL_KEYS.end()});
    scene.vessels.push_back(read_vessel(checked));
    const VesselData& vessel = scene.vessels.back();
    const auto [other, is_new] = lines.emplace(vessel.name, vessel.line);
    if (!is_new) {
      root.file().refuse(checked.place("name"), fmt::format("a second vessel '{}'", vessel.name),
                         fmt::format("allowed: another name, as the vessel in line {} has this one", other->second));
    }
  }
}

void check_vessels(const SceneTable& root, const Scene& scene) {
  for (const VesselData& vessel : scene.vessels) {
    const Place place{vessel.line, vessel.column};
    if (vessel.mesh && vessel.inner.empty() && !vessel.liquid_name.empty()) {
      root.file().refuse(place, fmt::format("vessel '{}' has a liquid and is a mesh without 'inner_outline'", vessel.name),
                         "allowed: with 'inner_outline', the cavity that holds the liquid");
    }
    if (scene.liquid && !vessel.mesh && !vessel.has_cavity()) {
      root.file().refuse(
          place, fmt::format("vessel '{}' has no 'wall_mm' and no 'inner_outline', so [liquid] cannot fill it", vessel.name),
          "allowed: one of the two keys in every shape and outline, or no [liquid]");
    }
    if (!scene.liquid && !vessel.liquid_name.empty()) {
      root.file().refuse(place, fmt::format("vessel '{}' has a liquid, but the scene has no [liquid]", vessel.name),
                         "allowed: both, or neither");
    }
  }
}

}  // namespace wholehand
