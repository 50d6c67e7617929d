// SPDX-License-Identifier: MIT
#include "sweeps/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "shaders/layout.h"

namespace wholehand::sweeps {
namespace {

// Where the scene sets the number of grips.
std::string place_of_grips(const Scene& scene) { return scene.grips.place.empty() ? scene.file : scene.grips.place; }

double stored_per_vessel(const Scene& scene) {
  const GripsData& grips = scene.grips;
  if (grips.sampling == Sampling::sobol) return static_cast<double>(grips.count);
  double product = 1;
  for (const Axis* axis : {&grips.azimuth, &grips.height, &grips.obliquity, &grips.roll, &grips.offset, &grips.hand_scale}) {
    product *= static_cast<double>(axis->values.size());
  }
  return product;
}

AxisKind kind_of(const Axis& axis, bool is_sobol) {
  if (axis.values.size() < 2) return AxisKind::number;
  if (!axis.is_range) return AxisKind::list;
  return is_sobol ? AxisKind::range : AxisKind::steps;
}

}  // namespace

PlanAxis::PlanAxis(std::string axis_name, std::string axis_units, std::string meaning, int dimension, const Axis& asked,
                   bool is_sobol)
    : name(std::move(axis_name)),
      units(std::move(axis_units)),
      long_name(std::move(meaning)),
      axis(dimension),
      values(asked.values),
      kind(kind_of(asked, is_sobol)) {
  if (values.empty()) return;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  low = *least;
  high = *most;
}

SweepSize sweep_size(const Scene& scene, double bytes_per_grip) {
  SweepSize size;
  size.grips = stored_per_vessel(scene) * static_cast<double>(scene.vessels.size());
  size.states = size.grips;
  if (!scene.tilts.empty()) size.states *= static_cast<double>(scene_fills(scene)) * static_cast<double>(scene.tilts.size());
  size.bytes = size.grips * bytes_per_grip;
  return size;
}

void check_sweep_size(const Scene& scene, const SweepSize& size, double free_bytes) {
  const std::string asked =
      fmt::format("{}: asks for {}, {}, {} of results", place_of_grips(scene),
                  readable_count(size.grips) + (size.grips == 1 ? " grip" : " grips"),
                  readable_count(size.states) + (size.states == 1 ? " state" : " states"), readable_bytes(size.bytes));
  if (!(size.grips <= LARGEST_SWEEP)) {
    throw usage_error(
        fmt::format("{}; one sweep takes at most {} grips: give [grips] fewer values", asked, readable_count(LARGEST_SWEEP)));
  }
  if (size.bytes > free_bytes) {
    throw failure_error(
        fmt::format("{}, but there is room for only {}: keep fewer variables ([output] keep), give [grips] fewer values, or "
                    "name a file on another disk with -o",
                    asked, readable_bytes(free_bytes)));
  }
}

Plan::Plan(const Scene& scene, bool keeps_vectors)
    : sobol_(scene.grips.sampling == Sampling::sobol),
      height_is_fraction_(scene.grips.height_is_fraction),
      sequence_(scene.grips.seed) {
  const GripsData& grips = scene.grips;
  check_sweep_size(scene, sweep_size(scene, 0), 0);
  if (sobol_ && (grips.count == 0 || grips.count > SOBOL_LARGEST_COUNT)) {
    throw usage_error(fmt::format("{}: [grips] count = {}: Sobol sampling takes 1 to {} points per vessel", place_of_grips(scene),
                                  grips.count, SOBOL_LARGEST_COUNT));
  }
  const auto axis = [this](const char* name, const char* units, const char* meaning, int dimension, const Axis& asked) {
    return PlanAxis(name, units, meaning, dimension, asked, sobol_);
  };
  axes_ = {
      axis("azimuth", "rad", "azimuth of the thumb-index line about the vessel's axis", AXIS_AZIMUTH, grips.azimuth),
      axis("obliquity", "rad", "angle of the thumb-index line to the horizontal", AXIS_OBLIQUITY, grips.obliquity),
      axis("roll", "rad", "angle of the hand about the thumb-index line; 0: hand beside, -pi/2: hand above", AXIS_ROLL, grips.roll),
      axis("offset", "m", "distance of the thumb-index line from the vessel's axis, signed", AXIS_OFFSET, grips.offset),
      axis("hand_scale", "1", "size of the hand, times the scene's own scale", AXIS_HAND_SCALE, grips.hand_scale),
      height_is_fraction_ ? axis("height_fraction", "1", "height of the thumb-index line as a fraction of the vessel's height",
                                 AXIS_HEIGHT, grips.height)
                          : axis("height", "m", "height of the thumb-index line in the vessel's frame", AXIS_HEIGHT, grips.height),
  };
  for (const VesselData& vessel : scene.vessels) vessel_spans_.push_back({vessel.base, vessel.height - vessel.base});
  for (const PlanAxis& checked : axes_) {
    if (checked.values.empty()) throw usage_error(fmt::format("{}: [grips] axis {} has no values", scene.file, checked.name));
  }
  symmetric_ =
      std::all_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) { return vessel.is_symmetric(); });
  const PlanAxis& hands = axes_[PLACE_HAND_SCALE];
  if (hands.values.size() > 1 && hands.values.size() <= MOST_HAND_SCALES && hands.kind != AxisKind::range) {
    for (std::size_t place = 0; place < hands.values.size(); ++place) scale_order_.emplace_back(hands.values[place], place);
    std::sort(scale_order_.begin(), scale_order_.end());
  }
  if (sobol_) {
    grips_ = grips.count;
    return;
  }
  for (std::size_t k = 0; k < axes_.size(); ++k) counts_[k] = axes_[k].values.size();
  if (symmetric_ && !keeps_vectors) {
    copies_ = counts_[PLACE_AZIMUTH];
    counts_[PLACE_AZIMUTH] = 1;
  }
  grips_ = 1;
  for (const std::uint64_t count : counts_) grips_ *= count;
}

double Plan::axis_value(const PlanAxis& axis, const SobolPoint& point) const {
  const double u = point[axis.axis];
  const auto& values = axis.values;
  if (axis.kind == AxisKind::range) return axis.low + u * (axis.high - axis.low);
  if (values.size() == 1) return values[0];
  return values[std::min(values.size() - 1, static_cast<std::size_t>(u * static_cast<double>(values.size())))];
}

// A fraction counts from the lowest point to the mouth.
std::array<double, 2> Plan::height_span(std::size_t vessel) const {
  return height_is_fraction_ ? vessel_spans_[vessel] : std::array<double, 2>{0, 1};
}

double Plan::height(std::size_t vessel, double value) const {
  const auto [base, unit] = height_span(vessel);
  return base + value * unit;
}

void Plan::coordinates(int axis, std::uint64_t first, std::size_t count, double* out) const {
  const PlanAxis& chosen = axes_[axis];
  if (sobol_) {
    std::array<SobolPoint, 256> points;
    for (std::size_t done = 0; done < count; done += points.size()) {
      const std::size_t n = std::min(points.size(), count - done);
      sequence_.points(first + done, n, points.data());
      for (std::size_t i = 0; i < n; ++i) out[done + i] = axis_value(chosen, points[i]);
    }
    return;
  }
  std::uint64_t faster = 1;  // grips per step of this axis
  for (std::size_t k = axis + 1; k < axes_.size(); ++k) faster *= counts_[k];
  for (std::size_t i = 0; i < count; ++i) out[i] = chosen.values[(first + i) / faster % counts_[axis]];
}

void Plan::fill(std::size_t vessel, std::uint64_t first, std::size_t count, GripInput* out) const {
  const auto [base, height_unit] = height_span(vessel);
  if (sobol_) {
    std::array<SobolPoint, 256> points;
    for (std::size_t done = 0; done < count; done += points.size()) {
      const std::size_t n = std::min(points.size(), count - done);
      sequence_.points(first + done, n, points.data());
      for (std::size_t i = 0; i < n; ++i) {
        const SobolPoint& p = points[i];
        out[done + i] = {base + axis_value(axes_[PLACE_HEIGHT], p) * height_unit,
                         axis_value(axes_[PLACE_AZIMUTH], p),
                         axis_value(axes_[PLACE_OBLIQUITY], p),
                         axis_value(axes_[PLACE_ROLL], p),
                         axis_value(axes_[PLACE_OFFSET], p),
                         axis_value(axes_[PLACE_HAND_SCALE], p)};
      }
    }
    return;
  }
  std::array<std::uint64_t, 6> digit{};
  for (std::uint64_t k = axes_.size(), rest = first; k-- > 0; rest /= counts_[k]) digit[k] = rest % counts_[k];
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = [&](PlanPlace place) { return axes_[place].values[digit[place]]; };
    out[i] = {base + value(PLACE_HEIGHT) * height_unit,
              value(PLACE_AZIMUTH),
              value(PLACE_OBLIQUITY),
              value(PLACE_ROLL),
              value(PLACE_OFFSET),
              value(PLACE_HAND_SCALE)};
    for (std::size_t k = axes_.size(); k-- > 0;) {  // count on by one
      if (++digit[k] < counts_[k]) break;
      digit[k] = 0;
    }
  }
}

void Plan::hand_scales_of(std::uint64_t first, std::size_t count, std::size_t* out) const {
  if (scale_order_.empty()) {
    std::fill_n(out, count, 0);
    return;
  }
  std::array<double, 256> values;
  for (std::size_t done = 0; done < count; done += values.size()) {
    const std::size_t n = std::min(values.size(), count - done);
    coordinates(PLACE_HAND_SCALE, first + done, n, values.data());
    for (std::size_t i = 0; i < n; ++i) {
      const std::pair<double, std::size_t> least{values[i], 0};
      out[done + i] = std::lower_bound(scale_order_.begin(), scale_order_.end(), least)->second;
    }
  }
}

std::size_t Plan::hand_scale_of(std::uint64_t grip) const {
  std::size_t place = 0;
  hand_scales_of(grip, 1, &place);
  return place;
}

GripInput Plan::grip(std::size_t vessel, std::uint64_t index) const {
  GripInput grip;
  fill(vessel, index, 1, &grip);
  return grip;
}

}  // namespace wholehand::sweeps
