// SPDX-License-Identifier: MIT
#include "app/open_gripper.h"

#include <fmt/format.h>

#include "app/values.h"
#include "core/error.h"
#include "device/hid_gripper.h"
#include "device/omega_gripper.h"
#include "device/sim_gripper.h"
#include "device/usb_gripper.h"
#include "scene/ranges.h"
#include "scene/text.h"

namespace wholehand {
namespace {

constexpr IntegerRange OMEGA_NUMBER{0, 31};

}  // namespace

std::unique_ptr<Gripper> open_gripper(const std::string& device, const Scene& scene, std::uint64_t seed, const std::string& library,
                                      double watchdog, ViewInput* view) {
  const std::size_t colon = device.find(':');
  const std::string kind = device.substr(0, colon), which = colon == std::string::npos ? "" : device.substr(colon + 1);
  const bool is_bare = colon == std::string::npos;
  if (device == "sim") return open_sim(scene, seed);
  if (device == "view") {
    if (!view) throw usage_error("--device view: the page of the view is the gripper, and there is no view; add --view");
    return open_view(scene, *view);
  }
  if (kind == "hid" && (is_bare || !which.empty())) return open_hid(which, watchdog);
  if (kind == "usb" && (is_bare || !which.empty())) return open_usb(which, watchdog);
  if (kind == "omega" && (is_bare || !which.empty())) {
    const int number = is_bare ? 0 : static_cast<int>(parse_integer(which, "--device omega", OMEGA_NUMBER));
    return open_omega(library.empty() ? scene.device.library : library, watchdog, number);
  }
  throw usage_error(
      fmt::format("--device {}: allowed: sim, view, replay:FILE, hid, hid:PATH, usb, usb:VID:PID, omega or omega:N; `wholehand "
                  "devices` lists what is there",
                  in_quotes(device)));
}

}  // namespace wholehand
