// SPDX-License-Identifier: MIT
#include "evidence/check/check.h"

#include <pybind11/stl.h>

#include "app/python/bind.h"
#include "app/python/scene.h"
#include "host/open_backend.h"

namespace py = pybind11;

namespace wholehand {
namespace {

// Whether it holds, the program's text, and its JSON.
py::tuple check(SceneHandle& handle, const std::string& on) {
  prepare_device(on);
  CheckReport report;
  {
    const py::gil_scoped_release other_threads;
    CheckOptions options;
    options.on = on;
    options.is_quiet = true;
    report = check_scene(handle.whole(on), options);
  }
  return py::make_tuple(verdict_of(report).holds, check_text(report), check_json(report));
}

}  // namespace

void bind_check(py::module_& module) { module.def("check", &check, py::arg("scene"), py::arg("on")); }

}  // namespace wholehand
