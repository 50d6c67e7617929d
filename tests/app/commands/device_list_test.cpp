// SPDX-License-Identifier: MIT
// How what is found is listed.
#include "app/commands/device_list.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

TEST(DeviceList, GrippersThatCanBeOpenedAndWhatIsMissing) {
  EXPECT_EQ(gripper_lines({{"sim", "a virtual user", "", ""},
                           {"omega:1", "omega.7, left hand", "up to 12 N", ""},
                           {"hid:/dev/hidraw0", "grip", "up to 2 N", "a udev rule"},
                           {"", "usb", "", "none attached"},
                           {"", "omega", "", "no SDK; name its path", Remedy::name_library}}),
            "sim  a virtual user  <- --device sim\n"
            "omega:1  omega.7, left hand  <- --device omega:1\n"
            "  up to 12 N\n"
            "hid:/dev/hidraw0  grip  <- --device hid:/dev/hidraw0\n"
            "  up to 2 N\n"
            "  missing: a udev rule\n"
            "usb  cannot be opened: none attached\n"
            "omega  cannot be opened: no SDK; name its path (--dhd-library, [device] library of the scene, or the environment "
            "variable WHOLEHAND_DHD_LIBRARY)\n");
}

}  // namespace
}  // namespace wholehand
