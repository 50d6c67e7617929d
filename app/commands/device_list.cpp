// SPDX-License-Identifier: MIT
#include "app/commands/device_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/program/remedy.h"
#include "base/system/output.h"
#include "base/text/readable.h"
#include "host/run_once.h"

namespace wholehand {

namespace {

// As gripper_lines says it of a gripper.
void print_no_vulkan(const std::string& why) { print("vulkan  cannot be used: " + why + "\n"); }

std::string rounding_line(const host::DeviceInfo& info) {
  try {
    const host::Device device("vulkan:" + std::to_string(info.index), {.wait_seconds = 10});
    const std::vector<Precision> contracted = host::contracted_precisions(device);
    if (contracted.empty()) return "  rounds products before it adds them, as the kernels ask (NoContraction)\n";
    return fmt::format(
        "  does NOT round products before it adds them, as the kernels ask (NoContraction), in {}; run wholehand check --on "
        "vulkan:{}\n",
        contracted.size() > 1                     ? "float and double"
        : contracted.front() == Precision::single ? "float"
                                                  : "double",
        info.index);
  } catch (const Error& error) {
    return fmt::format("  cannot be opened: {}\n", error.what());
  }
}

void print_vulkan_devices() {
  const auto devices = host::list_devices();
  if (devices.empty()) return print_no_vulkan("no Vulkan device; install a driver (mesa-vulkan-drivers has one for CPUs)");
  const bool has_usable = std::any_of(devices.begin(), devices.end(), [](const auto& device) { return device.unusable.empty(); });
  const std::size_t first = has_usable ? host::choose_device(devices, "vulkan").index : devices.size();
  for (const host::DeviceInfo& device : devices) {
    print(fmt::format("vulkan:{}  {}  ({}){}\n", device.index, device.name, host::device_kind_name(device.kind),
                      device.index == first ? "  <- --on vulkan" : ""));
    const std::string conformance = device.conformance.empty()        ? ""
                                    : device.conformance == "0.0.0.0" ? ", passed no conformance tests"
                                                                      : ", passed the conformance tests " + device.conformance;
    print(fmt::format("  driver {}, Vulkan {}{}\n", device.driver, device.api_version, conformance));
    if (!device.unusable.empty()) {
      print(fmt::format("  cannot be used: {}\n", device.unusable));
      continue;
    }
    print(fmt::format("  precision float{}; subgroups of {}; timestamps {}\n", device.float64 ? " and double" : " only",
                      device.subgroup_size, device.timestamps ? "by the device" : "by the host's clock"));
    const auto mebibytes = [](std::uint64_t bytes) { return readable_count(static_cast<double>(bytes) / (1 << 20)); };
    print(fmt::format("  memory {} MiB{}, one allocation {} MiB, one storage buffer {} MiB, shared memory {} KiB\n",
                      mebibytes(device.memory), device.unified_memory ? " (the host's own)" : "", mebibytes(device.max_allocation),
                      mebibytes(device.max_storage_range), readable_number(device.shared_memory / 1024)));
    print(rounding_line(device));
  }
}

}  // namespace

void print_devices() {
  try {
    print_vulkan_devices();
  } catch (const Error& error) {  // its other remedy, the core, is the next line
    print_no_vulkan(error.what());
  }
  print("core  the reference, double precision, all threads  <- --on core\n");
}

std::string gripper_lines(const std::vector<device::GripperFound>& found) {
  std::string lines;
  for (const device::GripperFound& gripper : found) {
    const std::string missing = gripper.missing + remedy_words(gripper.remedy);
    if (gripper.address.empty()) {
      lines += fmt::format("{}  cannot be opened: {}\n", gripper.name, missing);
      continue;
    }
    lines += fmt::format("{}  {}  <- --device {}\n", gripper.address, gripper.name, gripper.address);
    if (!gripper.summary.empty()) lines += fmt::format("  {}\n", gripper.summary);
    if (!missing.empty()) lines += fmt::format("  missing: {}\n", missing);
  }
  return lines;
}

}  // namespace wholehand
