// SPDX-License-Identifier: MIT
// Chooses the requested device.
#include "host/device_info.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace wholehand::host {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string names_of(const std::vector<DeviceInfo>& devices) {
  std::string names;
  for (const DeviceInfo& device : devices) {
    names += (names.empty() ? "" : ", ") + ("vulkan:" + std::to_string(device.index)) + " " + device.name;
  }
  return names.empty() ? "no device" : names;
}

const DeviceInfo* first_usable(const std::vector<DeviceInfo>& devices, const std::string& part_of_name) {
  const DeviceInfo* best = nullptr;
  for (const DeviceInfo& device : devices) {
    if (device.unusable.empty() && lower(device.name).find(part_of_name) != std::string::npos &&
        (!best || device.kind < best->kind)) {
      best = &device;
    }
  }
  return best;
}

}  // namespace

bool is_llvmpipe(const DeviceInfo& device) { return device.kind == DeviceKind::cpu && device.name.starts_with("llvmpipe"); }

const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, std::string_view selector) {
  constexpr std::string_view PREFIX = "vulkan";
  const DeviceInfo* chosen = nullptr;
  if (selector.empty() || selector == PREFIX) {
    chosen = first_usable(devices, "");
  } else if (selector.starts_with("vulkan:")) {
    std::size_t index = devices.size();
    const char* end = selector.data() + selector.size();
    const auto [rest, error] = std::from_chars(selector.data() + PREFIX.size() + 1, end, index);
    if (error == std::errc() && rest == end && index < devices.size()) {
      chosen = &devices[index];
    }
  } else if (selector.find_first_not_of("0123456789") != std::string_view::npos) {  // a number alone is no name
    chosen =
        first_usable(devices, lower(selector) == "lavapipe" ? "llvmpipe" : lower(selector));  // the driver's name for its device
  }
  if (!chosen) {
    throw usage_error("no Vulkan device \"" + std::string(selector) + "\" that can be used; there: core, " + names_of(devices));
  }
  if (!chosen->unusable.empty()) {
    throw usage_error("Vulkan device " + chosen->name + " cannot be used: " + chosen->unusable + "; there: " + names_of(devices));
  }
  return *chosen;
}

}  // namespace wholehand::host
