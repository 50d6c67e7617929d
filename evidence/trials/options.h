// SPDX-License-Identifier: MIT
// Options of trials besides their scene, and who answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"
#include "evidence/trials/trial.h"

namespace wholehand {

struct TrialOptions {
  std::string folder;                 // for all files
  std::size_t best = 20;              // grips of each vessel
  std::size_t grips = 400;            // of the stratified sample, of all vessels together
  std::optional<std::size_t> vessel;  // that alone; absent: all
  std::vector<double> fills;          // empty: usual_fills
  std::vector<double> tilts;          // rad, ascending; empty: usual_tilts
  bool fill_tilt = true, six_forces = false;
  TrialSettings settings;
  std::uint64_t seed = 1;
  int threads = 0;          // 0: all
  std::size_t scatter = 0;  // placements of each grip with deviations of [robust]; 0: none
  bool quick = false;
  bool resume = false;
  std::size_t most_looked = std::size_t{1} << 18;  // grips of a vessel whose scores are considered for the sample
};

// Fewer grips and states, to take less than a minute. Apply after the protocol, on which it depends.
void make_quick(TrialOptions& options);

// The engine for a scene. Throws Error: (failure) it is missing; (usage) a vessel has no model.
using OpenTrialEngine = std::function<std::unique_ptr<TrialEngine>(const Scene&, const Evaluator&, const TrialSettings&)>;

}  // namespace wholehand
