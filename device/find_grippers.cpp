#include "device/find_grippers.h"

#include <fmt/format.h>

#include "device/omega_gripper.h"

namespace wholehand {
namespace {

void append(std::vector<GripperFound>& all, const std::vector<GripperFound>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

}  // namespace

std::vector<GripperFound> find_grippers(const std::string& dhd_library) {
  std::vector<GripperFound> all{{"sim", "a virtual user, always there", "", ""}};
  append(all, find_omega_grippers(dhd_library));
  return all;
}

std::string list_grippers(const std::vector<GripperFound>& found) {
  std::string lines;
  for (const GripperFound& gripper : found) {
    if (gripper.address.empty()) {
      lines += fmt::format("{}  cannot be opened: {}\n", gripper.name, gripper.missing);
      continue;
    }
    lines += fmt::format("{}  {}  <- --device {}\n", gripper.address, gripper.name, gripper.address);
    if (!gripper.summary.empty()) lines += fmt::format("  {}\n", gripper.summary);
    if (!gripper.missing.empty()) lines += fmt::format("  missing: {}\n", gripper.missing);
  }
  return lines;
}

}  // namespace wholehand
