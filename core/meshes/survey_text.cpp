// SPDX-License-Identifier: MIT
// What a survey found, for people, for programs and for a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/readable.h"
#include "core/meshes/free_radius.h"
#include "core/meshes/survey.h"
#include "core/meshes/vessel.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_WRITTEN = 100;  // parts in JSON
constexpr double CLEARLY_LOWER = 1e-3;     // m, of a brim below the highest point
constexpr double CLEARLY_LESS = 0.1;       // of the capacity
constexpr double CLEARLY_BENEATH = 0.005;  // of the capacity

std::string mm(double length) { return fmt::format("{:.4g}", 1e3 * length); }
std::string ml(double volume) { return fmt::format("{:.4g}", 1e6 * volume); }

// A number as TOML, to a micrometer or a millionth.
std::string written(double value) { return fmt::format("{}", std::round(1e6 * value) / 1e6 + 0.0); }
std::string written_triple(const Triple& values, double unit) {
  return fmt::format("[{}, {}, {}]", written(values[0] * unit), written(values[1] * unit), written(values[2] * unit));
}

std::string part_text(const std::vector<int>& numbers) {
  if (numbers.size() == 1) return std::to_string(numbers[0]);
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

void add_parts(const MeshSurvey& survey, std::vector<std::string>& lines) {
  constexpr std::size_t MOST_LISTED = 8;
  if (survey.parts.size() < 2) return;
  const double scale = survey.data.scale;
  for (std::size_t k = 0; k < std::min(survey.parts.size(), MOST_LISTED); ++k) {
    const MeshPart& part = survey.parts[k];
    lines.push_back(fmt::format("part {} of {}: {}, {} x {} x {} mm", k + 1, survey.parts.size(),
                                counted(part.triangles, "triangle"), mm(scale * (part.high[0] - part.low[0])),
                                mm(scale * (part.high[1] - part.low[1])), mm(scale * (part.high[2] - part.low[2]))));
  }
  if (survey.parts.size() > MOST_LISTED)
    lines.push_back(fmt::format("and {}", counted(survey.parts.size() - MOST_LISTED, "smaller part")));
  if (!survey.reasons.parts.empty())
    lines.push_back((survey.data.parts.empty() ? "parts: " : "part = " + part_text(survey.data.parts) + ": ") +
                    survey.reasons.parts);
}

void add_cavity(const MeshSurvey& survey, std::vector<std::string>& lines) {
  if (!survey.cavity.cavity) {
    lines.push_back("no cavity: it " + survey.cavity.refusal);
    return;
  }
  const FoundCavity& cavity = *survey.cavity.cavity;
  lines.push_back(fmt::format("cavity: {} mL up to the brim at {} mm, from a floor at {} mm; the inner_outline of {} holds {} mL",
                              ml(cavity.capacity), mm(cavity.brim), mm(cavity.floor),
                              counted(cavity.outline.elements.size(), "element"), ml(cavity.outline.volume)));
  const auto add = [&](const std::string& line) { lines.push_back("cavity: " + line); };
  if (cavity.is_brim_rough)
    add("its brim is exact to 1 % of the mesh only, as no level ray from the axis shows where liquid runs over");
  if (cavity.passing_rays > 0)
    add(fmt::format("{} of {} level rays pass through a hole at a height of {} mm", cavity.passing_rays, RAY_AZIMUTHS,
                    mm(cavity.passing_height)));
  if (cavity.off_round > OUTLINE_TOLERANCE)
    lines.push_back(
        fmt::format("cavity: its radius varies by up to {} mm about the axis, at a height of {} mm, and the outline takes the "
                    "least at each height",
                    mm(cavity.off_round), mm(cavity.off_round_height)));
  if (cavity.off_rays > 0)
    add(fmt::format("{} mL lie where no level ray from the axis reaches, and the outline leaves them out", ml(cavity.off_rays)));
  if (cavity.outline.off_profile > OUTLINE_TOLERANCE)
    add(fmt::format("the outline leaves out up to {} mm of a rough inside", mm(cavity.outline.off_profile)));
  if (const double less = 1 - cavity.outline.volume / cavity.capacity; less > CLEARLY_LESS)
    add(fmt::format("the outline holds {:.0f} % less than the cavity", 100 * less));
  if (cavity.beneath > CLEARLY_BENEATH * cavity.capacity)
    lines.push_back(
        fmt::format("cavity: {} mL lie lower than the floor on the axis, and the outline leaves them out", ml(cavity.beneath)));
  if (survey.mesh.facts.high[1] - cavity.brim > CLEARLY_LOWER)
    lines.push_back(
        fmt::format("cavity: liquid runs over {} mm below the highest point", mm(survey.mesh.facts.high[1] - cavity.brim)));
}

std::string up_key(const MeshData& data) { return data.z_is_up ? "z" : "y"; }

}  // namespace

std::vector<std::string> survey_lines(const MeshSurvey& survey) {
  std::vector<std::string> lines{mesh_check_text(survey.mesh.facts)};
  add_parts(survey, lines);
  if (!survey.reasons.unit.empty()) lines.push_back(fmt::format("mesh_scale = {}: {}", survey.data.scale, survey.reasons.unit));
  if (!survey.reasons.up.empty()) lines.push_back("up: " + survey.reasons.up);
  if (!survey.reasons.holes.empty()) lines.push_back("holes: " + survey.reasons.holes);
  add_cavity(survey, lines);
  lines.push_back(forecast_text(survey.lattice, survey.mesh.facts.closed));
  return lines;
}

std::string survey_json(const MeshSurvey& survey) {
  using Json = nlohmann::ordered_json;
  const MeshFacts& facts = survey.mesh.facts;
  const auto triple = [](const Triple& values, double unit) { return Json{values[0] * unit, values[1] * unit, values[2] * unit}; };
  Json json{{"file", survey.data.file},
            {"triangles", facts.triangles},
            {"size_mm", triple(facts.size(), 1e3)},
            {"low_mm", triple(facts.low, 1e3)},
            {"high_mm", triple(facts.high, 1e3)},
            {"closed", facts.closed},
            {"open_edges", facts.open_edges},
            {"holes", facts.holes},
            {"closed_holes", facts.closed_holes},
            {"non_manifold_edges", facts.non_manifold_edges},
            {"back_triangles", facts.back_triangles},
            {"repeated_triangles", facts.repeated_triangles},
            {"turned_triangles", facts.turned_triangles},
            {"was_inside_out", facts.was_inside_out},
            {"area_mm2", 1e6 * facts.area},
            {"volume_ml", facts.has_sure_volume() ? Json(1e6 * facts.volume) : Json()},
            {"center_of_mass_mm", triple(facts.center_of_mass, 1e3)}};
  json["part_count"] = survey.parts.size();
  json["parts"] = Json::array();
  const double unit = 1e3 * survey.data.scale;
  for (std::size_t k = 0; k < std::min(survey.parts.size(), MOST_WRITTEN); ++k) {
    const MeshPart& part = survey.parts[k];
    json["parts"].push_back(
        {{"triangles", part.triangles}, {"low_mm", triple(part.low, unit)}, {"high_mm", triple(part.high, unit)}});
  }
  json["reasons"] = {{"mesh_scale", survey.reasons.unit},
                     {"up", survey.reasons.up},
                     {"part", survey.reasons.parts},
                     {"holes", survey.reasons.holes}};
  json["keys"] = Json::object();
  for (const SceneKey& key : scene_keys(survey)) json["keys"][key.key] = key.value;
  if (survey.cavity.cavity) {
    const FoundCavity& cavity = *survey.cavity.cavity;
    json["cavity"] = {{"floor_mm", 1e3 * cavity.floor},
                      {"brim_mm", 1e3 * cavity.brim},
                      {"capacity_ml", 1e6 * cavity.capacity},
                      {"outline_capacity_ml", 1e6 * cavity.outline.volume},
                      {"beneath_ml", 1e6 * cavity.beneath},
                      {"off_round_mm", 1e3 * cavity.off_round},
                      {"off_round_height_mm", 1e3 * cavity.off_round_height},
                      {"off_rays_ml", 1e6 * cavity.off_rays},
                      {"outline_off_mm", 1e3 * cavity.outline.off_profile},
                      {"passing_rays", cavity.passing_rays},
                      {"is_brim_rough", cavity.is_brim_rough}};
    json["cavity"]["profile_mm"] = Json::array();
    for (const ProfilePoint& p : cavity.profile) json["cavity"]["profile_mm"].push_back({1e3 * p[0], 1e3 * p[1]});
  } else {
    json["cavity"] = nullptr;
    json["no_cavity"] = survey.cavity.refusal;
  }
  const PreparedLattice& lattice = survey.lattice.lattice;
  json["lattice"] = {{"spacing_mm", 1e3 * lattice.spacing},
                     {"samples", std::size_t{1} * lattice.nx * lattice.ny * lattice.nz},
                     {"seconds", survey.lattice.seconds}};
  return json_text(json, 2);
}

std::vector<SceneKey> scene_keys(const MeshSurvey& survey) {
  const MeshData& data = survey.data;
  std::vector<SceneKey> keys{{"mesh_scale", fmt::format("{}", data.scale), "of the file's unit, in m"},
                             {"up", '"' + up_key(data) + '"', "of the file"}};
  if (data.rotate != Triple{}) {
    Triple turn{};
    for (int k = 0; k < 3; ++k) turn[k] = degrees(data.rotate[k]);
    keys.push_back({"rotate_deg", written_triple(turn, 1), "stands it up"});
  }
  if (!data.parts.empty()) keys.push_back({"part", part_text(data.parts), fmt::format("of {}", survey.parts.size())});
  if (data.close_holes) keys.push_back({"close_holes", "true", "closes what is missing of its walls"});
  if (data.thickness) keys.push_back({"thickness_mm", written(1e3 * *data.thickness), "of the walls behind the sheet"});
  keys.push_back({"origin",
                  data.origin           ? written_triple(*data.origin, 1e3)
                  : data.origin_at_base ? "\"base\""
                                        : "\"as_is\"",
                  data.origin           ? "where the cavity's axis meets the base"
                  : data.origin_at_base ? "the middle of its box, on the base"
                                        : "the file's, on the cavity's axis"});
  if (survey.cavity.cavity)
    keys.push_back({"inner_outline", outline_text(survey.cavity.cavity->outline.elements), "the cavity, as the mesh has it"});
  return keys;
}

std::string scene_of_mesh(NewScene wanted, const MeshSurvey& survey) {
  wanted.mesh_keys = scene_keys(survey);
  std::erase_if(wanted.mesh_keys, [&](const SceneKey& key) {
    return std::any_of(wanted.numbers.begin(), wanted.numbers.end(), [&](const auto& number) { return number.first == key.key; });
  });
  return new_scene(wanted);
}

}  // namespace wholehand
