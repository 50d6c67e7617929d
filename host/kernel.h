// SPDX-License-Identifier: MIT
// A compute shader with its specialization constants, ready for dispatch.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "host/device.h"

namespace wholehand::host {

// Value of a specialization constant. Floating values become the shader's float or double; integers become its int, uint or bool. An id that the
// shader lacks is ignored, as in Vulkan (one list then serves every variant of a shader).
struct Constant {
  std::uint32_t id = 0;
  std::variant<std::int32_t, std::uint32_t, float, double> value;
  bool operator==(const Constant&) const = default;
};

struct KernelState;  // vulkan.h

// A compute pipeline. Bindings (set 0) and group size come from the SPIR-V: the pipeline's layout has exactly the bindings that the shader uses.
// Throws Error: a constant of the wrong kind, a group larger than the device's limit, a capability that the device lacks.
class Kernel {
 public:
  static constexpr std::size_t MAX_PUSH = 128;  // bytes of push constants that every device supports

  Kernel(const Device& device, std::span<const std::uint32_t> words, std::span<const Constant> constants, std::string name);
  Kernel(const DeviceState& device, std::span<const std::uint32_t> words, std::span<const Constant> constants, std::string name);
  ~Kernel();
  Kernel(Kernel&&) noexcept;
  Kernel& operator=(Kernel&&) noexcept;

  const std::string& name() const;
  const std::vector<std::uint32_t>& words() const;  // the module as the driver got it
  const std::array<std::uint32_t, 3>& group_size() const;
  bool uses(std::uint32_t binding) const;

  KernelState& state() const { return *state_; }  // for host/ alone

 private:
  std::unique_ptr<KernelState> state_;
};

}  // namespace wholehand::host
