// SPDX-License-Identifier: MIT
// Kernels that are made side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/device.h"
#include "host/kernel.h"

namespace wholehand::host {

// The arguments of Kernel's constructor. The words outlive the device.
struct KernelRequest {
  std::string name;
  std::span<const std::uint32_t> words;
  std::vector<Constant> constants;
  std::size_t texel_bytes = 0;  // size of the kernel's texel buffer, which llvmpipe compiles into the code
};

// Called on the thread of compile(), ten times a second until all kernels are there, and once more at the end, also where that is a failure.
using CompileWatch = std::function<void(const DeviceInfo& device, std::size_t done, std::size_t count)>;

// Makes a kernel of each request on all cores, in the order of the requests. llvmpipe compiles a kernel when it first runs; here it does so at once.
// Throws DeviceLost where the driver completes no kernel within DeviceOptions::wait_seconds; `device` is abandoned then, with the threads that wait
// for the driver. Throws as Kernel's constructor does.
std::vector<Kernel> compile(Device& device, const DeviceOptions& options, std::vector<KernelRequest> requests,
                            const CompileWatch& watch = {});

}  // namespace wholehand::host
