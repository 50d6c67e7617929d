// SPDX-License-Identifier: MIT
#include "device/grippers/find_grippers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stand_in_dhd.h"

namespace wholehand::device {
namespace {

TEST(FindGrippers, SimAndThePageAreAlwaysThereAndOmegaWithItsSdk) {
  const StandIn sdk(STAND_IN_DHD);
  for (const char* library : {STAND_IN_DHD, "/not/there/libdhd.so"}) {
    const auto found = find_grippers(library);
    ASSERT_GE(found.size(), 2u);
    EXPECT_EQ(found[0].address, "sim");
    EXPECT_EQ(found[0].name, "a virtual user, always there");
    EXPECT_EQ(found[0].missing, "");
    EXPECT_EQ(found[1].address, "view");
    EXPECT_EQ(found[1].missing, "");
    const bool has_omega =
        std::any_of(found.begin(), found.end(), [](const GripperFound& gripper) { return gripper.address == "omega"; });
    EXPECT_EQ(has_omega, library == std::string(STAND_IN_DHD));
  }
}

}  // namespace
}  // namespace wholehand::device
