// SPDX-License-Identifier: MIT
#include "device/grippers/haply_messages.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace wholehand::device::haply {
namespace {

using nlohmann::json;

constexpr const char* GRIP_KINDS[] = {"verse_grip", "wireless_verse_grip"};
constexpr const char* NOT_JSON = "a message that is not a JSON object";
constexpr std::size_t SHORT_TEXT = 125, LONG_TEXT = 65535;  // bytes, largest of the two shorter lengths of a frame

// Null: no such member.
const json* member(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

bool read_number(const json& object, const char* key, double& into) {
  const json* const value = member(object, key);
  if (!value || !value->is_number()) return false;
  into = value->get<double>();
  return std::isfinite(into);
}

// Empty: none.
std::string id_of(const json& device) {
  const json* const id = member(device, "device_id");
  return id && id->is_string() ? id->get<std::string>() : "";
}

// The state of a device; null: the message has none.
const json* state_of(const json& message, const char* kind, const std::string& id) {
  const json* const devices = member(message, kind);
  if (!devices || !devices->is_array()) return nullptr;
  for (const json& device : *devices)
    if (id_of(device) == id) return member(device, "state");
  return nullptr;
}

// `button` of a wired grip, `buttons` of a wireless one (a, b, c; or button_0 to button_3), which nlohmann sorts by name.
std::uint32_t read_buttons(const json& state) {
  if (const json* const one = member(state, "button")) return one->is_boolean() && one->get<bool>() ? 1 : 0;
  std::uint32_t buttons = 0;
  const json* const all = member(state, "buttons");
  if (!all || !all->is_object()) return buttons;
  unsigned k = 0;
  for (const json& one : *all) {
    if (k < 32 && one.is_boolean() && one.get<bool>()) buttons |= 1U << k;
    ++k;
  }
  return buttons;
}

const char* read_grip(const json& message, const std::string& id, Measurement& into) {
  const json* state = nullptr;
  for (const char* kind : GRIP_KINDS)
    if (!state) state = state_of(message, kind, id);
  if (!state) return "a state without the VerseGrip";
  const json* const orientation = member(*state, "orientation");
  constexpr const char* PARTS[] = {"w", "x", "y", "z"};
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!orientation || !read_number(*orientation, PARTS[k], into.orientation[k])) return "an orientation that is not four numbers";
    square += into.orientation[k] * into.orientation[k];
  }
  constexpr double TOLERANCE = 0.01;  // of a length: the service may round to three digits
  if (std::abs(std::sqrt(square) - 1) > TOLERANCE) return "an orientation whose length is not 1";
  for (double& part : into.orientation) part /= std::sqrt(square);
  into.buttons = read_buttons(*state);
  return nullptr;
}

std::string force_of(const std::string& id, const Triple& force, const Version& version) {
  return fmt::format(R"({{"device_id":{},"commands":{{"set_cursor_force":{{"{}":{{"x":{:.6f},"y":{:.6f},"z":{:.6f}}}}}}}}})",
                     json(id).dump(), version < VECTOR_VERSION ? "values" : "vector", force[0], force[1], force[2]);
}

}  // namespace

const char* read_inventory(std::string_view text, Inventory& into) {
  into = {};
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return NOT_JSON;
  const json* const arms = member(message, "inverse3");
  if (!arms) return "an inventory without `inverse3`";
  into.is_old = arms->is_object();
  if (into.is_old) return nullptr;
  if (!arms->is_array()) return "an inventory whose `inverse3` is not a list";
  for (const json& device : *arms) {
    Arm arm{id_of(device), ""};
    if (arm.id.empty()) return "an Inverse3 without `device_id`";
    const json* const config = member(device, "config");
    const json* const handedness = config ? member(*config, "handedness") : nullptr;
    if (handedness && handedness->is_string()) arm.handedness = handedness->get<std::string>();
    if (arm.handedness != "left" && arm.handedness != "right") arm.handedness.clear();
    into.arms.push_back(arm);
  }
  for (const char* kind : GRIP_KINDS) {
    const json* const grips = member(message, kind);
    if (!grips || !grips->is_array()) continue;
    for (const json& grip : *grips)
      if (std::string id = id_of(grip); !id.empty()) into.grips.push_back(std::move(id));
  }
  return nullptr;
}

const char* read_measurement(std::string_view text, const Devices& devices, Measurement& into) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return NOT_JSON;
  for (std::size_t k = 0; k < devices.count(); ++k) {
    const json* const state = state_of(message, "inverse3", devices.arms[k]);
    if (!state) return k == 1 ? "a state without the right Inverse3" : "a state without the first Inverse3";
    const json* const cursor = member(*state, "cursor_position");
    Triple& place = into.cursors[k];
    if (!cursor || !read_number(*cursor, "x", place[0]) || !read_number(*cursor, "y", place[1]) ||
        !read_number(*cursor, "z", place[2]))
      return "a cursor position that is not three numbers";
  }
  return devices.grip.empty() ? nullptr : read_grip(message, devices.grip, into);
}

const char* read_version(std::string_view text, Version& into) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return NOT_JSON;
  const json* const data = member(message, "data");
  const json* const version = member(data ? *data : message, "project_version");
  if (!version || !version->is_string()) return "a version without `project_version`";
  if (std::sscanf(version->get<std::string>().c_str(), "%5d.%5d", &into.major, &into.minor) != 2)
    return "a version that is not two numbers";
  return nullptr;
}

std::string write_forces(const Devices& devices, const std::array<Triple, 2>& forces, const Version& version) {
  std::string message = R"({"inverse3":[)" + force_of(devices.arms[0], forces[0], version);
  if (devices.count() == 2) message += ',' + force_of(devices.arms[1], forces[1], version);
  return message + "]}";
}

std::string masked_frame(std::string_view text) {
  constexpr unsigned char KEY[] = {0x57, 0x48, 0x6f, 0x6c};
  constexpr unsigned FINAL_TEXT = 0x81, MASKED = 0x80;
  text = text.substr(0, LONG_TEXT);
  std::string frame;
  const auto add = [&frame](std::size_t byte) { frame += static_cast<char>(static_cast<unsigned char>(byte)); };
  add(FINAL_TEXT);
  if (text.size() <= SHORT_TEXT) {
    add(MASKED | text.size());
  } else {
    add(MASKED | 126);
    add(text.size() >> 8);
    add(text.size() & 0xff);
  }
  for (const unsigned char byte : KEY) add(byte);
  for (std::size_t k = 0; k < text.size(); ++k) add(static_cast<unsigned char>(text[k]) ^ KEY[k % 4]);
  return frame;
}

}  // namespace wholehand::device::haply
