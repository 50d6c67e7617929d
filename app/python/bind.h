// SPDX-License-Identifier: MIT
// The parts of the module wholehand._core, one file each. Users call app/python/wholehand/*.py, which has the documentation.
#pragma once

#include <pybind11/pybind11.h>

namespace wholehand {

void bind_errors(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_evaluate(pybind11::module_& module);
void bind_sweep(pybind11::module_& module);
void bind_grip(pybind11::module_& module);
void bind_check(pybind11::module_& module);
void bind_mesh(pybind11::module_& module);
void bind_session(pybind11::module_& module);

}  // namespace wholehand
