// SPDX-License-Identifier: MIT
#include "app/python/scene.h"

#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string_view>

#include "app/program/remedy.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "app/python/bind.h"
#include "base/system/version.h"
#include "base/text/error.h"
#include "core/domain.h"
#include "core/meshes/vessel.h"
#include "core/planes.h"
#include "core/reader/new_scene.h"
#include "core/reader/ranges.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/open_backend.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/cavity_notes.h"
#include "sweeps/plan/idle_notes.h"
#include "sweeps/plan/plan.h"

namespace py = pybind11;

namespace wholehand {
namespace {

// A scene says so in [output] keep.
constexpr std::string_view KEY_OF_SCENE = ": [output] keep: ";

}  // namespace

// choose_variables knows what the scene lacks and what to say.
std::vector<const sweeps::Variable*> named_variables(const Scene& scene, const std::vector<std::string>& names,
                                                     const std::string& place) {
  Scene asked = scene;
  asked.output.keep = names;
  asked.output.keep_place = place;
  try {
    sweeps::choose_variables(asked);
  } catch (const Error& error) {
    std::string line = error.what();
    if (line.starts_with(place + std::string(KEY_OF_SCENE))) line.replace(place.size(), KEY_OF_SCENE.size(), ": ");
    throw Error(error.code, line, error.remedy);
  }
  std::vector<const sweeps::Variable*> variables;
  for (const std::string& name : names)
    for (const sweeps::Variable& variable : sweeps::variable_catalogue())
      if (name == variable.name) variables.push_back(&variable);
  return variables;
}

const Scene& SceneHandle::whole(const std::string& on) {
  const std::lock_guard lock(mutex_);
  return whole_locked(on);
}

const Scene& SceneHandle::whole_locked(const std::string& on) {
  if (!has_meshes(described_)) return described_;
  std::unique_ptr<const Scene>& kept = read_[on];
  if (kept) return *kept;
  Scene scene = described_;
  MeshOptions options;
  options.is_quiet = true;
  options.most_bytes = largest_lattice(largest_buffer(on));
  if (mesh_notes_.empty()) options.say = [this](const std::string& line) { mesh_notes_.push_back(line); };
  load_meshes(scene, options);
  kept = std::make_unique<const Scene>(std::move(scene));
  return *kept;
}

std::shared_ptr<const Evaluator> SceneHandle::core() {
  const std::lock_guard lock(mutex_);
  if (!core_) core_ = make_core_evaluator(whole_locked("core"));
  return core_;
}

std::shared_ptr<Batch> SceneHandle::batch(const BatchSpec& spec) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(batches_.begin(), batches_.end(), [&](const auto& kept) { return kept.first == spec; });
  if (found != batches_.end()) {
    batches_.splice(batches_.begin(), batches_, found);
    return batches_.front().second;
  }
  const Scene& scene = whole_locked(spec.on);
  auto made = std::make_shared<Batch>();
  made->variables = spec.variables ? named_variables(scene, *spec.variables, "variables") : sweeps::choose_variables(scene);
  const FieldSet fields = make_field_set(sweeps::variable_fields(made->variables), scene);
  made->backend = open_backend(scene, fields, spec.on, spec.precision, spec.threads);
  batches_.emplace_front(spec, made);
  if (batches_.size() > KEPT_BATCHES) batches_.pop_back();
  return made;
}

std::vector<std::string> SceneHandle::notes() {
  const Scene& scene = whole();
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines = mesh_notes_;
  for (const std::string& line : sweeps::cavity_notes(scene)) lines.push_back(line);
  if (const std::string line = sweeps::idle_strength_note(scene); !line.empty()) lines.push_back(line);
  return lines;
}

std::vector<std::string> SceneHandle::float_notes(Precision precision) {
  if (precision == Precision::full) return {};
  const Scene& scene = whole();
  const std::lock_guard lock(mutex_);
  if (!float_notes_) {
    std::vector<std::string> lines = domain_warnings(scene, precision);
    for (std::string& line : lines) line += remedy_words(Remedy::double_precision);
    float_notes_ = lines;
  }
  return *float_notes_;
}

namespace {

std::atomic<pid_t> opened_by{0};  // process; 0: none

}  // namespace

bool is_forked_from_device() { return opened_by != 0 && opened_by != getpid(); }

void prepare_device(const std::string& on) {
  if (on == "core") return;
  // A driver's threads and its connection to the device stay behind in a fork; using them there would wait forever.
  const pid_t here = getpid();
  pid_t nobody = 0;
  if (!opened_by.compare_exchange_strong(nobody, here) && nobody != here)
    throw failure_error(
        "a device was opened before this process was forked, and cannot be used in it; start processes with \"spawn\"");
  prepare_vulkan_environment(on);
}

Precision precision_of(const std::optional<std::string>& text, const std::string& on) {
  if (text) return parse_precision(*text);
  return on == "core" ? Precision::full : Precision::single;
}

int checked_threads(int threads) {
  return threads == 0 ? 0 : static_cast<int>(parse_integer(std::to_string(threads), "--threads", ranges::THREADS));
}

namespace {

using HandlePointer = std::shared_ptr<SceneHandle>;

HandlePointer open_scene(const std::string& path_or_name) {
  return std::make_shared<SceneHandle>(read_scene_file(find_scene(path_or_name)));
}

HandlePointer parse_text(const std::string& text, const std::string& name) {
  return std::make_shared<SceneHandle>(parse_scene(text, name));
}

// The scene of a result, whose meshes must be those of the sweep.
HandlePointer scene_of_dataset(const std::string& text, const std::string& source, const std::string& scene_file,
                               const std::string& version, const std::string& keys, const std::string& lattices) {
  check_version(source.empty() ? "" : source + ": ", version, "run the sweep again");
  Scene scene = parse_scene(text, "the result's scene");
  if (!scene_file.empty()) scene.file = scene_file;
  const std::string refusal = reload_meshes(scene, source, keys, lattices, true);
  if (!refusal.empty()) throw usage_error("the result's scene: " + refusal);
  return std::make_shared<SceneHandle>(std::move(scene));
}

std::string new_text(const std::string& name, const std::string& shape, const std::vector<std::pair<std::string, double>>& numbers,
                     std::optional<double> fill) {
  NewScene wanted;
  wanted.name = name;
  wanted.shape = shape;
  wanted.numbers = numbers;
  wanted.fill = fill;
  return new_scene(wanted);
}

std::vector<std::string> vessel_names(const SceneHandle& scene) {
  std::vector<std::string> names;
  for (const VesselData& vessel : scene.described().vessels) names.push_back(vessel.name);
  return names;
}

std::vector<double> fills_of(const SceneHandle& handle, std::size_t vessel) {
  const Scene& scene = handle.described();
  if (vessel >= scene.vessels.size()) throw usage_error("the scene has no vessel of this number");
  return scene.liquid ? vessel_fills(scene, scene.vessels[vessel]) : std::vector<double>{0};
}

// Whether a sweep that keeps these variables computes one azimuth for all.
bool repeats_azimuths(const SceneHandle& handle, const std::vector<std::string>& names) {
  std::vector<const sweeps::Variable*> variables;
  for (const sweeps::Variable& variable : sweeps::variable_catalogue())
    if (std::find(names.begin(), names.end(), variable.name) != names.end()) variables.push_back(&variable);
  return sweeps::Plan(handle.described(), sweeps::keeps_vectors(variables)).copies() > 1;
}

// Number of hand scales; a sweep makes a list of the grips of each.
std::size_t hand_scales(const SceneHandle& handle) { return sweeps::Plan(handle.described(), false).hand_scales(); }

py::list variable_rows(SceneHandle& handle) {
  std::vector<const sweeps::Variable*> known;
  for (const sweeps::Variable& variable : sweeps::variable_catalogue()) {
    if (field_planes(variable.field, handle.described()) == 0) continue;
    try {
      named_variables(handle.described(), {variable.name}, "");
    } catch (const Error&) {
      continue;  // of what the scene lacks
    }
    known.push_back(&variable);
  }
  py::list rows;
  for (const sweeps::Variable* variable : known) {
    const std::vector<std::string> dims(variable->dims.begin(), variable->dims.end());
    rows.append(py::make_tuple(variable->name, variable->units, variable->long_name,
                               sweeps::variable_comment(*variable, handle.described()), py::tuple(py::cast(dims))));
  }
  return rows;
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<SceneHandle, HandlePointer>(module, "Scene")
      .def_property_readonly("name", [](const SceneHandle& scene) { return scene.described().name; })
      .def_property_readonly("file", [](const SceneHandle& scene) { return scene.described().file; })
      .def_property_readonly("text", [](const SceneHandle& scene) { return scene.described().text; })
      .def_property_readonly("vessels", &vessel_names)
      .def_property_readonly("tilts", [](const SceneHandle& scene) { return scene.described().tilts; })
      .def_property_readonly("apart", [](const SceneHandle& scene) { return scene.described().output.apart; })
      .def_property_readonly("has_robust", [](const SceneHandle& scene) { return scene.described().robust.has_value(); })
      .def("robust_candidates",
           [](const SceneHandle& scene, std::size_t best) { return sweeps::robust_candidates(scene.described(), best); })
      .def_property_readonly("hand_scales", &hand_scales)
      .def_property_readonly("has_effort", [](const SceneHandle& handle) { return has_effort(handle.described()); })
      .def_property_readonly("best", [](const SceneHandle& scene) { return scene.described().output.best; })
      .def("fills", &fills_of, py::arg("vessel"))
      .def(
          "find_vessel", [](const SceneHandle& scene, const std::string& name) { return find_vessel(scene.described(), name); },
          py::arg("name"))
      .def("repeats_azimuths", &repeats_azimuths, py::arg("variables"))
      .def("variables", &variable_rows)
      .def("notes", &SceneHandle::notes, py::call_guard<py::gil_scoped_release>())
      .def(
          "float_notes",
          [](SceneHandle& scene, const std::optional<std::string>& precision, const std::string& on) {
            return scene.float_notes(precision_of(precision, on));
          },
          py::arg("precision"), py::arg("on"), py::call_guard<py::gil_scoped_release>());
  module.def("open_scene", &open_scene, py::arg("path_or_name"));
  module.def("parse_scene", &parse_text, py::arg("text"), py::arg("name"));
  module.def("scene_of_dataset", &scene_of_dataset, py::arg("text"), py::arg("source"), py::arg("scene_file"), py::arg("version"),
             py::arg("keys"), py::arg("lattices"), py::call_guard<py::gil_scoped_release>());
  module.def("new_scene_keys", [] {
    std::vector<std::string> names;
    for (const NewSceneKey& key : new_scene_keys()) names.emplace_back(key.name);
    return names;
  });
  module.def("new_scene", &new_text, py::arg("name"), py::arg("shape"), py::arg("numbers"), py::arg("fill"));
  module.def("shipped_scenes", &shipped_scenes);
}

}  // namespace wholehand
