// SPDX-License-Identifier: MIT
// Grips that have been tried: their predictions, and what the engine did with them.
#pragma once

#include <string>
#include <vector>

#include "evidence/trials/predictions.h"
#include "evidence/trials/sample.h"
#include "evidence/trials/trial.h"
#include "sweeps/lists/best.h"

namespace wholehand {

// What was found of one grip: outcomes in the order of its vessel's cases. Placements and robust score where a scatter was asked for.
struct GripFinding {
  GripPrediction prediction;
  std::vector<TrialOutcome> outcomes;
  std::vector<Placement> placements;
  RobustScore robust;
};

struct TriedGrips {
  std::vector<std::vector<TrialCase>> cases;  // of each vessel of the scene; empty where it is not tried
  std::vector<TrialGrip> grips;
  std::vector<GripFinding> found;  // of each grip
  const std::vector<TrialCase>& cases_of(std::size_t grip) const { return cases[grips[grip].vessel]; }
};

// A trial that tests its own state: it was not discarded, and its state was reached, not lost at a smaller tilt.
inline bool is_conclusive(const TrialOutcome& outcome) { return !outcome.discarded && outcome.reason != TrialReason::earlier; }

// Whether a contact slid farther than it may in a firm grip. A vessel may be held all the same.
inline bool has_slipped(const TrialOutcome& outcome, const TrialSettings& settings) {
  return !outcome.discarded && outcome.slip > settings.slip;
}

// What became of placements of grips.
struct PlacementCount {
  std::size_t all = 0, held = 0, impossible = 0, discarded = 0;
  std::array<std::size_t, TRIAL_REASON_NAMES.size()> reasons{};  // of those that are possible and were not held
  void add(const std::vector<Placement>& placements);
};

constexpr std::array<const char*, 2> TRIAL_PROTOCOL_NAMES{"fill-tilt", "six-forces"};
constexpr std::array<const char*, 2> TRIAL_MODEL_NAMES{"hand", "contacts"};

// How trials.csv begins.
inline constexpr std::string_view TRIALS_CSV_START = "vessel,grip,fill,tilt_rad,protocol,effort,";

// The table: a row a trial, SI units. Numbers read back as they were; "inf" where there is no limit, nothing where there is no
// number.
std::string trials_csv(const Scene& scene, const TrialSettings& settings, const TriedGrips& tried);

}  // namespace wholehand
