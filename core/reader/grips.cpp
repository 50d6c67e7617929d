// SPDX-License-Identifier: MIT
// [grips], [tilts] and [liquid]: the values that a sweep goes through.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/reader/parts.h"

namespace wholehand {
namespace {

constexpr int TURNS = 24;  // azimuths of a mesh where the scene gives none: every 15 degrees

// {from, to, count}: equal steps, both ends included. Without a count (where that is allowed) only its ends.
struct Range {
  double from = 0, to = 0;
  std::optional<std::int64_t> count;
};

Range read_range(const SceneFile& file, const toml::table& node, const std::string& key, const Quantity& quantity,
                 IntegerRange counts, bool needs_count) {
  const SceneTable table(file, node, key, {"from", "to", "count"});
  const Quantity plain{quantity.low, quantity.high};  // steps are made in the file's unit, so that whole degrees stay whole
  Range range;
  table.need("from", plain, range.from);
  table.need("to", plain, range.to);
  if (needs_count) table.need("count", fmt::format("{{from, to, count}}, count {} to {}", counts.low, counts.high));
  if (table.has("count")) table.read("count", counts, range.count.emplace());
  if (range.from > range.to) {
    file.refuse(table.place("to"), fmt::format("{}: to {} is below from", key, found(*table.find("to"))),
                fmt::format("allowed: from <= to; from = {}", range.from));
  }
  if (range.count && (*range.count == 1) != (range.from == range.to)) {
    file.refuse(table.place("count"), fmt::format("{}: {} values from {} to {}", key, *range.count, range.from, range.to),
                "allowed: one value where from = to, more otherwise");
  }
  return range;
}

std::vector<double> range_values(const Range& range, Unit unit) {
  const std::int64_t count = range.count.value_or(range.from == range.to ? 1 : 2);
  std::vector<double> values;
  values.reserve(count);
  for (std::int64_t i = 0; i + 1 < count; ++i) {
    values.push_back(to_si(range.from + (range.to - range.from) * static_cast<double>(i) / static_cast<double>(count - 1), unit));
  }
  values.push_back(to_si(range.to, unit));
  return values;
}

std::vector<double> list_values(const SceneFile& file, const toml::array& array, const std::string& key, const Quantity& quantity) {
  std::vector<double> values;
  values.reserve(array.size());
  for (const toml::node& node : array) values.push_back(read_number(file, node, "a value of " + key, quantity));
  return values;
}

void check_ascending(const SceneFile& file, const toml::array& array, const std::string& key, const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) continue;
    file.refuse(place_of(array[i]), fmt::format("{}: {} after {}", key, found(array[i]).substr(2), found(array[i - 1]).substr(2)),
                "allowed: values in ascending order, each once");
  }
}

void check_distinct(const SceneFile& file, const toml::array& array, const std::string& key, const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return values[i] < values[j] || (values[i] == values[j] && i < j); });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (values[order[k]] != values[order[k - 1]]) continue;
    file.refuse(place_of(array[order[k]]), fmt::format("{}: {} a second time", key, found(array[order[k]]).substr(2)),
                "allowed: each value once");
  }
}

// Every azimuth, for meshes where the scene gives none.
Axis all_round(bool is_sobol) {
  if (is_sobol) return {{0, radians(360)}, true};
  Axis axis{{}, true};
  for (int k = 0; k < TURNS; ++k) axis.values.push_back(radians(360.0 * k / TURNS));
  return axis;
}

// A number, a list or a range, in place of the default.
void read_axis(const SceneTable& grips, const char* key, const Quantity& quantity, bool is_sobol, Axis& axis) {
  const toml::node* node = grips.find(key);
  if (!node) return;
  const SceneFile& file = grips.file();
  const std::string allowed =
      fmt::format("a number, a list of 1 to {} or {}", ranges::LARGEST_AXIS, is_sobol ? "{from, to}" : "{from, to, count}");
  if (const toml::table* table = node->as_table()) {
    const Range range = read_range(file, *table, key, quantity, ranges::AXIS_COUNT, !is_sobol);
    axis = {range_values(range, quantity.unit), true};
  } else if (node->is_array()) {
    const toml::array* array = grips.array(key, 1, ranges::LARGEST_AXIS, allowed);
    axis = {list_values(file, *array, key, quantity)};
    check_distinct(file, *array, key, axis.values);
  } else if (node->is_number()) {
    axis = {{read_number(file, *node, key, quantity)}};
  } else {
    file.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)), "allowed: " + allowed);
  }
}

// The tilts of [tilts].
std::vector<double> listed_tilts(const SceneTable& table) {
  constexpr std::int64_t LARGEST = ranges::LARGEST_TILTS;
  const std::string allowed = fmt::format("an ascending list of 1 to {} or {{from, to, count}}", LARGEST);
  const toml::node& node = table.need("deg", allowed);
  if (const toml::table* range = node.as_table())
    return range_values(read_range(table.file(), *range, "deg", ranges::TILT, {1, LARGEST}, true), Unit::deg);
  const toml::array* array = table.array("deg", 1, LARGEST, allowed);
  const std::vector<double> tilts = list_values(table.file(), *array, "deg", ranges::TILT);
  check_ascending(table.file(), *array, "deg", tilts);
  return tilts;
}

}  // namespace

void read_grips(const SceneTable& root, bool turns, GripsData& grips) {
  if (turns) grips.azimuth = all_round(false);
  const auto table = root.table("grips", {"height_mm", "height_fraction", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm",
                                          "hand_scale", "sampling", "count", "seed"});
  if (!table) return;
  grips.place = table->file().text_of(table->place());
  table->read("sampling", {{"grid", Sampling::grid}, {"sobol", Sampling::sobol}}, grips.sampling);
  const bool is_sobol = grips.sampling == Sampling::sobol;
  if (turns) grips.azimuth = all_round(is_sobol);
  for (const char* key : {"count", "seed"}) {
    if (table->has(key) && !is_sobol) {
      root.file().refuse(table->place(key), fmt::format("{} without sampling = \"sobol\"", key),
                         "allowed: with sampling = \"sobol\"; a grid has a count for each axis");
    }
  }
  if (is_sobol) {
    table->need("count", "the number of grips of each vessel, as sampling = \"sobol\"");
    std::int64_t count = 0, seed = 0;
    table->read("count", ranges::SOBOL_COUNT, count);
    table->read("seed", ranges::SEED, seed);
    grips.count = static_cast<std::uint64_t>(count);
    grips.seed = static_cast<std::uint64_t>(seed);
  }
  if (table->has("height_mm") && table->has("height_fraction")) {
    root.file().refuse(table->place("height_fraction"), "both height_fraction and height_mm are given", "allowed: one of the two");
  }
  grips.height_is_fraction = !table->has("height_mm");
  read_axis(*table, "height_mm", ranges::GRIP_HEIGHT, is_sobol, grips.height);
  read_axis(*table, "height_fraction", ranges::FRACTION, is_sobol, grips.height);
  read_axis(*table, "azimuth_deg", ranges::ROTATION, is_sobol, grips.azimuth);
  read_axis(*table, "obliquity_deg", ranges::OBLIQUITY, is_sobol, grips.obliquity);
  read_axis(*table, "roll_deg", ranges::ROTATION, is_sobol, grips.roll);
  read_axis(*table, "offset_mm", ranges::OFFSET, is_sobol, grips.offset);
  read_axis(*table, "hand_scale", ranges::SCALE, is_sobol, grips.hand_scale);
}

void read_tilts(const SceneTable& root, Scene& scene) {
  const auto table = root.table("tilts", {"deg", "until_poured"});
  if (!table) return;
  scene.tilts = listed_tilts(*table);
  if (!table->has("until_poured")) return;
  table->read("until_poured", ranges::POURED_SHARE, scene.until_poured.emplace());
  if (!scene.liquid) {
    root.file().refuse(table->place("until_poured"), "until_poured without [liquid]",
                       "allowed: in a scene with [liquid], of whose fills it is a share");
  }
}

void read_liquid(const SceneTable& root, std::optional<LiquidData>& liquid) {
  const auto table = root.table("liquid", {"density_kg_m3", "fills", "fills_ml", "pour"});
  if (!table) return;
  LiquidData data;
  table->read("density_kg_m3", ranges::LIQUID_DENSITY, data.density);
  table->read("pour", {{"away", Pour::away}, {"towards", Pour::towards}}, data.pour);
  const bool in_ml = table->has("fills_ml");
  if (in_ml && table->has("fills"))
    root.file().refuse(table->place("fills_ml"), "both fills_ml and fills are given", "allowed: one of the two");
  const char* key = in_ml ? "fills_ml" : "fills";
  const std::string allowed = in_ml ? "an ascending list of volumes in mL"
                                    : "an ascending list of fractions of the capacity, 0 to 1; or fills_ml, the same in mL";
  table->need(key, allowed);
  const toml::array* array = table->array(key, 1, ranges::LARGEST_FILLS, allowed);
  std::vector<double>& values = in_ml ? data.volumes : data.fills;
  values = list_values(root.file(), *array, key, in_ml ? ranges::FILL_VOLUME : ranges::FRACTION);
  check_ascending(root.file(), *array, key, values);
  liquid = data;
}

}  // namespace wholehand
