// SPDX-License-Identifier: MIT
// Compiles kernels in parallel.
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

// Called on compile()'s thread ten times a second until all kernels exist, and once at the end, also after a failure.
using CompileWatch = std::function<void(const DeviceInfo& device, std::size_t done, std::size_t count)>;

// Makes a kernel for each request on all cores, in the order of the requests. llvmpipe would compile a kernel when it first runs; this forces it to
// do so now. Throws DeviceLost if the driver completes no kernel within DeviceOptions::wait_seconds; `device` is then abandoned, with the threads
// that wait for the driver. Also throws what Kernel's constructor throws.
std::vector<Kernel> compile(Device& device, const DeviceOptions& options, std::vector<KernelRequest> requests,
                            const CompileWatch& watch = {});

}  // namespace wholehand::host
