// SPDX-License-Identifier: MIT
#include "app/program/values.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <vector>

#include "base/text/error.h"
#include "base/text/nearest_name.h"
#include "core/reader/text.h"

namespace wholehand {
namespace {

template <class Number>
bool parse_whole(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// Written so that a NaN is out of range.
bool is_within(double value, const Quantity& quantity) { return value >= quantity.low && value <= quantity.high; }

}  // namespace

double parse_quantity(const std::string& text, const std::string& option, const Quantity& quantity) {
  double value = 0;
  if (!parse_whole(text, value) || !is_within(value, quantity)) {
    throw usage_error(fmt::format("{} {}; allowed: a number, {}", option, in_quotes(text), describe(quantity)));
  }
  return to_si(value, quantity.unit);
}

Triple parse_triple(const std::string& text, const std::string& option, const Quantity& quantity) {
  Triple point{};
  std::string_view rest = text;
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = rest.find(',');
    double value = 0;
    if ((comma == std::string_view::npos) != (k == 2) || !parse_whole(rest.substr(0, comma), value) ||
        !is_within(value, quantity)) {
      throw usage_error(
          fmt::format("{} {}; allowed: three numbers x,y,z without spaces, each {}", option, in_quotes(text), describe(quantity)));
    }
    point[k] = to_si(value, quantity.unit);
    if (k < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

std::int64_t parse_integer(const std::string& text, const std::string& option, IntegerRange range) {
  std::int64_t value = 0;
  if (!parse_whole(text, value) || value < range.low || value > range.high) {
    throw usage_error(fmt::format("{} {}; allowed: a whole number, {} to {}", option, in_quotes(text), range.low, range.high));
  }
  return value;
}

double parse_duration(const std::string& text, const std::string& option) {
  constexpr std::int64_t MOST = std::int64_t{99'999} * 3600;
  std::int64_t seconds = 0;
  int parts = 0;
  bool is_good = true;
  for (std::size_t at = 0; at <= text.size() && is_good; ++parts) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    const std::string part = text.substr(at, end - at);
    std::int64_t value = 0;
    is_good =
        parts < 3 && parse_whole(part, value) && value >= 0 && value <= MOST && (parts == 0 || (value < 60 && part.size() == 2));
    seconds = seconds * 60 + value;
    at = end + 1;
  }
  if (!is_good || seconds < 1 || seconds > MOST)
    throw usage_error(fmt::format("{} {}; allowed: seconds, M:SS or H:MM:SS, of 1 s or more", option, in_quotes(text)));
  return static_cast<double>(seconds);
}

int parse_view_port(const std::string& text, bool has_view) {
  if (text.empty()) return 0;
  if (!has_view) throw usage_error("--view-port: there is no view; add --view");
  return static_cast<int>(parse_integer(text, "--view-port", {0, 65535}));
}

Precision parse_precision(const std::string& text) {
  if (text == "float") return Precision::single;
  if (text == "double") return Precision::full;
  throw usage_error(fmt::format("--precision {}; allowed: float or double", in_quotes(text)));
}

std::size_t find_vessel(const Scene& scene, const std::string& name) {
  std::vector<std::string_view> names;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    if (scene.vessels[v].name == name) return v;
    names.push_back(scene.vessels[v].name);
  }
  throw usage_error(fmt::format("--vessel {}: {} has no such vessel; the nearest is '{}'", in_quotes(name), in_quotes(scene.file),
                                nearest_name(name, names)));
}

}  // namespace wholehand
