// SPDX-License-Identifier: MIT
#include "app/commands/open_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "app/program/values.h"
#include "base/text/error.h"
#include "core/reader/ranges.h"
#include "core/reader/text.h"
#include "device/grippers/haply_gripper.h"
#include "device/grippers/hid_gripper.h"
#include "device/grippers/omega_gripper.h"
#include "device/grippers/osc_gripper.h"
#include "device/grippers/usb_gripper.h"
#include "device/simulated/sim_gripper.h"

namespace wholehand {
namespace {

constexpr IntegerRange OMEGA_NUMBER{0, device::LARGEST_OMEGA_SERIAL};
constexpr int ANY_PORT = 0;  // that is free
#ifdef HAS_VIEWER
constexpr const char* NO_VIEW = "add --view";
#else
constexpr const char* NO_VIEW = "this program is built without the viewer (WHOLEHAND_VIEWER)";
#endif

// PORT, of this machine alone, or HOST:PORT.
HostPort parse_osc_place(const std::string& text) {
  HostPort place{"127.0.0.1", 0};
  std::string wrong;
  if (text.find(':') != std::string::npos)
    wrong = read_host_port(text, ANY_PORT, place);
  else if (!read_port(text, ANY_PORT, place.port))
    wrong = fmt::format("its port is not a whole number from {} to {}", ANY_PORT, LARGEST_PORT);
  if (!wrong.empty()) {
    throw usage_error(
        fmt::format("--device {}: {}; allowed: osc:PORT, or osc:HOST:PORT with an address of this machine; for example "
                    "osc:9000",
                    in_quotes("osc:" + text), wrong));
  }
  return place;
}

// Whether an address can hold it as the id of a device.
bool is_haply_id(const std::string& id) {
  const auto is_plain = [](char letter) { return letter > ' ' && letter <= '~' && letter != ',' && letter != '/'; };
  return !id.empty() && std::all_of(id.begin(), id.end(), is_plain);
}

// haply[:PORT | :HOST:PORT][/ID | /LEFT_ID,RIGHT_ID]; nothing for another device.
std::optional<device::HaplyAddress> parse_haply(const std::string& device) {
  constexpr std::string_view HAPLY = "haply";
  if (device.rfind(HAPLY, 0) != 0) return std::nullopt;
  const std::size_t slash = device.find('/');
  const std::string place = device.substr(HAPLY.size(), slash == std::string::npos ? slash : slash - HAPLY.size());
  if (!place.empty() && place[0] != ':') return std::nullopt;
  device::HaplyAddress address;
  std::string wrong;
  if (place.find(':', 1) != std::string::npos)
    wrong = read_host_port(place.substr(1), 1, address.at);
  else if (!place.empty() && !read_port(place.substr(1), 1, address.at.port))
    wrong = fmt::format("its port is not a whole number from 1 to {}", LARGEST_PORT);
  if (slash != std::string::npos) {
    const std::string ids = device.substr(slash + 1);
    const std::size_t comma = ids.find(',');
    address.arms = {ids.substr(0, comma), comma == std::string::npos ? "" : ids.substr(comma + 1)};
    const bool has_ids = is_haply_id(address.arms[0]) && (comma == std::string::npos || is_haply_id(address.arms[1]));
    if (wrong.empty() && !has_ids) wrong = "behind the / it needs one or two ids";
  }
  if (!wrong.empty()) {
    throw usage_error(
        fmt::format("--device {}: {}; allowed: haply, haply:PORT or haply:HOST:PORT, and behind it /ID or "
                    "/LEFT_ID,RIGHT_ID with ids that `wholehand devices` shows; for example haply/049D,04BA",
                    in_quotes(device), wrong));
  }
  return address;
}

}  // namespace

std::optional<HostPort> osc_place(const std::string& device) {
  constexpr std::string_view OSC = "osc:";
  if (device.rfind(OSC, 0) != 0) return std::nullopt;
  return parse_osc_place(device.substr(OSC.size()));
}

std::unique_ptr<device::Gripper> open_gripper(const std::string& device, const Scene& scene, std::uint64_t seed,
                                              const std::string& library, double watchdog, device::ViewInput* view,
                                              const std::function<void(const std::string&)>& say) {
  const std::size_t colon = device.find(':');
  const std::string kind = device.substr(0, colon), which = colon == std::string::npos ? "" : device.substr(colon + 1);
  const bool is_bare = colon == std::string::npos;
  if (device == "sim") return device::open_sim(scene, seed);
  if (device == "view") {
    if (!view)
      throw usage_error(std::string("--device view: the page of the view is the gripper, and there is no view; ") + NO_VIEW);
    return device::open_view(scene, *view);
  }
  if (kind == "hid" && (is_bare || !which.empty())) return device::open_hid(which, watchdog);
  if (kind == "usb" && (is_bare || !which.empty())) return device::open_usb(which, watchdog);
  if (kind == "omega" && (is_bare || !which.empty())) {
    const int number = is_bare ? 0 : static_cast<int>(parse_integer(which, "--device omega", OMEGA_NUMBER));
    return device::open_omega(library.empty() ? scene.device.library : library, watchdog, number);
  }
  if (const std::optional<HostPort> place = osc_place(device)) return device::open_osc(*place, scene, say);
  if (const std::optional<device::HaplyAddress> address = parse_haply(device))
    return device::open_haply(*address, scene, watchdog, say);
  throw usage_error(fmt::format(
      "--device {}: allowed: sim, view, replay:FILE, hid, hid:PATH, usb, usb:VID:PID, omega, omega:N, haply, "
      "haply:PORT, haply:HOST:PORT, osc:PORT or osc:HOST:PORT; haply may end in /IDS; `wholehand devices` lists what is there",
      in_quotes(device)));
}

}  // namespace wholehand
