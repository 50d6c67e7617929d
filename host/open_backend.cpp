// SPDX-License-Identifier: MIT
#include "host/open_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/system/clock.h"
#include "base/system/progress.h"
#include "base/text/error.h"
#include "core/core_backend.h"
#include "host/device.h"
#include "host/grip_backend.h"

namespace wholehand {

std::unique_ptr<Backend> open_backend(const Scene& scene, const FieldSet& fields, const std::string& on, Precision precision,
                                      int threads, const host::CompileWatch& watch) {
  if (on.empty()) throw usage_error("the name of the device is empty; give core, vulkan or a device's name");
  if (on == "core") {
    auto evaluator = precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
    return std::make_unique<CoreBackend>(std::move(evaluator), scene, fields, precision, threads);
  }
  host::GripBackendOptions options;
  options.precision = precision;
  options.compile_watch = watch;
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, on, options);
}

host::CompileWatch show_compiling() {
  return [start = monotonic_now(), is_shown = false](const host::DeviceInfo& device, std::size_t done, std::size_t count) mutable {
    if (done < count && monotonic_now() - start < 1) return;
    if (done < count) show_status(fmt::format("compiling kernels for {} (first time), {} of {}", device.name, done, count));
    if (done == count && is_shown) show_status("");
    is_shown = done < count;
  };
}

std::uint64_t largest_buffer(const std::string& on) {
  if (on == "core") return std::numeric_limits<std::uint64_t>::max();
  const std::vector<host::DeviceInfo> devices = host::list_devices();
  const host::DeviceInfo& device = host::choose_device(devices, on);
  return std::min(device.max_storage_range, device.max_texel_range);
}

}  // namespace wholehand
