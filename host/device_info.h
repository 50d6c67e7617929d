// SPDX-License-Identifier: MIT
// Lists Vulkan devices and chooses the requested one. The loader is opened at run time, so a machine without Vulkan prints a sentence instead of a
// dynamic linker's complaint.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/error.h"

namespace wholehand::host {

// Memory for a buffer or a submit was refused; a smaller one may succeed.
class OutOfMemory : public Error {
 public:
  explicit OutOfMemory(const std::string& line, Remedy remedy = Remedy::none) : Error(ExitCode::failure, line, remedy) {}
};

// The device was lost, or did not finish in time (`hung`: it may still be working).
class DeviceLost : public Error {
 public:
  explicit DeviceLost(const std::string& line, Remedy remedy = Remedy::none, bool hung = false)
      : Error(ExitCode::failure, line, remedy), hung(hung) {}
  bool hung;
};

enum class DeviceKind { discrete, integrated, virtual_gpu, cpu, other };  // in the order of preference
const char* device_kind_name(DeviceKind kind);                            // "discrete GPU", .., "CPU"

struct DeviceInfo {
  std::size_t index = 0;  // in list_devices(): what "vulkan:INDEX" chooses
  std::string name;       // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string driver;     // driver and version: "llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)"
  DeviceKind kind = DeviceKind::other;
  std::string api_version;                   // "1.3.230"
  std::string conformance;                   // version of the conformance tests that the driver passed: "1.3.1.1"; "0.0.0.0": none
  std::string uuid;                          // of device, 32 hexadecimal digits
  std::string unusable;                      // why the device cannot be used; empty: it can
  bool float64 = false;                      // shaders may compute in double
  std::vector<std::uint32_t> kept_widths{};  // widths (32, 64) of reals whose NaN, infinities and signed zeros shaders may rely on
  bool unified_memory = false;               // the host can access the device's memory directly
  bool timestamps = false;                   // the device times kernels (else the host's clock does)
  std::uint32_t subgroup_size = 0;
  std::uint64_t memory = 0;             // of the largest device-local heap, bytes
  std::uint64_t max_allocation = 0;     // of one allocation, bytes
  std::uint64_t max_storage_range = 0;  // of one storage buffer, bytes
  std::uint64_t max_uniform_range = 0;  // of one uniform buffer, bytes
  std::uint64_t max_texel_range = 0;    // of one texel buffer of uints, bytes: 256 KiB at least
  std::uint32_t max_group_invocations = 0;
  std::array<std::uint32_t, 3> max_group_size{};
  std::uint32_t max_storage_buffers = 0;  // of one kernel
  std::array<std::uint32_t, 3> max_group_count{};
  std::uint32_t shared_memory = 0;  // of a work group, bytes
};

struct DeviceOptions {
  bool validation = false;        // the validation layer; also on where the environment has WHOLEHAND_VALIDATION=1
  bool has_own_instance = false;  // share none with other devices of the process
  std::string loader{};           // the library without which there is no Vulkan; empty: libvulkan.so.1 (a test names another)
  bool unified_memory = true;     // false: stage every transfer, as a discrete GPU needs (for tests on a CPU driver)
  double wait_seconds = 120;      // longest wait for what runs once and for a stream's first chunk, in which the driver may compile
  std::string cache_folder{};     // of compiled pipelines; empty: $XDG_CACHE_HOME/wholehand, and none for a CPU driver
};

// Whether it is Mesa's CPU driver, which gets the wide build of the kernels (shaders/build.glsl).
bool is_llvmpipe(const DeviceInfo& device);

// All devices, in the loader's order. Throws Error: no loader, no driver, no validation layer.
std::vector<DeviceInfo> list_devices(const DeviceOptions& options = {});

// The device of `devices` that `selector` names. "vulkan" is the first by kind: discrete, integrated, virtual, CPU; "vulkan:1" is the one with that
// index. Another text is the first device, in the order of kinds, whose name contains it, ignoring case. Throws Error (usage), with the existing
// names, if there is none; it never returns another device instead.
const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, std::string_view selector);

// Messages of the validation layer since the last call, from all devices of the process.
std::vector<std::string> take_validation_messages();

}  // namespace wholehand::host
