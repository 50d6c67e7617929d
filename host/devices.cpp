// SPDX-License-Identifier: MIT
#include "host/devices.h"

#include <fmt/format.h>

#include "host/device.h"
#include "system/cache_folder.h"

namespace wholehand {

ExitCode list_devices() {
  const auto devices = host::list_devices();
  if (devices.empty()) throw failure_error("no Vulkan device; install a driver (mesa-vulkan-drivers has one for CPUs)");
  const host::DeviceInfo& first = host::choose_device(devices, "vulkan");
  for (const host::DeviceInfo& device : devices) {
    fmt::print("vulkan:{}  {}  ({}){}\n", device.index, device.name, host::device_kind_name(device.kind),
               device.index == first.index ? "  <- --on vulkan" : "");
    fmt::print("  driver {}, Vulkan {}\n", device.driver, device.api_version);
    if (!device.unusable.empty()) {
      fmt::print("  cannot be used: {}\n", device.unusable);
      continue;
    }
    fmt::print("  precision float{}; subgroups of {}; timestamps {}\n", device.float64 ? " and double" : " only",
               device.subgroup_size, device.timestamps ? "by the device" : "by the host's clock");
    constexpr double MEBI = 1 << 20;
    fmt::print("  memory {:.0f} MiB{}, one allocation {:.0f} MiB, one storage buffer {:.0f} MiB, shared memory {} KiB\n",
               static_cast<double>(device.memory) / MEBI, device.unified_memory ? " (the host's own)" : "",
               static_cast<double>(device.max_allocation) / MEBI, static_cast<double>(device.max_storage_range) / MEBI,
               device.shared_memory / 1024);
  }
  fmt::print("core  the reference, double precision, all threads  <- --on core\n");
  return ExitCode::done;
}

std::string cache_text() {
  const std::uintmax_t limit = cache_limit();
  const std::string folder = cache_folder();
  if (folder.empty()) return "cache  none: neither XDG_CACHE_HOME nor HOME is an absolute path\n";
  const CacheUse use = cache_use(folder);
  const std::string bound = limit > 0 ? fmt::format("at most {} MiB", limit / MEBIBYTE) : "not used";
  return fmt::format("cache  {}  {:.1f} MiB in {} file{}, {} (WHOLEHAND_CACHE_MIB)\n", folder,
                     static_cast<double>(use.bytes) / MEBIBYTE, use.files, use.files == 1 ? "" : "s", bound);
}

}  // namespace wholehand
