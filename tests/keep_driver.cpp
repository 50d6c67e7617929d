// SPDX-License-Identifier: MIT
// Linked into what runs under the leak sanitizer: keeps lavapipe and the validation layer loaded to the end of the process. Lavapipe
// leaks 128 bytes when it is unloaded, and neither a suppression nor a reader can distinguish a leak in an unloaded library from ours.
#include <dlfcn.h>

#include <initializer_list>

namespace wholehand {
namespace {

[[maybe_unused]] const bool kept = [] {
  for (const char* library : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"}) {
    dlopen(library, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);  // where it is not there, there is nothing to keep
  }
  return true;
}();

}  // namespace
}  // namespace wholehand
