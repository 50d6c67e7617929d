// SPDX-License-Identifier: MIT
#include "evidence/report/source.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/core_backend.h"

namespace wholehand {

// A step that is prime, so that every axis varies.
std::vector<std::uint64_t> sample_places(std::uint64_t all, std::size_t count) {
  constexpr std::uint64_t STEP = 2654435761, START = 12345;
  std::vector<std::uint64_t> places(std::min<std::uint64_t>(all, count));
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = all <= count ? i : (i * STEP + START) % all;
  return places;
}

GripInput stored_grip(const sweeps::Plan& plan, const Scene& scene, std::size_t vessel, std::uint64_t place) {
  GripInput grip = plan.grip(vessel, place % plan.grips());
  if (plan.copies() > 1) grip.azimuth = scene.grips.azimuth.values[place / plan.grips()];
  return grip;
}

GatheredPlanes planes_by_core(const ReportSource& source, std::size_t vessel, const std::vector<GripInput>& grips,
                              const std::vector<int>& fields) {
  CoreBackend backend(source.core, source.scene, make_field_set(fields, source.scene), Precision::full, 0);
  return gather(backend, vessel, grips);
}

std::string axis_text(const sweeps::PlanAxis& axis, double scale, const std::string& unit) {
  constexpr std::size_t LISTED = 8;
  std::vector<std::string> numbers;
  if (axis.kind == sweeps::AxisKind::number || (axis.kind == sweeps::AxisKind::list && axis.values.size() <= LISTED)) {
    for (const double value : axis.values) numbers.push_back(plain_number(value * scale));
    return joined(numbers, ", ") + unit;
  }
  const std::string ends = fmt::format("{} to {}{}", plain_number(axis.low * scale), plain_number(axis.high * scale), unit);
  if (axis.kind == sweeps::AxisKind::range) return ends;
  return fmt::format("{} ({} values)", ends, readable_number(axis.values.size()));
}

std::string grip_text(const sweeps::Plan& plan, const GripInput& grip, std::string (*number)(double value, int digits),
                      const char* degree) {
  std::string text = fmt::format("height {} mm", number(grip.height * 1e3, 1));
  const auto add = [&](int place, const char* name, double value, int digits, const char* unit) {
    if (plan.varies(place)) text += fmt::format(", {} {}{}", name, number(value, digits), unit);
  };
  add(sweeps::PLACE_ROLL, "roll", degrees(grip.roll), 1, degree);
  add(sweeps::PLACE_OBLIQUITY, "obliquity", degrees(grip.obliquity), 1, degree);
  add(sweeps::PLACE_AZIMUTH, "azimuth", degrees(grip.azimuth), 1, degree);
  add(sweeps::PLACE_OFFSET, "offset", grip.offset * 1e3, 1, " mm");
  add(sweeps::PLACE_HAND_SCALE, "hand scale", grip.hand_scale, 3, "");
  return text;
}

}  // namespace wholehand
