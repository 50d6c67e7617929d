// SPDX-License-Identifier: MIT
// Everything that `wholehand grip` knows of one grip.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "app/program/values.h"
#include "app/python/bind.h"
#include "app/python/columns.h"
#include "app/python/scene.h"
#include "base/files/files.h"
#include "base/text/error.h"
#include "core/capacity.h"
#include "core/meshes/vessel.h"
#include "core/reader/fills.h"
#include "core/reader/text.h"
#include "host/open_backend.h"
#include "sweeps/grips/glb.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/svg.h"
#include "sweeps/lists/robust.h"
#include "sweeps/result/output_names.h"
#include "sweeps/run/auto_backend.h"

namespace py = pybind11;

namespace wholehand {
namespace {

GripInput input_of(const GripNumbers& numbers) { return {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]}; }

// Parsed like an option's text, so that refusals use the same words.
double quantity(double value, const char* option, const Quantity& range) {
  return parse_quantity(fmt::format("{}", value), option, range);
}

Triple point(const std::array<double, 3>& values, const char* option) {
  return parse_triple(fmt::format("{},{},{}", values[0], values[1], values[2]), option, ranges::POINT);
}

GripNumbers grip_at(double height, double azimuth, double obliquity, double roll, double offset, double hand_scale) {
  GripInput grip;
  grip.height = quantity(height, "--height-mm", ranges::GRIP_HEIGHT);
  grip.azimuth = quantity(azimuth, "--azimuth-deg", ranges::ROTATION);
  grip.obliquity = quantity(obliquity, "--obliquity-deg", ranges::OBLIQUITY);
  grip.roll = quantity(roll, "--roll-deg", ranges::ROTATION);
  grip.offset = quantity(offset, "--offset-mm", ranges::OFFSET);
  grip.hand_scale = quantity(hand_scale, "--hand-scale", ranges::SCALE);
  return grip_columns(grip);
}

GripNumbers grip_between(const std::array<double, 3>& thumb, const std::array<double, 3>& index, double roll, double hand_scale) {
  const double turn = quantity(roll, "--roll-deg", ranges::ROTATION), scale = quantity(hand_scale, "--hand-scale", ranges::SCALE);
  return grip_columns(sweeps::grip_through(point(thumb, "--thumb-mm"), point(index, "--index-mm"), turn, scale));
}

// The request besides the grip. Fills are fractions; volumes in mL replace them.
struct StateSpec {
  std::optional<std::vector<double>> fills, volumes, tilts;
};

sweeps::StateAxes axes_of(const StateSpec& spec, const Scene& scene, std::size_t vessel) {
  sweeps::StateAxes axes = sweeps::scene_axes(scene, vessel);
  if (spec.tilts) {
    axes.tilts.clear();
    for (const double tilt : *spec.tilts) axes.tilts.push_back(quantity(tilt, "tilts_deg", ranges::TILT));
  }
  if (!spec.fills && !spec.volumes) return axes;
  // Python's own names, which do not follow the options' by a rule
  const char* option = spec.volumes ? "fills_ml" : "fills";
  if (spec.fills && spec.volumes) throw usage_error("fills and fills_ml are both given; allowed: one of the two");
  if (!scene.liquid)
    throw usage_error(
        fmt::format("{0}: {1} has no [liquid]; add one with its fills, or leave {0} out", option, in_quotes(scene.file)));
  if (axes.tilts.empty())
    throw usage_error(fmt::format("{}: {} has no [tilts]; give tilts_deg too", option, in_quotes(scene.file)));
  axes.fills.clear();
  const VesselData& held = scene.vessels[vessel];
  for (const double fill : spec.fills.value_or(std::vector<double>{}))
    axes.fills.push_back(quantity(fill, option, ranges::FRACTION));
  axes.capacity = spec.volumes ? capacity_of(held) : 0;
  for (const double volume : spec.volumes.value_or(std::vector<double>{}))
    axes.fills.push_back(fraction_of_capacity(held, axes.capacity, quantity(volume, option, ranges::FILL_VOLUME),
                                              fmt::format("{} {}", option, volume)));
  return axes;
}

// A grip's report, and the scene that its drawings need.
class GripHandle {
 public:
  GripHandle(Scene scene, std::size_t vessel, const GripInput& grip, const StateSpec& spec, const std::string& on,
             Precision precision, bool has_quality)
      : scene_(std::move(scene)), vessel_(vessel) {
    const sweeps::StateAxes axes = axes_of(spec, scene_, vessel);
    read_meshes(grip, on);
    report_ = sweeps::make_grip_report(scene_, vessel, grip, axes, sweeps::open_grip_methods(scene_, on, precision));
    sweeps::add_holding(report_, scene_, vessel);
    if (has_quality) sweeps::add_quality(report_, scene_, vessel);
  }

  std::string json() const { return sweeps::grip_json(report_); }
  std::string table() const {
    sweeps::GripReport judged = report_;
    sweeps::add_held_share(judged, scene_, vessel_);
    return sweeps::grip_verdict(scene_, judged) + "\n" + sweeps::grip_table(judged);
  }
  std::string svg() const { return sweeps::grip_svg(scene_, vessel_, report_); }
  std::string glb() const { return sweeps::grip_glb(scene_, vessel_, report_); }

  void write_svg(const std::string& path) const { write(path, "--svg", sweeps::GRIP_SVG_MARK, "drawing of wholehand's", svg()); }
  void write_glb(const std::string& path) const {
    write(path, "--glb", sweeps::GRIP_GLB_MARK, "glTF binary of wholehand's", glb());
  }

 private:
  // Lattices extend as far as this hand needs.
  void read_meshes(const GripInput& grip, const std::string& on) {
    if (!has_meshes(scene_)) return;
    Scene asked = scene_;
    asked.grips.hand_scale = {{grip.hand_scale}};
    MeshOptions options;
    options.is_quiet = true;
    options.most_bytes = largest_lattice(largest_buffer(on));
    load_meshes(asked, options);
    scene_.vessels = asked.vessels;
  }

  void write(const std::string& path, const char* option, std::string_view mark, const char* what, const std::string& bytes) const {
    check_output_path(path, option);
    sweeps::check_not_the_scene(path, scene_, option);
    check_overwrites_marked(path, mark, what, option);
    write_whole_file(path, bytes, false);
  }

  Scene scene_;
  std::size_t vessel_;
  sweeps::GripReport report_;
};

std::unique_ptr<GripHandle> make_grip(const SceneHandle& handle, std::size_t vessel, const GripNumbers& numbers,
                                      std::optional<std::vector<double>> fills, std::optional<std::vector<double>> volumes,
                                      std::optional<std::vector<double>> tilts, const std::string& asked_on,
                                      const std::optional<std::string>& precision, bool has_quality) {
  const std::string on = asked_on == sweeps::ON_AUTO ? "core" : asked_on;
  prepare_device(on);
  const GripInput grip = input_of(numbers);
  check_grip(grip, "the grip");
  if (vessel >= handle.described().vessels.size()) throw usage_error("the scene has no vessel of this number");
  const StateSpec spec{std::move(fills), std::move(volumes), std::move(tilts)};
  const py::gil_scoped_release other_threads;
  return std::make_unique<GripHandle>(handle.described(), vessel, grip, spec, on, precision_of(precision, on), has_quality);
}

}  // namespace

void bind_grip(py::module_& module) {
  py::class_<GripHandle>(module, "Grip")
      .def("json", &GripHandle::json)
      .def("table", &GripHandle::table)
      .def("svg", &GripHandle::svg)
      .def("glb", [](const GripHandle& grip) { return py::bytes(grip.glb()); })
      .def("write_svg", &GripHandle::write_svg, py::arg("path"))
      .def("write_glb", &GripHandle::write_glb, py::arg("path"));
  module.def("grip_at", &grip_at, py::arg("height_mm"), py::arg("azimuth_deg"), py::arg("obliquity_deg"), py::arg("roll_deg"),
             py::arg("offset_mm"), py::arg("hand_scale"));
  module.def("grip_between", &grip_between, py::arg("thumb_mm"), py::arg("index_mm"), py::arg("roll_deg"), py::arg("hand_scale"));
  module.def("grip", &make_grip, py::arg("scene"), py::arg("vessel"), py::arg("grip"), py::arg("fills"), py::arg("volumes_ml"),
             py::arg("tilts_deg"), py::arg("on"), py::arg("precision"), py::arg("quality"));
}

}  // namespace wholehand
