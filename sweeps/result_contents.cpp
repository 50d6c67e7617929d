#include "sweeps/result_contents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netcdf.h>

#include <cstring>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "shaders/layout.h"
#include "sweeps/mesh_vessel.h"

namespace wholehand {
namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

void check(int status, const std::string& path) {
  if (status == NC_NOERR) return;
  const char* why = status > 0 ? std::strerror(status) : nc_strerror(status);
  throw failure_error(fmt::format("{}: cannot write the result file: {}; is the disk full?", path, why));
}

// The definition under way; closes the file whatever happens.
class Definition {
 public:
  Definition(const std::string& path, const ResultContents& contents) : path_(path), contents_(contents) {
    check(nc_create(path.c_str(), NC_NETCDF4 | NC_NOCLOBBER, &file_), path_);
  }
  ~Definition() {
    if (file_ >= 0) nc_abort(file_);
  }
  Definition(const Definition&) = delete;
  Definition& operator=(const Definition&) = delete;

  void write() {
    dimensions();
    attributes();
    coordinates();
    vessel_variables();
    grip_variables();
    best_variables();
    check(nc_enddef(file_), path_);
    for (const auto& put : values_) put();
    for (const int variable : grip_variables_) allocate(variable);
    const int file = file_;
    file_ = -1;
    check(nc_close(file), path_);
  }

 private:
  using Names = std::vector<std::string>;

  int dimension(const std::string& name, std::size_t length) {
    int id = -1;
    check(nc_def_dim(file_, name.c_str(), length, &id), path_);
    return id;
  }

  int dimension_id(const std::string& name) {
    int id = -1;
    check(nc_inq_dimid(file_, name.c_str(), &id), path_);
    return id;
  }

  void text(int variable, const char* name, const std::string& value) {
    check(nc_put_att_text(file_, variable, name, value.size(), value.c_str()), path_);
  }

  void number(int variable, const char* name, double value) {
    check(nc_put_att_double(file_, variable, name, NC_DOUBLE, 1, &value), path_);
  }

  // A variable with its units and name; contiguous, and not filled first: everything gets written.
  int variable(const std::string& name, nc_type type, const Names& dims, const std::string& units, const std::string& long_name) {
    std::vector<int> ids;
    for (const std::string& dim : dims) ids.push_back(dimension_id(dim));
    int id = -1;
    check(nc_def_var(file_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id), path_);
    if (type != NC_STRING) {
      if (!ids.empty()) check(nc_def_var_chunking(file_, id, NC_CONTIGUOUS, nullptr), path_);
      check(nc_def_var_fill(file_, id, NC_NOFILL, nullptr), path_);
    }
    if (!units.empty()) text(id, "units", units);
    text(id, "long_name", long_name);
    return id;
  }

  void fill_value(int variable, nc_type type) {
    const float real = std::numeric_limits<float>::quiet_NaN();
    const int missing = MISSING;
    const signed char small = MISSING;
    const long long large = MISSING;
    const void* value = &real;
    if (type == NC_DOUBLE) value = &NOT_A_NUMBER;
    if (type == NC_BYTE) value = &small;
    if (type == NC_INT) value = &missing;
    if (type == NC_INT64) value = &large;
    check(nc_put_att(file_, variable, "_FillValue", type, 1, value), path_);
  }

  void doubles(const std::string& name, const Names& dims, const std::string& units, const std::string& long_name,
               std::vector<double> values) {
    const int id = variable(name, NC_DOUBLE, dims, units, long_name);
    fill_value(id, NC_DOUBLE);
    values_.push_back([this, id, values = std::move(values)] { check(nc_put_var_double(file_, id, values.data()), path_); });
  }

  void labels(const std::string& name, const std::string& long_name, const Names& values) {
    const int id = variable(name, NC_STRING, {name}, "", long_name);
    values_.push_back([this, id, values] {
      std::vector<const char*> pointers;
      for (const std::string& value : values) pointers.push_back(value.c_str());
      check(nc_put_var_string(file_, id, pointers.data()), path_);
    });
  }

  bool has_dimension(const char* name) const {
    for (const Variable* chosen : contents_.variables) {
      for (const char* dim : chosen->dims) {
        if (std::strcmp(dim, name) == 0) return true;
      }
    }
    return false;
  }

  void dimensions() {
    const Scene& scene = contents_.scene;
    dimension("vessel", scene.vessels.size());
    if (!contents_.variables.empty()) {
      if (contents_.plan.is_sobol()) {
        dimension("point", contents_.plan.grips());
      } else {
        for (const PlanAxis& axis : contents_.plan.axes()) dimension(axis.name, axis.data.values.size());
      }
    }
    if (scene.liquid || !scene.tilts.empty()) dimension("fill", scene_fills(scene));
    if (!scene.tilts.empty()) dimension("tilt", scene.tilts.size());
    dimension("joint", JOINT_COUNT);
    if (has_dimension("contact")) dimension("contact", 2);
    dimension("xyz", 3);
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
    text(NC_GLOBAL, "backend", info.backend);
    text(NC_GLOBAL, "device", info.device);
    text(NC_GLOBAL, "driver", info.driver);
    text(NC_GLOBAL, "precision", info.precision == Precision::single ? "float" : "double");
    text(NC_GLOBAL, "sampling", contents_.plan.is_sobol() ? "sobol" : "grid");
    const unsigned long long seed = scene.grips.seed;
    check(nc_put_att_ulonglong(file_, NC_GLOBAL, "seed", NC_UINT64, 1, &seed), path_);
    number(NC_GLOBAL, WALL_TIME, NOT_A_NUMBER);
    number(NC_GLOBAL, KERNEL_TIME, NOT_A_NUMBER);
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
    if (!contents_.variables.empty()) {
      for (const PlanAxis& axis : contents_.plan.axes()) {
        if (contents_.plan.is_sobol()) {
          grip_variables_.push_back(variable(axis.name, NC_DOUBLE, {"point"}, axis.units, axis.long_name));
          fill_value(grip_variables_.back(), NC_DOUBLE);
        } else {
          doubles(axis.name, {axis.name}, axis.units, axis.long_name, axis.data.values);
        }
      }
    }
    if (scene.liquid || !scene.tilts.empty()) {
      doubles("fill", {"fill"}, "1", "liquid as a fraction of the capacity, before any pours",
              scene.liquid ? scene.liquid->fills : std::vector<double>{0});
    }
    if (!scene.tilts.empty()) doubles("tilt", {"tilt"}, "rad", "tilt since the grasp", scene.tilts);
    labels("joint", "joint of the hand, in the order of the masks' bits", joint_names());
    if (has_dimension("contact")) labels("contact", "tracked finger", {"thumb", "index"});
    labels("xyz", "direction of the vessel frame, y along the axis", {"x", "y", "z"});
  }

  static Names joint_names() {
    Names names;
    for (const char* joint : {"metacarpal", "proximal", "distal", "tip"}) names.push_back(fmt::format("thumb_{}", joint));
    for (int finger = 1; finger < FINGER_COUNT; ++finger) {
      for (const char* joint : {"metacarpal", "proximal", "intermediate", "distal", "tip"}) {
        names.push_back(fmt::format("{}_{}", FINGER_NAMES[finger], joint));
      }
    }
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
    doubles("empty_center_of_mass", {"vessel", "xyz"}, "m", "centre of mass of the empty vessel, vessel frame",
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
    liquid("liquid_lean", "m", "centre of mass of the liquid along the horizontal direction of tilting, vessel frame",
           &LiquidResult::lean);
    liquid("liquid_height", "m", "centre of mass of the liquid along the vessel's axis", &LiquidResult::height);
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
      fill_value(id, type);
      if (*chosen->comment) text(id, "comment", chosen->comment);
      if (std::strcmp(chosen->name, "reason") == 0) reason_flags(id);
      if (std::strcmp(chosen->name, "score") == 0) score_weights(id);
      if (contents_.plan.is_sobol()) point_coordinates(id);
      grip_variables_.push_back(id);
    }
  }

  void reason_flags(int id) {
    std::string meanings = "none";
    std::vector<signed char> values{0};
    for (std::size_t i = 1; i < REASON_NAMES.size(); ++i) {
      meanings += fmt::format(" {}", REASON_NAMES[i]);
      values.push_back(static_cast<signed char>(i));
    }
    check(nc_put_att_schar(file_, id, "flag_values", NC_BYTE, values.size(), values.data()), path_);
    text(id, "flag_meanings", meanings);
  }

  void score_weights(int id) {
    const auto weights = effective_weights(contents_.scene);
    check(nc_put_att_double(file_, id, "score_weights", NC_DOUBLE, weights.size(), weights.data()), path_);
    text(id, "score_terms", "score_fingers score_contacts score_depth score_posture score_force score_hold");
  }

  void point_coordinates(int id) {
    Names names;
    for (const PlanAxis& axis : contents_.plan.axes()) names.push_back(axis.name);
    text(id, "coordinates", fmt::format("{}", fmt::join(names, " ")));
  }

  void best_variables() {
    if (contents_.best == 0) return;
    const auto define = [&](const std::string& name, nc_type type, const char* units, const std::string& long_name) {
      const int id = variable(name, type, {"vessel", "rank"}, units, long_name);
      fill_value(id, type);
      grip_variables_.push_back(id);
    };
    define(BEST_GRIP, NC_INT64, "1", "best grips: index over all dimensions of the grips, the last one fastest");
    define(BEST_SCORE, NC_DOUBLE, "1", "best grips: score");
    for (const PlanAxis& axis : contents_.plan.axes()) {
      const bool is_height = axis.axis == AXIS_HEIGHT;
      define(best_axis_name(axis), NC_DOUBLE, is_height ? "m" : axis.units.c_str(),
             "best grips: " + (is_height ? std::string("height of the thumb-index line in the vessel's frame") : axis.long_name));
    }
  }

  // HDF5 gives a contiguous block its place in the file when something is first written to it.
  void allocate(int id) {
    int dims = 0;
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    check(nc_inq_var(file_, id, nullptr, nullptr, &dims, ids.data(), nullptr), path_);
    std::vector<std::size_t> last(dims);
    for (int k = 0; k < dims; ++k) {
      check(nc_inq_dimlen(file_, ids[k], &last[k]), path_);
      --last[k];
    }
    const std::array<double, 1> zero{};  // large enough for every type
    check(nc_put_var1(file_, id, last.data(), zero.data()), path_);
  }

  std::string path_;
  const ResultContents& contents_;
  int file_ = -1;
  std::vector<int> grip_variables_;            // written later, block by block
  std::vector<std::function<void()>> values_;  // written once the definition stands
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

std::uint64_t result_size(const ResultContents& contents) {
  constexpr std::uint64_t STRUCTURE = 2 << 20;  // HDF5's own, generously
  const Scene& scene = contents.scene;
  const Plan& plan = contents.plan;
  const std::size_t real_size = contents.info.precision == Precision::single ? sizeof(float) : sizeof(double);
  const auto per_grip = static_cast<std::uint64_t>(bytes_per_grip(contents.variables, scene, real_size));
  std::uint64_t numbers = contents.best * scene.vessels.size() * 8;
  for (const PlanAxis& axis : plan.axes()) numbers += plan.is_sobol() ? plan.grips() : axis.data.values.size();
  numbers += scene.vessels.size() * (10 + scene_fills(scene) * (1 + 5 * scene.tilts.size()));
  return STRUCTURE + 2 * scene.text.size() + per_grip * plan.stored_grips() * scene.vessels.size() + numbers * sizeof(double);
}

void define_result_file(const std::string& path, const ResultContents& contents) { Definition(path, contents).write(); }

}  // namespace wholehand
