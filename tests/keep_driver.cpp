// SPDX-License-Identifier: MIT
// Linked into what runs under the leak sanitizer: keeps lavapipe and the validation layer loaded to the end of the process.
// Lavapipe leaks
// 128 bytes when it is unloaded, and a leak in a library that is no longer there can be told from ours neither by a suppression nor
// by a reader.
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
