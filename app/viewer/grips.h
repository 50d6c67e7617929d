// SPDX-License-Identifier: MIT
// Grips in the browser: single ones, or the best of a sweep, each at any fill and tilt.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/frame.h"
#include "app/viewer/server.h"
#include "core/evaluator.h"
#include "sweeps/grips/methods.h"

namespace wholehand {

// A better grip that a sweep found beside one of its own.
struct RefinedView {
  GripInput grip;
  double score = 0;
};

// The grip's scores at the random deviations of a sweep.
struct RobustView {
  double mean = 0, low = 0;  // low: the 10th percentile
};

// A grip to show, its name, and the score of its list; without one the core's is shown.
struct ViewedGrip {
  std::size_t vessel = 0;
  GripInput grip;
  std::string label;
  std::optional<double> score = std::nullopt;
  std::optional<RefinedView> refined = std::nullopt;  // shown in words, not in the picture
  std::optional<RobustView> robust = std::nullopt;
};

// The grips of a scene with the core's numbers. From any thread.
class GripsView {
 public:
  // Evaluates them all. Leaves out those that the core finds infeasible, with a line in `notes` each. Throws Error: (usage) what make_core_evaluator
  // throws, or that none is left.
  GripsView(const Scene& scene, const std::vector<ViewedGrip>& grips, std::vector<std::string>& notes);
  ~GripsView();
  GripsView(const GripsView&) = delete;
  GripsView& operator=(const GripsView&) = delete;

  std::size_t size() const;
  const GripResult& result(std::size_t grip) const;  // vessel frame, as `grip --json` has it

  // A grip at a fill (of the capacity; 0 in a scene without liquid) and a tilt, rad. The vessel starts at its place in the scene, turns about the
  // middle of the tips in its pouring direction, and is lifted so that neither it nor the hand is below the table.
  ViewFrame frame(std::size_t grip, double fill, double tilt) const;
  // scene.json and state of it, for a server, which must not outlive this. `asked`: the page's initial and largest fills and tilts; by default the
  // scene's own. Forces and scores are always the scene's.
  ViewContent content(const std::string& title, const sweeps::StateAxes& asked) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wholehand
