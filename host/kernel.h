// A compute shader with its specialization constants, ready to be dispatched, and the list of dispatches that a submit runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "host/buffer.h"
#include "host/device.h"

namespace wholehand::host {

// Value of a specialization constant. Floating values become the shader's float or double, integers its int, uint or bool; an id
// that the shader lacks is ignored, as Vulkan does (one list then serves every variant of a shader).
struct Constant {
  std::uint32_t id = 0;
  std::variant<std::int32_t, std::uint32_t, float, double> value;
};

// A compute pipeline. Bindings (set 0) and group size are read from the SPIR-V: the pipeline's layout has exactly the bindings that
// the shader uses. Throws Error: a constant of the wrong kind, a group larger than the device's limit, a capability that it lacks.
class Kernel {
 public:
  Kernel(const Device& device, std::span<const std::uint32_t> words, std::span<const Constant> constants, std::string name);
  ~Kernel();
  Kernel(Kernel&&) noexcept;
  Kernel& operator=(Kernel&&) noexcept;

  const std::string& name() const;
  const std::array<std::uint32_t, 3>& group_size() const;
  bool uses(std::uint32_t binding) const;

  struct Impl;  // vulkan.h, for host/ alone
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// What one submit does, in order. Each step sees what those before it wrote.
class Commands {
 public:
  static constexpr std::size_t MAX_PUSH = 128;  // bytes: what every device takes

  // From here on `binding` is `buffer` in every kernel that uses it. The buffer must outlive the submit.
  void bind(std::uint32_t binding, const Buffer& buffer);

  // Runs x * y * z groups. Every binding that the kernel uses must be bound (Error otherwise, as for more groups than the device
  // takes). `push` is a plain struct of up to MAX_PUSH bytes, laid out as the shader's push constants (std430).
  void dispatch(const Kernel& kernel, std::array<std::uint32_t, 3> groups);
  template <class Push>
  void dispatch(const Kernel& kernel, std::array<std::uint32_t, 3> groups, const Push& push) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= MAX_PUSH && sizeof(Push) % 4 == 0);
    dispatch(kernel, groups);
    steps_.back().push_size = sizeof(Push);
    std::memcpy(steps_.back().push.data(), &push, sizeof(Push));
  }

  // Zeroes the buffer bound there.
  void clear(std::uint32_t binding);

  // The buffer bound there, to bind it elsewhere: one kernel's output as the next one's input. Throws Error when there is none.
  const Buffer& bound(std::uint32_t binding) const;

  struct Step {
    const Kernel* kernel = nullptr;  // null: zero `buffers[0]`
    std::array<std::uint32_t, 3> groups{};
    std::vector<const Buffer*> buffers;  // in the order of the kernel's bindings
    std::array<std::byte, MAX_PUSH> push{};
    std::uint32_t push_size = 0;
  };
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<std::pair<std::uint32_t, const Buffer*>> bound_;
  std::vector<Step> steps_;
};

// Groups for `items` invocations in x: along x as far as the device goes, then along y. The shader's index, below the items, is
//   (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x
std::array<std::uint32_t, 3> groups_for(const Device& device, const Kernel& kernel, std::size_t items);

// Runs the commands and waits. Returns the device's seconds in them. The first dispatch of a kernel may include its compilation.
double run_once(const Device& device, const Commands& commands);

}  // namespace wholehand::host
