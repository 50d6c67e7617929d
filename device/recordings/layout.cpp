// SPDX-License-Identifier: MIT
#include "device/recordings/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/system/version.h"
#include "base/text/error.h"
#include "base/text/printable.h"
#include "base/text/text.h"
#include "device/recordings/checksums.h"
#include "device/recordings/fields.h"

namespace wholehand::device {
namespace {

using classic::Attribute;
using classic::Header;

constexpr const char* CONTENT = "recording of a wholehand session";
constexpr std::uint64_t ROOM_FOR_END = 2048;  // bytes
constexpr std::size_t LONGEST_REASON = 1000;  // bytes of it, well within that room
constexpr std::size_t MOST_AMOUNTS = 64;
constexpr const char* RECORDS = "ticks";  // attribute: how many records the finished file has
constexpr double LARGEST_RATE = 1e6;      // Hz

// Builds a header with its fixed variables.
class LayoutBuilder {
 public:
  explicit LayoutBuilder(const RecordingInfo& info) : info_(info) {}

  RecordingLayout build() {
    dimensions();
    attributes();
    fixed_variables();
    tick_variables();
    set_checksum(header(), layout_.fixed);
    classic::lay_out(layout_.header, ROOM_FOR_END);
    return std::move(layout_);
  }

 private:
  Header& header() { return layout_.header; }

  void dimensions() {
    // the longest text of any label
    text_length_ = 5;
    for (const RecordedVessel& vessel : info_.vessels)
      text_length_ = std::max({text_length_, vessel.name.size(), vessel.liquid.size()});
    for (const RecordedAmount& amount : info_.amounts) text_length_ = std::max(text_length_, amount.liquid.size());
    header().dimensions = {
        {TICK_DIMENSION, 0}, {"vessel", static_cast<std::uint32_t>(info_.vessels.size())}, {"contact", 2}, {"xyz", 3}, {"row", 3},
        {"column", 3},       {"text_length", static_cast<std::uint32_t>(text_length_)}};
    if (!info_.amounts.empty()) header().dimensions.push_back({"amount", static_cast<std::uint32_t>(info_.amounts.size())});
  }

  void attributes() {
    const RecordedDevice& device = info_.device;
    header().attributes = {
        classic::text_attribute("Conventions", "CF-1.8"),
        classic::text_attribute("title", "session in " + (info_.scene_name.empty() ? "a scene" : info_.scene_name)),
        classic::text_attribute("content", CONTENT),
        classic::text_attribute("program", "wholehand"),
        classic::text_attribute("version", info_.version),
        classic::text_attribute("start", info_.start),
        classic::text_attribute("scene_name", info_.scene_name),
        classic::text_attribute("scene_file", info_.scene_file),
        classic::text_attribute("scene", info_.scene_text),
        classic::text_attribute("seed", fmt::format("{}", info_.seed)),  // classic files have no 64-bit integers
        classic::number_attribute("rate_Hz", {info_.rate}),
        classic::integer_attribute("has_clock", {info_.has_clock}),
        classic::text_attribute("device", device.name),
        classic::text_attribute("device_address", device.address),
        classic::number_attribute("device_arm_force_N", {device.force}),
        classic::number_attribute("device_gripper_force_N", {device.grip}),
        classic::number_attribute("device_gap_m", {device.gap[0], device.gap[1]}),
        classic::number_attribute("device_rate_Hz", {device.rate}),
        classic::integer_attribute("device_has_rotation", {device.has_rotation}),
        classic::integer_attribute("device_is_left_handed", {device.is_left_handed}),
        classic::integer_attribute("device_pushes_each_tip", {device.pushes_each_tip}),
        classic::number_attribute("force_base_N", {info_.force_base}),
        classic::number_attribute("force_max_N", {info_.force_max}),
        classic::number_attribute("tolerance_m3", {info_.tolerance})};
    if (info_.person) header().attributes.push_back(classic::text_attribute("person", fmt::format("{}", *info_.person)));
  }

  std::uint32_t dimension(std::string_view name) {
    const auto& all = header().dimensions;
    const auto found = std::find_if(all.begin(), all.end(), [name](const classic::Dimension& d) { return d.name == name; });
    return static_cast<std::uint32_t>(found - all.begin());
  }

  classic::Variable& variable(const std::string& name, classic::Type type, std::string_view dimensions, bool of_ticks,
                              const std::string& units, const std::string& long_name) {
    classic::Variable variable{name, type, {}, {}};
    if (of_ticks) variable.dimensions.push_back(dimension(TICK_DIMENSION));
    while (!dimensions.empty()) {
      const std::size_t end = std::min(dimensions.find(' '), dimensions.size());
      variable.dimensions.push_back(dimension(dimensions.substr(0, end)));
      dimensions.remove_prefix(std::min(end + 1, dimensions.size()));
    }
    if (!units.empty()) variable.attributes.push_back(classic::text_attribute("units", units));
    variable.attributes.push_back(classic::text_attribute("long_name", long_name));
    header().variables.push_back(variable);
    return header().variables.back();
  }

  void labels(const std::string& name, const std::string& along, const std::string& long_name,
              const std::vector<std::string>& values) {
    // without it xarray takes them for bytes, and finds none of them by its name
    variable(name, classic::Type::text, along + " text_length", false, "", long_name)
        .attributes.push_back(classic::text_attribute("_Encoding", "utf-8"));
    for (const std::string& value : values) {
      layout_.fixed += value;
      layout_.fixed.append(text_length_ - value.size(), '\0');
    }
    layout_.fixed.resize((layout_.fixed.size() + 3) / 4 * 4, '\0');
  }

  void numbers(const std::string& name, const std::string& along, const std::string& units, const std::string& long_name,
               const std::vector<double>& values) {
    variable(name, classic::Type::float64, along, false, units, long_name);
    for (const double value : values) classic::append_real(layout_.fixed, value);
  }

  void fixed_variables() {
    std::vector<std::string> names, liquids, wanted;
    std::vector<double> ranges, amounts;
    for (const RecordedVessel& vessel : info_.vessels) {
      names.push_back(vessel.name);
      liquids.push_back(vessel.liquid);
      ranges.push_back(vessel.force_range);
    }
    labels("vessel", "vessel", "vessel", names);
    labels("liquid", "vessel", "liquid in the vessel", liquids);
    numbers("force_range", "vessel", "N", "F_range of the vessel", ranges);
    labels("contact", "contact", "tracked finger", {"thumb", "index"});
    labels("xyz", "xyz", "direction", {"x", "y", "z"});
    if (info_.amounts.empty()) return;
    for (const RecordedAmount& amount : info_.amounts) {
      wanted.push_back(amount.liquid);
      amounts.push_back(amount.volume);
    }
    labels("amount_liquid", "amount", "liquid that the task wants in the target", wanted);
    numbers("amount", "amount", "m3", "volume that the task wants in the target", amounts);
  }

  void tick_variables() {
    variable(TIME_VARIABLE, classic::Type::float64, "", true, "s", "time since the start")
        .attributes.push_back(classic::text_attribute("comment", "tick / rate_Hz"));
    for (const RecordedField& field : recorded_fields()) {
      const bool is_real = field.as == RecordedAs::real || field.as == RecordedAs::number;
      const classic::Type type = is_real                        ? classic::Type::float64
                                 : field.as == RecordedAs::flag ? classic::Type::byte
                                                                : classic::Type::int32;
      classic::Variable& added = variable(field.name, type, field.dimensions, true, field.units, field.long_name);
      if (*field.comment) added.attributes.push_back(classic::text_attribute("comment", field.comment));
      if (field.as == RecordedAs::word) added.attributes.push_back(classic::text_attribute("_Unsigned", "true"));
      if (field.as == RecordedAs::flag) add_meanings(added, field);
      if (field.as != RecordedAs::number) added.attributes.push_back(classic::text_attribute("coordinates", TIME_VARIABLE));
    }
    classic::Variable& checksum = variable(CHECKSUM, classic::Type::int32, "", true, "1",
                                           "checksum of the other values of this tick and of the ticks before it");
    checksum.attributes.push_back(classic::text_attribute("_Unsigned", "true"));
    checksum.attributes.push_back(classic::text_attribute("coordinates", TIME_VARIABLE));
  }

  // A meaning is one word there.
  static void add_meanings(classic::Variable& added, const RecordedField& field) {
    std::vector<std::int8_t> values;
    std::string meanings;
    for (int k = 0; k <= static_cast<int>(field.most); ++k) {
      values.push_back(static_cast<std::int8_t>(k));
      meanings += (k == 0 ? "" : " ") + std::string(field.meanings[k]);
      std::replace(meanings.end() - static_cast<std::ptrdiff_t>(std::string_view(field.meanings[k]).size()), meanings.end(), ' ',
                   '_');
    }
    added.attributes.push_back(classic::byte_attribute("flag_values", values));
    added.attributes.push_back(classic::text_attribute("flag_meanings", meanings));
  }

  const RecordingInfo& info_;
  std::size_t text_length_ = 0;
  RecordingLayout layout_;
};

// ---- the way back ----

Error lacks(std::string_view what) { return usage_error(fmt::format("is not a recording of a session: it lacks {}", what)); }

std::string recorded_text(const Header& header, const char* name) {
  const Attribute* attribute = header.attribute(name);
  if (!attribute || attribute->type != classic::Type::text) throw lacks(fmt::format("the text attribute {}", name));
  return attribute->bytes;
}

// A text that is printed.
std::string recorded_line(const Header& header, const char* name) { return one_line(recorded_text(header, name)); }

std::vector<double> recorded_numbers(const Header& header, const char* name, std::size_t count) {
  const Attribute* attribute = header.attribute(name);
  if (!attribute || attribute->type != classic::Type::float64 || attribute->bytes.size() != count * 8)
    throw lacks(fmt::format("the attribute {} of {} double{}", name, count, count == 1 ? "" : "s"));
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) values.push_back(classic::load_real(attribute->bytes.data() + k * 8));
  return values;
}

double recorded_number(const Header& header, const char* name) { return recorded_numbers(header, name, 1)[0]; }

// A whole number as text.
std::uint64_t recorded_integer(const Header& header, const char* name) {
  const std::string text = recorded_text(header, name);
  std::uint64_t value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ptr != text.data() + text.size() || text.empty())
    throw lacks(fmt::format("a {} that is a whole number", name));
  return value;
}

bool recorded_yes(const Header& header, const char* name) {
  const Attribute* attribute = header.attribute(name);
  if (!attribute || attribute->type != classic::Type::int32 || attribute->bytes.size() != 4)
    throw lacks(fmt::format("the attribute {} of one integer", name));
  return classic::load_32(attribute->bytes.data()) != 0;
}

std::uint64_t length_of(const Header& header, std::string_view name) {
  for (const classic::Dimension& dimension : header.dimensions) {
    if (dimension.name == name) return dimension.length;
  }
  return 0;
}

const classic::Variable& fixed_variable(const Header& header, const char* name, classic::Type type, const char* dimensions) {
  const classic::Variable* variable = header.variable(name);
  if (!variable || variable->is_record || variable->type != type || dimension_names(header, *variable) != dimensions)
    throw lacks(fmt::format("the variable {}({})", name, dimensions));
  return *variable;
}

// Labels end where the zeros begin.
std::vector<std::string> recorded_labels(const Header& header, const FixedValues& fixed_values, const char* name,
                                         const char* along) {
  const auto& variable = fixed_variable(header, name, classic::Type::text, fmt::format("{} text_length", along).c_str());
  const std::string bytes = fixed_values(variable);
  const std::uint64_t length = length_of(header, "text_length");
  if (length == 0) throw lacks("texts with a length above 0");
  std::vector<std::string> labels;
  for (std::uint64_t at = 0; at + length <= variable.values; at += length) {
    std::string label = bytes.substr(at, length);
    label.resize(std::min(label.find('\0'), label.size()));
    labels.push_back(one_line(label));
  }
  return labels;
}

std::vector<double> recorded_reals(const Header& header, const FixedValues& fixed_values, const char* name, const char* along) {
  const auto& variable = fixed_variable(header, name, classic::Type::float64, along);
  const std::string bytes = fixed_values(variable);
  std::vector<double> values;
  for (std::uint64_t k = 0; k < variable.values; ++k) values.push_back(classic::load_real(bytes.data() + k * 8));
  return values;
}

void read_labels_and_amounts(RecordingInfo& info, const Header& header, const FixedValues& fixed_values) {
  const std::uint64_t vessels = length_of(header, "vessel"), amounts = length_of(header, "amount");
  if (vessels < 1 || vessels > LIVE_VESSELS) throw lacks(fmt::format("1 to {} vessels", LIVE_VESSELS));
  if (amounts > MOST_AMOUNTS) throw usage_error(fmt::format("has {} amounts; allowed: at most {}", amounts, MOST_AMOUNTS));
  const auto names = recorded_labels(header, fixed_values, "vessel", "vessel");
  const auto liquids = recorded_labels(header, fixed_values, "liquid", "vessel");
  const auto ranges = recorded_reals(header, fixed_values, "force_range", "vessel");
  if (names.size() != vessels || liquids.size() != vessels || ranges.size() != vessels)
    throw lacks("a name, a liquid and a range for each vessel");
  for (std::size_t v = 0; v < vessels; ++v) info.vessels.push_back({names[v], liquids[v], ranges[v]});
  if (amounts == 0) return;
  const auto wanted = recorded_labels(header, fixed_values, "amount_liquid", "amount");
  const auto volumes = recorded_reals(header, fixed_values, "amount", "amount");
  if (wanted.size() != amounts || volumes.size() != amounts) throw lacks("a liquid and a volume for each amount");
  for (std::size_t k = 0; k < amounts; ++k) info.amounts.push_back({wanted[k], volumes[k]});
}

Percentiles recorded_percentiles(const Header& header, const char* name) {
  const auto values = recorded_numbers(header, name, 4);
  return {values[0], values[1], values[2], values[3]};
}

constexpr const char* PERIOD_PERCENTILES = "period_p50_p99_p999_max_s";
constexpr const char* STEP_PERCENTILES = "step_time_p50_p99_p999_max_s";

}  // namespace

RecordingLayout layout_recording(const RecordingInfo& info) { return LayoutBuilder(info).build(); }

void add_end(Header& header, const RecordingEnd& end) {
  const auto percentiles = [&header](const char* name, const Percentiles& values) {
    header.attributes.push_back(classic::number_attribute(name, {values.p50, values.p99, values.p999, values.max}));
  };
  percentiles(PERIOD_PERCENTILES, end.period);
  percentiles(STEP_PERCENTILES, end.step);
  header.attributes.push_back(classic::number_attribute("missed_periods", {static_cast<double>(end.missed)}));
  header.attributes.push_back(classic::text_attribute("fault", FAULT_NAMES[static_cast<std::size_t>(end.fault)]));
  header.attributes.push_back(classic::text_attribute("ended_early", end.early.substr(0, LONGEST_REASON)));
  header.attributes.push_back(classic::number_attribute(RECORDS, {static_cast<double>(header.records)}));
}

std::string dimension_names(const Header& header, const classic::Variable& variable) {
  std::vector<std::string> names;
  for (const std::uint32_t dimension : variable.dimensions) names.push_back(header.dimensions[dimension].name);
  return joined(names, " ");
}

RecordingInfo recording_info(const Header& header, const FixedValues& fixed_values) {
  const Attribute* content = header.attribute("content");
  if (!content || content->bytes != CONTENT) throw usage_error("is not a recording of a session, but another NetCDF file");
  check_version("", recorded_line(header, "version"), "record the session again");
  std::string fixed;
  for (const classic::Variable& variable : header.variables)
    if (!variable.is_record) fixed += fixed_values(variable);
  if (!has_right_checksum(header, fixed))
    throw usage_error(
        "is damaged: its attributes, labels or structure are not as the session wrote them; use a copy that is not damaged");
  RecordingInfo info;
  info.scene_name = recorded_line(header, "scene_name");
  info.scene_file = recorded_line(header, "scene_file");
  info.scene_text = recorded_text(header, "scene");
  info.version = recorded_line(header, "version");
  info.start = recorded_line(header, "start");
  info.seed = recorded_integer(header, "seed");
  if (header.attribute("person")) info.person = recorded_integer(header, "person");
  info.rate = recorded_number(header, "rate_Hz");
  if (!(info.rate > 0 && info.rate <= LARGEST_RATE)) throw usage_error(fmt::format("has an impossible rate of {} Hz", info.rate));
  info.has_clock = recorded_yes(header, "has_clock");
  const auto gap = recorded_numbers(header, "device_gap_m", 2);
  info.device = {recorded_line(header, "device"),
                 recorded_line(header, "device_address"),
                 recorded_number(header, "device_arm_force_N"),
                 recorded_number(header, "device_gripper_force_N"),
                 {gap[0], gap[1]},
                 recorded_number(header, "device_rate_Hz"),
                 recorded_yes(header, "device_has_rotation"),
                 recorded_yes(header, "device_is_left_handed"),
                 recorded_yes(header, "device_pushes_each_tip")};
  if (!(info.device.force >= 0 && info.device.grip >= 0 && gap[0] <= gap[1]))
    throw usage_error("has a device with impossible forces or an impossible gap");
  info.force_base = recorded_number(header, "force_base_N");
  info.force_max = recorded_number(header, "force_max_N");
  info.tolerance = recorded_number(header, "tolerance_m3");
  read_labels_and_amounts(info, header, fixed_values);
  return info;
}

std::optional<RecordingEnd> end_of(const Header& header) {
  if (!header.attribute("ended_early")) return std::nullopt;
  RecordingEnd end;
  end.period = recorded_percentiles(header, PERIOD_PERCENTILES);
  end.step = recorded_percentiles(header, STEP_PERCENTILES);
  const double missed = recorded_number(header, "missed_periods");
  if (!(missed >= 0 && missed < 1e15)) throw usage_error(fmt::format("has {} missed periods, which is impossible", missed));
  end.missed = static_cast<std::int64_t>(missed);
  const auto fault = std::find(FAULT_NAMES.begin(), FAULT_NAMES.end(), recorded_text(header, "fault"));
  if (fault == FAULT_NAMES.end()) throw usage_error("has an unknown fault");
  end.fault = static_cast<Fault>(fault - FAULT_NAMES.begin());
  end.early = recorded_line(header, "ended_early");
  if (header.records <= classic::MOST_RECORDS && recorded_number(header, RECORDS) != header.records)
    throw usage_error("is damaged: the number of its ticks is not the one that the session wrote; use a copy that is not damaged");
  return end;
}

}  // namespace wholehand::device
