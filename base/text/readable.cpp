// SPDX-License-Identifier: MIT
#include "base/text/readable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace wholehand {

constexpr double LARGEST_GROUPED = 1e15;  // above it whole numbers are no longer exact to people

namespace {

// Commas between the thousands of a decimal number's whole part.
std::string grouped(std::string number) {
  const std::size_t begin = number.find_first_of("0123456789");
  std::size_t at = begin == std::string::npos ? 0 : std::min(number.find_first_not_of("0123456789", begin), number.size());
  while (at > begin + 3) number.insert(at -= 3, 1, ',');
  return number;
}

}  // namespace

std::string readable_bytes(double bytes) {
  static constexpr std::array<const char*, 7> UNITS{"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < UNITS.size()) {
    bytes /= 1000;
    ++unit;
  }
  return fixed_text(bytes, unit > 0 && bytes < 99.95 ? 1 : 0) + " " + UNITS[unit];
}

std::string readable_count(double count) {
  return count >= 1e12 ? fmt::format("{:.1e}", count) : grouped(fmt::format("{:.0f}", count));
}

std::string readable_number(std::uint64_t count) { return readable_count(static_cast<double>(count)); }

std::string counted(std::uint64_t count, const char* thing, const char* things) {
  if (things) return fmt::format("{} {}", readable_number(count), count == 1 ? thing : things);
  return fmt::format("{} {}{}", readable_number(count), thing, count == 1 ? "" : "s");
}

std::string fixed_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1) : grouped(text);
}

std::string plain_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  const std::string text = fmt::format("{:.{}g}", value == 0 ? 0 : value, digits);
  if (text.find("e+") == std::string::npos || std::abs(value) >= LARGEST_GROUPED) return grouped(text);
  return grouped(fmt::format("{:.0f}", std::strtod(text.c_str(), nullptr)));  // no exponent where people read sizes
}

std::string range_text(double value, bool is_end) { return plain_text(value) + (is_end && !std::isnan(value) ? "+" : ""); }

int known_digits(double error, int digits) {
  if (!(error > 0)) return digits;
  return std::clamp(static_cast<int>(-std::floor(std::log10(error))), 0, digits);
}

std::string readable_duration(double seconds) {
  const double whole = std::ceil(std::clamp(seconds, 0.0, 1e9));
  if (whole < 120) return fmt::format("{:.0f} s", whole);
  if (whole < 7200) return fmt::format("{:.0f} min {:.0f} s", std::floor(whole / 60), std::fmod(whole, 60));
  return fmt::format("{:.0f} h {:.0f} min", std::floor(whole / 3600), std::floor(std::fmod(whole, 3600) / 60));
}

}  // namespace wholehand
