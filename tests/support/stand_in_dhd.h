// SPDX-License-Identifier: MIT
// The stand-in for Force Dimension's SDK as a test holds it.
#pragma once

#include <dlfcn.h>

#include <stdexcept>

#include "tests/stand_in/dhd_control.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"

namespace wholehand {

// A fresh stand-in, and a runtime directory of its own, so that tests that run at the same time do not lock each other out.
class StandIn {
 public:
  explicit StandIn(const char* path) {
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void* symbol = library ? dlsym(library, "stand_in_dhd") : nullptr;
    if (!symbol) throw std::runtime_error("no stand-in");
    control_ = reinterpret_cast<StandInDhd* (*)()>(symbol)();
    *control_ = StandInDhd{};
  }
  StandInDhd* operator->() const { return control_; }
  const TemporaryFolder& runtime_directory() const { return folder_; }

 private:
  TemporaryFolder folder_;
  ScopedVariable runtime_{"WHOLEHAND_LOCK_DIR", folder_.path().c_str()};
  ScopedVariable library_{"WHOLEHAND_DHD_LIBRARY", nullptr};
  StandInDhd* control_ = nullptr;
};

}  // namespace wholehand
