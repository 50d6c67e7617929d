// SPDX-License-Identifier: MIT
// The search of tests/core/search_test.cpp on a device.
// sanitizers: none
#include <gtest/gtest.h>

#include <memory>

#include "tests/support/adversarial.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

TEST(SearchDevice, FloatIsFinite) {
  const Searched searched = search(search_grips(60000), [](const Scene& scene) -> Answer {
    const std::shared_ptr<host::GripBackend> device = backend_of(scene, all_fields(scene), Precision::single);
    return [device](std::size_t vessel, const std::vector<GripInput>& asked) { return gather(*device, vessel, asked); };
  });
  EXPECT_GT(4 * searched.feasible, searched.grips);
}

}  // namespace
}  // namespace wholehand
