// SPDX-License-Identifier: MIT
// Tried grips: their predictions, and what the engine did with them.
#pragma once

#include <string>
#include <vector>

#include "evidence/trials/predictions.h"
#include "evidence/trials/sample.h"
#include "evidence/trials/trial.h"
#include "sweeps/lists/best.h"

namespace wholehand {

// The results of one grip: outcomes in the order of its vessel's cases. Placements and robust score if a scatter was requested.
struct GripFinding {
  GripPrediction prediction;
  std::vector<TrialOutcome> outcomes;
  std::vector<Placement> placements;
  sweeps::RobustScore robust;
};

struct TriedGrips {
  std::vector<std::vector<TrialCase>> cases;  // of each vessel of the scene; empty if it is not tried
  std::vector<std::string> forms;             // of each vessel: what its model is; empty: its outline's own
  std::vector<TrialGrip> grips;
  std::vector<GripFinding> found;  // of each grip
  const std::vector<TrialCase>& cases_of(std::size_t grip) const { return cases[grips[grip].vessel]; }
};

// Whether a trial tests its own state: it was not discarded, and reached its state instead of being lost at a smaller tilt.
inline bool is_conclusive(const TrialOutcome& outcome) { return !outcome.discarded && outcome.reason != TrialReason::earlier; }

// Whether a contact slid farther than it may in a firm grip. The vessel may still be held.
inline bool has_slipped(const TrialOutcome& outcome, const TrialSettings& settings) {
  return !outcome.discarded && outcome.slip > settings.slip;
}

// The results of placements of grips.
struct PlacementCount {
  std::size_t all = 0, held = 0, impossible = 0, discarded = 0;
  std::array<std::size_t, TRIAL_REASON_NAMES.size()> reasons{};  // of those that are possible and were not held
  void add(const std::vector<Placement>& placements);
};

constexpr std::array<const char*, 2> TRIAL_PROTOCOL_NAMES{"fill-tilt", "six-forces"};
constexpr std::array<const char*, 2> TRIAL_MODEL_NAMES{"hand", "contacts"};

// How trials.csv begins.
inline constexpr std::string_view TRIALS_CSV_START = "vessel,grip,fill,tilt_rad,protocol,effort,";

// The table: one row per trial, SI units. Numbers read back exactly; "inf" if there is no limit, empty if there is no number.
std::string trials_csv(const Scene& scene, const TrialSettings& settings, const TriedGrips& tried);

}  // namespace wholehand
