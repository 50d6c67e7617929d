// SPDX-License-Identifier: MIT
// [live], [device] and [task]: a session with a gripper.
#include <fmt/format.h>

#include <algorithm>

#include "core/reader/parts.h"

namespace wholehand {
namespace {

// Each of the device's axes along one of x, y, z or against it, each of them once.
void read_axes(const SceneTable& device, std::array<std::string, 3>& axes) {
  const toml::node* node = device.find("axes");
  if (!node) return;
  const std::string allowed = "allowed: 'x', 'y' and 'z' in some order, each with or without '-' before it";
  const toml::array* array = node->as_array();
  if (!array || array->size() != axes.size()) {
    device.file().refuse(place_of(*node), "axes " + (array ? fmt::format("has {} entries", array->size()) : found(*node)), allowed);
  }
  std::string used;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto* text = (*array)[i].as_string();
    const std::string axis = text ? text->get() : "";
    const char letter = axis.empty() ? '\0' : axis.back();
    const bool is_axis = (axis.size() == 1 || (axis.size() == 2 && axis[0] == '-')) && letter >= 'x' && letter <= 'z';
    if (!is_axis || used.find(letter) != std::string::npos) {
      device.file().refuse(place_of((*array)[i]), "an entry of axes " + found((*array)[i]), allowed);
    }
    used += letter;
    axes[i] = axis;
  }
  // even permutations and an even number of turned axes are rotations; the rest would turn right hands into left ones
  const bool is_even = used == "xyz" || used == "yzx" || used == "zxy";
  const auto turned = std::count_if(axes.begin(), axes.end(), [](const std::string& axis) { return axis[0] == '-'; });
  if (is_even != (turned % 2 == 0)) {
    device.file().refuse(place_of(*node),
                         fmt::format("axes = [\"{}\", \"{}\", \"{}\"] mirrors the device", axes[0], axes[1], axes[2]),
                         "allowed: axes with one '-' more or less");
  }
}

}  // namespace

void read_live(const SceneTable& root, bool has_efforts, LiveData& live) {
  const auto table = root.table(
      "live", {"rate_Hz", "K_N_m", "B_Ns_m", "slip_mm", "ramp_s", "slew_N_s", "jump_m_s", "late_steps", "slide", "slide_by"});
  if (!table) return;
  table->read("rate_Hz", ranges::RATE, live.rate);
  table->read("K_N_m", ranges::COUPLING_STIFFNESS, live.stiffness);
  table->read("B_Ns_m", ranges::COUPLING_DAMPING, live.damping);
  table->read("slip_mm", ranges::SLIP, live.slip);
  table->read("ramp_s", ranges::RAMP, live.ramp);
  table->read("slew_N_s", ranges::SLEW, live.slew);
  table->read("jump_m_s", ranges::JUMP, live.jump);
  std::int64_t late_steps = live.late_steps;
  table->read("late_steps", ranges::LATE_STEPS, late_steps);
  live.late_steps = static_cast<int>(late_steps);
  table->read_flag("slide", live.slide);
  table->read("slide_by", {{"tips", SlideBy::tips}, {"hand", SlideBy::hand}}, live.slide_by);
  if (live.slide_by == SlideBy::hand && !has_efforts)
    root.file().refuse(table->place("slide_by"), "slide_by = \"hand\" beside [strength] efforts = false",
                       "allowed: slide_by = \"tips\", or efforts");
}

void read_device(const SceneTable& root, DeviceData& device) {
  const auto table = root.table("device", {"gap_mm", "workspace_scale", "origin_mm", "axes", "clutch_button", "library"});
  if (!table) return;
  device.has_gap = table->has("gap_mm");
  table->read("gap_mm", ranges::GAP, "[closed, open]", device.gap);
  if (device.has_gap && !(device.gap[0] < device.gap[1])) {
    root.file().refuse(table->place("gap_mm"), fmt::format("gap_mm = [{:.6g}, {:.6g}]", device.gap[0] * 1e3, device.gap[1] * 1e3),
                       "allowed: [closed, open], closed less than open");
  }
  table->read("workspace_scale", ranges::WORKSPACE_SCALE, device.workspace_scale);
  table->read("origin_mm", ranges::PLACE, "[x, y, z]", device.origin);
  read_axes(*table, device.axes);
  std::int64_t button = device.clutch_button;
  table->read("clutch_button", ranges::BUTTON, button);
  device.clutch_button = static_cast<int>(button);
  table->read_path("library", device.library);
}

void read_task(const SceneTable& root, const std::vector<VesselData>& vessels, std::optional<TaskData>& task) {
  const auto table = root.table("task", {"target", "amounts_ml", "destination_mm", "tolerance_ml"});
  if (!table) return;
  TaskData data;
  table->need("target", "{place_mm = [x, y, z], diameter_mm}");
  const auto target = table->table("target", {"place_mm", "diameter_mm"});
  target->need("place_mm", ranges::PLACE, "[x, y, z]", data.target_place);
  target->need("diameter_mm", ranges::DIAMETER, data.target_diameter);
  table->need("destination_mm", ranges::PLACE, "[x, y, z]", data.destination);
  table->need("tolerance_ml", ranges::AMOUNT_TOLERANCE, data.tolerance);

  const std::string allowed = "{liquid name = mL, ..} with the liquids of the vessels";
  table->need("amounts_ml", allowed);
  const toml::table* amounts = table->bare_table("amounts_ml", allowed);
  if (amounts->empty()) root.file().refuse(place_of(*amounts), "amounts_ml is empty", "allowed: " + allowed);
  std::vector<std::string_view> liquids;
  for (const VesselData& vessel : vessels) {
    if (!vessel.liquid_name.empty()) liquids.push_back(vessel.liquid_name);
  }
  for (const auto& [key, node] : *amounts) {
    if (std::find(liquids.begin(), liquids.end(), key.str()) == liquids.end()) {
      const std::string nearest = nearest_name(key.str(), liquids);
      root.file().refuse(place_of(node), fmt::format("amounts_ml names {}, which no vessel holds", in_quotes(key.str())),
                         nearest.empty() ? "allowed: the liquids of the vessels, and no vessel has a liquid"
                                         : fmt::format("the nearest liquid is '{}'", nearest));
    }
    data.amounts.emplace_back(key.str(), read_number(root.file(), node, "amount of " + in_quotes(key.str()), ranges::AMOUNT));
  }
  task = data;
}

}  // namespace wholehand
