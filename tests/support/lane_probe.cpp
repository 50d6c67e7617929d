// SPDX-License-Identifier: MIT
#include "tests/support/lane_probe.h"

#include <algorithm>
#include <vector>

#include "host/commands.h"
#include "host/run_once.h"
#include "shaders/layout.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand {
namespace {

constexpr std::uint32_t INVOCATIONS = 4096;  // whole groups
constexpr std::uint32_t TURNS = 32;          // at most; some devices have more lanes

}  // namespace

LaneCounts counted_lanes(const host::Device& on) {
  const std::vector<host::Constant> constants{{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}};
  const host::Kernel kernel(on, test_shader("probe_lanes"), constants, "probe_lanes");
  const host::Buffer lanes(on, 2 * sizeof(std::uint32_t));
  host::Commands commands;
  commands.bind(BINDING_LANES, lanes);
  commands.clear(BINDING_LANES);
  commands.dispatch(kernel, host::groups_for(on, kernel, INVOCATIONS), Push{INVOCATIONS, 0, 0, TURNS});
  host::run_once(on, commands);
  const auto found = lanes.read_as<std::uint32_t>(2);
  return {found[0], found[1]};
}

LaneCounts expected_lanes(const host::Device& on) {
  const std::uint32_t size = std::max(1u, on.info().subgroup_size), subgroups = INVOCATIONS / size;
  LaneCounts expected{0, subgroups * size * std::min(size, TURNS)};
  for (std::uint32_t lane = 0; lane < size; ++lane) expected.useful += subgroups * ((lane % TURNS + 2) / 2);
  return expected;
}

}  // namespace wholehand
