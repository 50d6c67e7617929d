// SPDX-License-Identifier: MIT
#include "device/grippers/find_grippers.h"

#include "device/grippers/haply_service.h"
#include "device/grippers/hid_gripper.h"
#include "device/grippers/omega_gripper.h"
#include "device/grippers/usb_gripper.h"

namespace wholehand::device {
namespace {

void append(std::vector<GripperFound>& all, const std::vector<GripperFound>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

// Adds an entry that says what was searched for, where nothing of a kind is found.
std::vector<GripperFound> or_missing(std::vector<GripperFound> found, const char* kind, const char* looked_for) {
  if (found.empty()) {
    found.push_back({"", kind, "",
                     std::string(looked_for) +
                         "; one that is plugged in and not seen may need device/udev/60-wholehand.rules (docs/devices.md)"});
  }
  return found;
}

}  // namespace

std::vector<GripperFound> find_grippers(const std::string& dhd_library) {
  std::vector<GripperFound> all{{"sim", "a virtual user, always there", "", ""},
                                {"view", "the page of a live view: dragged in a browser, felt by nobody", "", ""}};
  append(all, or_missing(find_hid_grippers(), "hid", "no HID device speaks the open gripper protocol"));
  append(all, or_missing(find_usb_grippers(), "usb", "no USB device has an interface of the open gripper protocol"));
  append(all, find_omega_grippers(dhd_library));
  append(all, find_haply_grippers());
  return all;
}

}  // namespace wholehand::device
