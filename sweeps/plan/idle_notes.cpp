// SPDX-License-Identifier: MIT
#include "sweeps/plan/idle_notes.h"

#include "base/text/text.h"
#include "core/planes.h"

namespace wholehand::sweeps {

std::string idle_strength_note(const Scene& scene) {
  if (!scene.strength || scene.strength->place.empty() || !scene.tilts.empty()) return "";
  return "note: [strength] changes nothing here, since the scene has no [tilts] at which an effort could be computed; add [tilts] "
         "with its deg, or leave [strength] out";
}

std::string unjudged_note(const Scene& scene, const Plan& plan) {
  std::vector<std::string> missing;
  if (!scene.table) missing.emplace_back("without [table] fingers may reach under the base");
  if (!scene.strength) missing.emplace_back("with [strength] efforts = false any hand is strong enough");
  if (scene.tilts.empty()) missing.emplace_back("without [tilts] no force is judged");
  if (plan.grips() == 1) missing.emplace_back("with one grip a vessel there is nothing to compare");
  if (missing.empty()) return "";
  return "not judged: " + joined(missing, "; ") + " (`wholehand new` writes a scene with all of them)\n";
}

std::vector<std::string> idle_notes(const Scene& scene, const Plan& plan, std::size_t best) {
  std::vector<std::string> notes;
  if (const std::string note = idle_strength_note(scene); !note.empty()) notes.push_back(note);
  if (!scene.robust) return notes;
  if (best == 0) {
    notes.emplace_back(
        "note: [robust] changes nothing here, since only the best grips have robust scores, and the sweep lists none; set "
        "'best' of [output] above 0, or leave [robust] out");
    return notes;
  }
  const auto weights = effective_weights(scene);
  if (scene.robust->friction > 0 && weights[5] == 0) {
    notes.push_back("note: [robust] friction changes no score here, since " +
                    std::string(scene.tilts.empty() ? "the scene has no [tilts], and without them no force counts"
                                                    : "the weight of hold is 0") +
                    "; leave it out, and the scores take less time");
  }
  if (scene.robust->azimuth > 0 && plan.is_symmetric())
    notes.emplace_back(
        "note: [robust] azimuth_deg changes no score here, since all vessels are bodies of revolution; leave it out");
  return notes;
}

}  // namespace wholehand::sweeps
