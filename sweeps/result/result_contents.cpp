// SPDX-License-Identifier: MIT
#include "sweeps/result/result_contents.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "base/text/text.h"
#include "core/joints.h"
#include "core/meshes/vessel.h"
#include "shaders/layout.h"
#include "sweeps/plan/rules.h"
#include "sweeps/result/result_definition.h"

namespace wholehand::sweeps {
namespace {

constexpr double NOT_YET_KNOWN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* JOINT_RADIUS = "joint_radius";
constexpr const char* FILL_FRACTION = "fill_fraction";
constexpr const char* FILL_VOLUME = "fill_volume";
constexpr const char* HEIGHT_MEANING = "height of the thumb-index line in the vessel's frame";

// The definition of a sweep's file.
class SweepDefinition : ResultDefinition {
 public:
  explicit SweepDefinition(const ResultContents& contents) : contents_(contents) {}
  SweepDefinition(const std::string& path, const ResultContents& contents) : ResultDefinition(path), contents_(contents) {}

  std::uint64_t count() {
    define();
    return size();
  }

  void write() {
    define();
    finish(grip_variables_);
  }

 private:
  void define() {
    dimensions();
    attributes();
    coordinates();
    fill_coordinates();
    vessel_variables();
    grip_variables();
    best_variables();
    grip_variables_.push_back(checksums());
  }

  bool has_dimension(const char* name) const {
    for (const Variable* chosen : contents_.variables) {
      for (const char* dim : chosen->dims) {
        if (std::strcmp(dim, name) == 0) return true;
      }
    }
    return false;
  }

  // Whether each hand scale has best grips of its own.
  bool has_best_scales() const { return contents_.best > 0 && contents_.plan.hand_scales() > 1; }

  void dimensions() {
    const Scene& scene = contents_.scene;
    dimension("vessel", scene.vessels.size());
    if (!contents_.plan.is_sobol()) {
      for (const PlanAxis& axis : contents_.plan.axes()) dimension(axis.name, axis.values.size());
    } else if (has_points()) {
      dimension("point", contents_.plan.grips());
    }
    if (scene.liquid || !scene.tilts.empty()) dimension("fill", scene_fills(scene));
    if (!scene.tilts.empty()) dimension("tilt", scene.tilts.size());
    dimension("joint", JOINT_COUNT);
    if (has_dimension("contact")) dimension("contact", 2);
    dimension("xyz", 3);
    if (has_best_scales() && contents_.plan.is_sobol())
      dimension(best_scale_dimension(contents_.plan), contents_.plan.hand_scales());
    if (contents_.best > 0) dimension("rank", contents_.best);
  }

  void attributes() {
    const Scene& scene = contents_.scene;
    const BackendInfo& info = contents_.info;
    text(NC_GLOBAL, "Conventions", "CF-1.8");
    text(NC_GLOBAL, "title", "grips of " + (scene.name.empty() ? std::string("a scene") : scene.name));
    text(NC_GLOBAL, "program", "wholehand");
    text(NC_GLOBAL, "version", contents_.version);
    text(NC_GLOBAL, "scene", scene.text);
    std::vector<std::string> rules;
    for (const Rule& rule : scene_rules(scene)) rules.push_back(fmt::format("{}: {}", rule.name, rule.text));
    text(NC_GLOBAL, "rules", joined(rules, "\n"));
    text(NC_GLOBAL, "backend", info.backend);
    text(NC_GLOBAL, "device", info.device);
    text(NC_GLOBAL, "driver", info.driver);
    text(NC_GLOBAL, "precision", info.precision == Precision::single ? "float" : "double");
    text(NC_GLOBAL, "sampling", contents_.plan.is_sobol() ? "sobol" : "grid");
    const unsigned long long seed = scene.grips.seed;
    numbers(NC_GLOBAL, "seed", NC_UINT64, 1, &seed);
    number(NC_GLOBAL, WALL_TIME, NOT_YET_KNOWN);
    number(NC_GLOBAL, KERNEL_TIME, NOT_YET_KNOWN);
    if (has_meshes(scene)) {
      text(NC_GLOBAL, SCENE_FILE, std::filesystem::absolute(scene.file).lexically_normal().string());
      text(NC_GLOBAL, MESHES, mesh_lines(scene));
      text(NC_GLOBAL, MESH_KEYS, mesh_keys(scene));
      text(NC_GLOBAL, MESH_LATTICES, mesh_lattices(scene));
    }
    if (contents_.plan.copies() > 1) {
      text(NC_GLOBAL, "azimuth", "evaluated at the first azimuth and repeated: the vessels are bodies of revolution");
    }
  }

  void coordinates() {
    const Scene& scene = contents_.scene;
    Names vessels;
    for (const VesselData& vessel : scene.vessels) vessels.push_back(vessel.name);
    labels("vessel", "vessel", vessels);
    if (contents_.plan.is_sobol()) {
      point_axes();
      if (has_best_scales()) {
        const std::string name = best_scale_dimension(contents_.plan);
        doubles(name, {name}, "1", "size of the hand of a list of best grips, times the scene's own scale",
                contents_.plan.axes()[PLACE_HAND_SCALE].values);
      }
    } else {
      grid_axes();
    }
    if (!scene.tilts.empty()) doubles("tilt", {"tilt"}, "rad", "tilt since the grasp", scene.tilts);
    labels("joint", "joint of the hand, in the order of the masks' bits", joint_names());
    doubles(JOINT_RADIUS, {"joint"}, "m", "distance from the joint to the skin, times hand_scale", joint_radii());
    if (has_dimension("contact")) labels("contact", "tracked finger", {"thumb", "index"});
    labels("xyz", "direction of the vessel frame, y along the axis", {"x", "y", "z"});
    if (contents_.best > 0) {
      std::vector<int> ranks(contents_.best);
      std::iota(ranks.begin(), ranks.end(), 1);
      integers("rank", {"rank"}, "1", "place among the vessel's best grips, 1 the best", ranks);
    }
    Names all{JOINT_RADIUS};
    if (has_own_heights()) all.push_back(HEIGHT);
    if (scene.liquid) all.insert(all.end(), {FILL_FRACTION, FILL_VOLUME});
    text(NC_GLOBAL, "coordinates", joined(all, " "));
  }

  // Points are stored with the grips; without grips there is nothing for which they would be coordinates.
  bool has_points() const { return contents_.plan.is_sobol() && !contents_.variables.empty(); }

  // If heights are fractions, every vessel has its own heights in m.
  bool has_own_heights() const { return contents_.plan.height_is_fraction() && (has_points() || !contents_.plan.is_sobol()); }

  void point_axes() {
    if (!has_points()) return;
    const auto per_point = [this](const std::string& name, const Names& dims, const std::string& units,
                                  const std::string& meaning) {
      grip_variables_.push_back(variable(name, NC_DOUBLE, dims, units, meaning));
      fill_value(grip_variables_.back(), NC_DOUBLE);
    };
    for (const PlanAxis& axis : contents_.plan.axes()) per_point(axis.name, {"point"}, axis.units, axis.long_name);
    if (has_own_heights()) per_point(HEIGHT, {"vessel", "point"}, "m", HEIGHT_MEANING);
  }

  void grid_axes() {
    const Plan& plan = contents_.plan;
    for (const PlanAxis& axis : plan.axes()) {
      doubles(axis.name, {axis.name}, axis.units, axis.long_name, axis.values);
      if (axis.axis != AXIS_HEIGHT || !has_own_heights()) continue;
      std::vector<double> heights;
      for (std::size_t v = 0; v < contents_.scene.vessels.size(); ++v)
        for (const double value : axis.values) heights.push_back(plan.height(v, value));
      doubles(HEIGHT, {"vessel", axis.name}, "m", HEIGHT_MEANING, heights);
    }
  }

  // `fill` as in the scene, and for each vessel both the fraction and the volume.
  void fill_coordinates() {
    const Scene& scene = contents_.scene;
    if (!scene.liquid && scene.tilts.empty()) return;
    if (scene.liquid && !scene.liquid->volumes.empty()) {
      doubles("fill", {"fill"}, "m3", "volume of the liquid, before any pours", scene.liquid->volumes);
    } else {
      doubles("fill", {"fill"}, "1", "liquid as a fraction of the capacity, before any pours",
              scene.liquid ? scene.liquid->fills : std::vector<double>{0});
    }
    if (!scene.liquid) return;
    std::vector<double> fractions, volumes;
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      for (const double fill : vessel_fills(scene, scene.vessels[v])) {
        fractions.push_back(fill);
        volumes.push_back(fill * contents_.facts[v].capacity);
      }
    }
    doubles(FILL_FRACTION, {"vessel", "fill"}, "1", "liquid as a fraction of the vessel's capacity, before any pours", fractions);
    doubles(FILL_VOLUME, {"vessel", "fill"}, "m3", "volume of the liquid in the vessel, before any pours", volumes);
  }

  std::vector<double> joint_radii() const {
    const HandData& hand = contents_.scene.hand;
    std::vector<double> radii;
    for (int finger = 0; finger < FINGER_COUNT; ++finger) {
      const auto& own = hand.fingers[finger].radii;
      for (std::size_t k = 0; k < (finger == 0 ? own.size() - 1 : own.size()); ++k) radii.push_back(hand.scale * own[k]);
    }
    return radii;
  }

  static Names joint_names() {
    Names names;
    for (int joint = 0; joint < JOINT_COUNT; ++joint) names.push_back(joint_key(joint));
    return names;
  }

  void vessel_variables() {
    const Scene& scene = contents_.scene;
    const auto per_vessel = [&](auto value) {
      std::vector<double> values;
      for (std::size_t v = 0; v < scene.vessels.size(); ++v) value(v, values);
      return values;
    };
    const auto& facts = contents_.facts;
    doubles("vessel_height", {"vessel"}, "m", "height of the vessel's mouth",
            per_vessel([&](std::size_t v, auto& out) { out.push_back(scene.vessels[v].height); }));
    doubles("vessel_base", {"vessel"}, "m", "height of the vessel's lowest point, from where height fractions count",
            per_vessel([&](std::size_t v, auto& out) { out.push_back(scene.vessels[v].base); }));
    doubles("capacity", {"vessel"}, "m3", "volume of the upright vessel to the brim",
            per_vessel([&](std::size_t v, auto& out) { out.push_back(facts[v].capacity); }));
    doubles("empty_mass", {"vessel"}, "kg", "mass of the empty vessel",
            per_vessel([&](std::size_t v, auto& out) { out.push_back(facts[v].empty_mass); }));
    doubles("empty_center_of_mass", {"vessel", "xyz"}, "m", "center of mass of the empty vessel, vessel frame",
            per_vessel([&](std::size_t v, auto& out) {
              out.insert(out.end(), facts[v].empty_center_of_mass.begin(), facts[v].empty_center_of_mass.end());
            }));
    if (!scene.liquid) return;
    doubles("pouring_tilt", {"vessel", "fill"}, "rad", "tilt at which pouring starts, NaN where there is nothing to pour",
            per_vessel([&](std::size_t v, auto& out) {
              out.insert(out.end(), facts[v].pouring_tilt.begin(), facts[v].pouring_tilt.end());
            }));
    if (scene.tilts.empty()) return;
    const auto liquid = [&](const char* name, const char* units, const char* long_name, double LiquidResult::*member) {
      doubles(name, {"vessel", "fill", "tilt"}, units, long_name, per_vessel([&](std::size_t v, auto& out) {
                for (const LiquidResult& state : facts[v].liquid) out.push_back(state.*member);
              }));
    };
    liquid("liquid_volume", "m3", "volume of the liquid left", &LiquidResult::volume);
    liquid("liquid_mass", "kg", "mass of the liquid left", &LiquidResult::mass);
    liquid("liquid_lean", "m", "center of mass of the liquid along the horizontal direction of tilting, vessel frame",
           &LiquidResult::lean);
    liquid("liquid_height", "m", "center of mass of the liquid along the vessel's axis", &LiquidResult::height);
    liquid("poured_volume", "m3", "volume of the liquid poured on the way to the tilt", &LiquidResult::poured);
  }

  void grip_variables() {
    const nc_type real = contents_.info.precision == Precision::single ? NC_FLOAT : NC_DOUBLE;
    for (const Variable* chosen : contents_.variables) {
      const nc_type type = chosen->type == NumberType::real ? real : chosen->type == NumberType::byte ? NC_BYTE : NC_INT;
      Names dims{"vessel"};
      dims.insert(dims.end(), chosen->dims.begin(), chosen->dims.end());
      const Names grip = grip_dimensions(contents_.plan);
      dims.insert(dims.end(), grip.begin(), grip.end());
      const int id = variable(chosen->name, type, dims, chosen->units, chosen->long_name);
      if (chosen->has_missing()) fill_value(id, type);
      if (chosen->bits > 0) mask_flags(id, *chosen);
      const std::string comment = variable_comment(*chosen, contents_.scene);
      if (!comment.empty()) text(id, "comment", comment);
      if (std::strcmp(chosen->name, "reason") == 0) reason_flags(id);
      if (std::strcmp(chosen->name, "score") == 0) score_weights(id);
      name_coordinates(id, *chosen);
      grip_variables_.push_back(id);
    }
  }

  // A bit's meaning is one word: a finger's or a joint's name.
  void mask_flags(int id, const Variable& mask) {
    std::vector<int> bits;
    for (int k = 0; k < mask.bits; ++k) bits.push_back(1 << k);
    const std::vector<signed char> small(bits.begin(), bits.end());
    const bool is_byte = mask.type == NumberType::byte;
    numbers(id, "flag_masks", is_byte ? NC_BYTE : NC_INT, bits.size(),
            is_byte ? static_cast<const void*>(small.data()) : bits.data());
    const Names names = mask.bits == JOINT_COUNT ? joint_names() : Names(FINGER_NAMES.begin(), FINGER_NAMES.end());
    text(id, "flag_meanings", joined(names, " "));
  }

  void reason_flags(int id) {
    std::string meanings = "none";
    std::vector<signed char> values{0};
    for (std::size_t i = 1; i < REASON_NAMES.size(); ++i) {
      meanings += fmt::format(" {}", REASON_NAMES[i]);
      values.push_back(static_cast<signed char>(i));
    }
    numbers(id, "flag_values", NC_BYTE, values.size(), values.data());
    text(id, "flag_meanings", meanings);
  }

  void score_weights(int id) {
    const auto weights = effective_weights(contents_.scene);
    numbers(id, "score_weights", NC_DOUBLE, weights.size(), weights.data());
    text(id, "score_terms", "score_fingers score_contacts score_depth score_posture score_force score_hold");
  }

  // Coordinates of a variable that are no dimension of it.
  void name_coordinates(int id, const Variable& chosen) {
    Names names;
    if (contents_.plan.is_sobol()) {
      for (const PlanAxis& axis : contents_.plan.axes()) names.push_back(axis.name);
    }
    if (has_own_heights()) names.push_back(HEIGHT);
    for (const std::string_view dim : chosen.dims) {
      if (dim == "joint") names.push_back(JOINT_RADIUS);
      if (dim == "fill" && contents_.scene.liquid) names.insert(names.end(), {FILL_FRACTION, FILL_VOLUME});
    }
    if (!names.empty()) text(id, "coordinates", joined(names, " "));
  }

  void best_variables() {
    if (contents_.best == 0) return;
    Names lists{"vessel", "rank"};
    if (has_best_scales()) lists.insert(lists.begin() + 1, best_scale_dimension(contents_.plan));
    const auto define = [&](const std::string& name, nc_type type, const char* units, const std::string& long_name) {
      const int id = variable(name, type, lists, units, long_name);
      grip_variables_.push_back(id);
      return id;
    };
    // without a missing value, so that xarray opens it as an integer, as an index should be
    const int grip = define(BEST_GRIP, NC_INT64, "1", "best grips: index over all dimensions of the grips, the last one fastest");
    text(grip, "comment", "-1 beyond the last feasible, plausible grip that holds");
    fill_value(define(BEST_SCORE, NC_DOUBLE, "1", "best grips: score"), NC_DOUBLE);
    for (const PlanAxis& axis : contents_.plan.axes()) {
      const bool is_height = axis.axis == AXIS_HEIGHT;
      const std::string meaning = "best grips: " + (is_height ? std::string(HEIGHT_MEANING) : axis.long_name);
      fill_value(define(best_axis_name(axis), NC_DOUBLE, is_height ? "m" : axis.units.c_str(), meaning), NC_DOUBLE);
    }
    const int refined =
        define(REFINED_SCORE, NC_DOUBLE, "1", "best grips: score where it is largest within half a step of the axes");
    text(refined, "comment", "by the core in double precision");
    fill_value(refined, NC_DOUBLE);
    for (const PlanAxis& axis : contents_.plan.axes()) {
      if (!is_refined_axis(axis)) continue;
      const bool is_height = axis.axis == AXIS_HEIGHT;
      const std::string meaning = "refined best grips: " + (is_height ? std::string(HEIGHT_MEANING) : axis.long_name);
      fill_value(define(refined_axis_name(axis), NC_DOUBLE, is_height ? "m" : axis.units.c_str(), meaning), NC_DOUBLE);
    }
    if (!contents_.scene.robust) return;
    const std::string over = fmt::format("over {} random deviations by [robust]", contents_.scene.robust->count);
    for (const auto& [name, what] : {std::pair{ROBUST_MEAN, "mean of the score "},
                                     {ROBUST_LOW, "10th percentile of the score "},
                                     {ROBUST_SHARE, "share that is feasible, plausible and held "}})
      fill_value(define(name, NC_DOUBLE, "1", "best grips: " + (what + over)), NC_DOUBLE);
  }

  const ResultContents& contents_;
  std::vector<int> grip_variables_;  // written later, block by block
};

}  // namespace

std::vector<std::string> grip_dimensions(const Plan& plan) {
  if (plan.is_sobol()) return {"point"};
  std::vector<std::string> names;
  for (const PlanAxis& axis : plan.axes()) names.push_back(axis.name);
  return names;
}

std::string best_axis_name(const PlanAxis& axis) {
  return "best_" + (axis.axis == AXIS_HEIGHT ? std::string("height") : axis.name);
}

std::string refined_axis_name(const PlanAxis& axis) { return "best_refined_" + best_axis_name(axis).substr(5); }

bool is_refined_axis(const PlanAxis& axis) { return axis.axis != AXIS_HAND_SCALE; }

std::string best_scale_dimension(const Plan& plan) { return plan.is_sobol() ? "listed_hand_scale" : "hand_scale"; }

std::uint64_t result_size(ResultContents contents) {
  contents.facts.resize(contents.scene.vessels.size());
  return SweepDefinition(contents).count();
}

void define_result_file(const std::string& path, const ResultContents& contents) { SweepDefinition(path, contents).write(); }

}  // namespace wholehand::sweeps
