// SPDX-License-Identifier: MIT
#include "app/viewer/control.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files/json.h"
#include "base/text/error.h"
#include "core/reader/text.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using nlohmann::json;

constexpr const char* KEYS = "allowed: position, rotation, gap, buttons, sequence, each once";
constexpr std::int64_t LARGEST_SEQUENCE = (std::int64_t{1} << 53) - 1;  // JavaScript's largest whole number

double parse_number(const json& value, const char* key, double most) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(std::abs(number) <= most))
    throw usage_error(fmt::format("control: '{}': allowed: numbers from {:g} to {:g}", key, -most, most));
  return number;
}

template <std::size_t N>
std::array<double, N> parse_numbers(const json& value, const char* key, double most) {
  if (!value.is_array() || value.size() != N) throw usage_error(fmt::format("control: '{}': allowed: {} numbers", key, N));
  std::array<double, N> numbers{};
  for (std::size_t k = 0; k < N; ++k) numbers[k] = parse_number(value[k], key, most);
  return numbers;
}

std::int64_t whole_of(const json& value, const char* key, std::int64_t most) {
  // what is beyond 2^63 has another type and is no signed number
  const bool is_whole = value.is_number_integer() && !(value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX);
  const std::int64_t number = is_whole ? value.get<std::int64_t>() : -1;
  if (number < 0 || number > most) throw usage_error(fmt::format("control: '{}': allowed: whole numbers from 0 to {}", key, most));
  return number;
}

// The nearest one up to second order: the first column keeps its direction, because the fingers close along it.
Rotation rotation_of(const Rotation& given) {
  Mat3 m = to_mat3(given);
  const Mat3 off = glm::transpose(m) * m - Mat3(1);
  double skew = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) skew = std::max(skew, std::abs(off[i][j]));
  if (skew > 2 * CONTROL_SKEW || glm::determinant(m) <= 0) {
    throw usage_error(
        "control: 'rotation' is not a rotation; allowed: three unit columns at right angles, right-handed, row by row");
  }
  m[0] = glm::normalize(m[0]);
  m[1] = glm::normalize(m[1] - glm::dot(m[0], m[1]) * m[0]);
  m[2] = glm::cross(m[0], m[1]);
  return to_rotation(m);
}

}  // namespace

device::ViewControl parse_view_control(std::string_view body) {
  if (body.size() > LARGEST_CONTROL) {
    throw usage_error(fmt::format("control: {} bytes; allowed: at most {}", body.size(), LARGEST_CONTROL));
  }
  const json object = try_json(body);
  if (object.is_discarded() || !object.is_object()) throw usage_error(fmt::format("control: this is not a JSON object; {}", KEYS));
  for (const char* key : {"position", "rotation", "gap", "buttons", "sequence"}) {
    if (!object.contains(key)) throw usage_error(fmt::format("control: '{}' is missing; {}", key, KEYS));
  }
  for (const auto& [key, value] : object.items()) {
    if (key == "position" || key == "rotation" || key == "gap" || key == "buttons" || key == "sequence") continue;
    throw usage_error(fmt::format("control: unknown key {}; {}", in_quotes(key), KEYS));
  }
  device::ViewControl control;
  control.position = parse_numbers<3>(object["position"], "position", FURTHEST_CONTROL);
  control.rotation = rotation_of(parse_numbers<9>(object["rotation"], "rotation", 2));
  control.gap = parse_number(object["gap"], "gap", FURTHEST_CONTROL);
  control.buttons = static_cast<std::uint32_t>(whole_of(object["buttons"], "buttons", UINT32_MAX));
  control.sequence = whole_of(object["sequence"], "sequence", LARGEST_SEQUENCE);
  return control;
}

}  // namespace wholehand
