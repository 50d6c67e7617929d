// SPDX-License-Identifier: MIT
// Tries grips as a person takes them, placed with the deviations of [robust].
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"
#include "evidence/trials/options.h"
#include "evidence/trials/sample.h"
#include "evidence/trials/trial.h"
#include "sweeps/lists/best.h"
#include "sweeps/lists/robust.h"

namespace wholehand {

class GripScatter {
 public:
  // `scene` has [robust], and the friction of the trials. Opens an engine for each friction of the deviations. Throws Error as `open` does.
  GripScatter(const Scene& scene, const TrialSettings& settings, const OpenTrialEngine& open);

  // The grip at `count` deviations, each tried in all cases, which are fill_tilt. Each grip has its own deviations, drawn by its vessel, its number
  // and the seed; they differ from those by which a sweep ranks it.
  std::vector<Placement> place(const TrialGrip& grip, const std::vector<TrialCase>& cases, std::size_t count,
                               std::uint64_t seed) const;

  // A grip's score over the deviations by which a sweep ranks it.
  sweeps::RobustScore robust(const TrialGrip& grip) const;

 private:
  // The scene with one of the frictions.
  struct Level {
    Scene scene;
    std::unique_ptr<const Evaluator> core;
    std::unique_ptr<TrialEngine> engine;
  };
  const Level& level_of(std::size_t deviation, std::size_t count) const;

  RobustData robust_;
  std::vector<sweeps::Deviation> ranking_;  // of a sweep
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace wholehand
