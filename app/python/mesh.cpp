// SPDX-License-Identifier: MIT
// What `wholehand mesh` finds of a mesh file.
#include <pybind11/stl.h>

#include "app/python/bind.h"
#include "core/meshes/survey.h"
#include "sweeps/grips/vessel_section.h"

namespace py = pybind11;

namespace wholehand {

void bind_mesh(pybind11::module_& module) {
  py::class_<MeshSurvey>(module, "Survey")
      .def("json", &survey_json)
      .def("lines", &survey_lines)
      .def("svg", [](const MeshSurvey& survey) { return sweeps::vessel_section(survey, survey.data.file); })
      .def(
          "scene_text",
          [](const MeshSurvey& survey, const std::string& name, const std::vector<std::pair<std::string, double>>& numbers,
             std::optional<double> fill) {
            NewScene wanted;
            wanted.name = name;
            wanted.mesh = survey.data.file;
            wanted.numbers = numbers;
            wanted.fill = fill;
            return scene_of_mesh(wanted, survey);
          },
          py::arg("name"), py::arg("numbers"), py::arg("fill"));
  module.def(
      "survey_mesh",
      [](const std::string& file, std::optional<double> scale, std::optional<bool> z_is_up, const std::vector<int>& parts,
         std::optional<double> thickness) {
        return survey_mesh({file, scale, z_is_up, parts, thickness});
      },
      py::arg("file"), py::arg("scale"), py::arg("z_is_up"), py::arg("parts"), py::arg("thickness"),
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace wholehand
