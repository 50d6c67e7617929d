// SPDX-License-Identifier: MIT
// The sources of a report: the result file, the scene that it names, and the core for what the file lacks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/charts/html.h"
#include "base/charts/markup.h"
#include "core/gather.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

struct ReportSource {
  const sweeps::SweepResult& result;
  const Scene& scene;
  const sweeps::Plan& plan;
  std::shared_ptr<const Evaluator> core;     // null: the scene cannot be evaluated here,
  std::string no_core;                       // and this is why
  std::optional<sweeps::GripLists> lists{};  // instead of the sweep's own,
  std::string lists_file{};                  // from this file
};

// `count` elements of `all`, spread irregularly but reproducibly; all of them if there are no more.
std::vector<std::uint64_t> sample_places(std::uint64_t all, std::size_t count);

// A grip by its index in the file, which repeats what one azimuth stands for.
GripInput stored_grip(const sweeps::Plan& plan, const Scene& scene, std::size_t vessel, std::uint64_t place);

// Planes of some grips by the core in double, on all threads. Needs the core.
GatheredPlanes planes_by_core(const ReportSource& source, std::size_t vessel, const std::vector<GripInput>& grips,
                              const std::vector<int>& fields);

// "12 mm", "10, 12, 15 mm", "10 to 20 mm (11 values)", "10 to 20 mm".
std::string axis_text(const sweeps::PlanAxis& axis, double scale, const std::string& unit);

// "58.5 mm", "roll 22.0°, ..": the grip by those of its axes that vary in the sweep. Only for a page; other outputs format numbers and degrees
// differently.
std::string grip_text(const sweeps::Plan& plan, const GripInput& grip,
                      std::string (*number)(double value, int digits) = shown_number, const char* degree = "°");

}  // namespace wholehand
