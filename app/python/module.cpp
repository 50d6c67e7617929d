// SPDX-License-Identifier: MIT
#include "app/python/bind.h"
#include "base/system/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace wholehand;
  module.doc() = "What the package wholehand is made of, in C++. Not for users: it may change with every version.";
  module.def("version", &version);
  bind_errors(module);
  bind_scene(module);
  bind_evaluate(module);
  bind_sweep(module);
  bind_grip(module);
#ifdef HAS_EVIDENCE
  bind_check(module);
#endif
  bind_mesh(module);
  bind_session(module);
}
