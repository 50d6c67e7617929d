// SPDX-License-Identifier: MIT
#include "device/grippers/haply_service.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/error.h"

namespace wholehand::device {
namespace {

constexpr double CONNECT_PATIENCE = 2;    // s: for each of its steps
constexpr double INVENTORY_PATIENCE = 2;  // s
constexpr const char* UPDATE = "update it in the Haply Hub to 3.1 or later";

// Service 3.5 answers on its own port, earlier ones on that of format 3.0.
haply::Version find_version(const HostPort& at, const std::string& place) {
  haply::Version version;
  const char* wrong = haply::read_version(http_get(at, "/version", CONNECT_PATIENCE), version);
  if (wrong && at.port == haply::SERVICE_PORT)
    wrong = haply::read_version(http_get({at.host, haply::OLD_PORT}, "/version", CONNECT_PATIENCE), version);
  if (wrong) throw failure_error(fmt::format("{}: the service does not report its version (GET /version): {}", place, UPDATE));
  if (version < haply::OLDEST_VERSION)
    throw failure_error(fmt::format("{}: the service is {}.{}: {}", place, version.major, version.minor, UPDATE));
  return version;
}

std::string listed(const std::vector<haply::Arm>& arms) {
  std::string text;
  for (const haply::Arm& arm : arms)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", arm.id, arm.handedness.empty() ? "no side" : arm.handedness);
  return text;
}

haply::Devices named_devices(const haply::Inventory& inventory, const HaplyAddress& address, const std::string& place) {
  haply::Devices devices{address.arms, ""};
  for (std::size_t k = 0; k < devices.count(); ++k) {
    const std::string& id = devices.arms[k];
    const auto has_id = [&id](const haply::Arm& arm) { return arm.id == id; };
    if (std::none_of(inventory.arms.begin(), inventory.arms.end(), has_id)) {
      throw failure_error(fmt::format("{}: no Inverse3 is '{}'; attached are: {}", place, id,
                                      inventory.arms.empty() ? "none" : listed(inventory.arms)));
    }
  }
  if (devices.arms[0] == devices.arms[1])
    throw failure_error(fmt::format("{}: both tips cannot be the Inverse3 '{}'", place, devices.arms[0]));
  return devices;
}

}  // namespace

std::string haply_place(const HostPort& at) {
  const HostPort usual = HaplyAddress{}.at;
  if (at.host == usual.host) return at.port == usual.port ? "haply" : fmt::format("haply:{}", at.port);
  return "haply:" + authority(at);
}

HaplyService meet_haply_service(const HostPort& at) {
  const std::string place = haply_place(at);
  HaplyService service;
  service.socket = std::make_unique<HaplySocket>(at, place, CONNECT_PATIENCE);
  std::string text;
  if (service.socket->receive(text, INVENTORY_PATIENCE) != HaplySocket::Got::message)
    throw failure_error(fmt::format("{}: what answers there names no devices; give the port of the Inverse Service", place));
  if (const char* wrong = haply::read_inventory(text, service.inventory))
    throw failure_error(fmt::format("{}: the service's first message is {}; give the port of the Inverse Service", place, wrong));
  if (service.inventory.is_old) {
    throw failure_error(
        fmt::format("{}: this port speaks the old format 3.0; give the port of format 3.1 ({} by default), or, if "
                    "the service has none, {}",
                    place, haply::SERVICE_PORT, UPDATE));
  }
  service.version = find_version(at, place);
  return service;
}

haply::Devices choose_haply_devices(const haply::Inventory& inventory, const HaplyAddress& address) {
  const std::string place = haply_place(address.at);
  const std::vector<haply::Arm>& arms = inventory.arms;
  haply::Devices devices;
  if (!address.arms[0].empty()) {
    devices = named_devices(inventory, address, place);
  } else if (arms.empty()) {
    throw failure_error(place + ": the service has no Inverse3; attach two, or one and a VerseGrip");
  } else if (arms.size() > 2) {
    throw failure_error(fmt::format("{}: the service has {} Inverse3: {}; name two in the address, the left one first: {}/{},{}",
                                    place, arms.size(), listed(arms), place, arms[0].id, arms[1].id));
  } else if (arms.size() == 2) {
    const bool is_swapped = arms[0].handedness == "right";
    const haply::Arm &left = arms[is_swapped ? 1 : 0], &right = arms[is_swapped ? 0 : 1];
    if (left.handedness != "left" || right.handedness != "right") {
      throw failure_error(
          fmt::format("{}: the sides of the two Inverse3 are not left and right: {}; name both in the address, the left "
                      "one first: {}/{},{} or {}/{},{}",
                      place, listed(arms), place, arms[0].id, arms[1].id, place, arms[1].id, arms[0].id));
    }
    devices.arms = {left.id, right.id};
  } else {
    devices.arms[0] = arms[0].id;
  }
  if (devices.count() == 1) {
    if (inventory.grips.empty()) {
      throw failure_error(fmt::format("{}: there is one Inverse3 ({}) and no VerseGrip; attach a second Inverse3, or a VerseGrip",
                                      place, devices.arms[0]));
    }
    devices.grip = inventory.grips[0];
  }
  return devices;
}

std::vector<GripperFound> find_haply_grippers(const HostPort& at) {
  GripperFound found{"", "haply", "", ""};
  try {
    const HaplyService service = meet_haply_service(at);
    const haply::Inventory& all = service.inventory;
    found.summary = fmt::format("Inverse Service {}.{}; up to {:g} N at each tip, up to 4,000 Hz", service.version.major,
                                service.version.minor, INVERSE3_FORCE);
    const haply::Devices devices = choose_haply_devices(all, {at, {}});
    found.address = haply_place(at);
    found.name = devices.count() == 2 ? fmt::format("two Inverse3: {}", listed(all.arms))
                                      : fmt::format("Inverse3 {} with VerseGrip {}", listed(all.arms), devices.grip);
  } catch (const std::exception& error) {
    const std::string line = error.what(), place = haply_place(at) + ": ";
    found.missing = line.starts_with(place) ? line.substr(place.size()) : line;
    found.summary.clear();
  }
  return {found};
}

}  // namespace wholehand::device
