// SPDX-License-Identifier: MIT
// What a Vulkan device can do at most, by compute shaders.
#pragma once

#include "core/backend.h"
#include "host/device.h"

namespace wholehand::bench {

// Operations a second: a multiply-add asked for as one (`fused`, by fma), and as a product and a sum. Two operations both.
struct DevicePeak {
  double fused = 0, apart = 0;
};
DevicePeak device_peak(const host::Device& on, Precision precision);

// Bytes a second, read and written together, of a kernel that copies a buffer that no cache holds.
double device_copy_rate(const host::Device& on);

}  // namespace wholehand::bench
