// SPDX-License-Identifier: MIT
#include "evidence/trials/disagreements.h"

#include "base/text/error.h"
#include "evidence/report/grips.h"
#include "evidence/trials/recording.h"
#include "sweeps/grips/forces.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/svg.h"

namespace wholehand {
namespace {

void draw_disagreement(const TrialPredictor& predictor, const TrialGrip& grip, const TrialCase& one, ShownDisagreement& shown) {
  const double tilt = one.protocol == TrialProtocol::fill_tilt ? one.tilt : 0;
  sweeps::GripReport report = sweeps::make_grip_report(predictor.scene(), grip.vessel, grip.grip, {{one.fill}, {tilt}},
                                                       sweeps::core_grip_methods(predictor.scene(), predictor.core(), "core"));
  sweeps::add_holding(report, predictor.scene(), grip.vessel, *predictor.core());
  shown.drawing = front_and_side(sweeps::grip_svg(predictor.scene(), grip.vessel, report));
  const sweeps::DrawnForces forces(report);
  if (!forces.empty()) shown.forces = forces.words();
}

}  // namespace

std::vector<TrialCase> cases_up_to(const std::vector<TrialCase>& cases, std::size_t place) {
  const TrialCase& last = cases[place];
  if (last.protocol == TrialProtocol::six_forces) return {last};
  std::vector<TrialCase> run;
  for (const TrialCase& one : cases)
    if (one.protocol == last.protocol && one.fill == last.fill && one.tilt <= last.tilt) run.push_back(one);
  return run;
}

namespace {

// A failure here only affects this disagreement: the trials are finished, and their tables stand without it.
std::vector<TrialTrack> draw_and_run(const TrialPredictor& predictor, const TrialEngine& engine, const TrialGrip& grip,
                                     const std::vector<TrialCase>& cases, std::size_t place, ShownDisagreement& shown) {
  std::vector<TrialTrack> tracks;
  try {
    draw_disagreement(predictor, grip, cases[place], shown);
    engine.run(grip.vessel, grip.grip, cases_up_to(cases, place), &tracks);
  } catch (const Error& error) {
    shown.error = error.what();
  }
  return tracks;
}

}  // namespace

std::vector<ShownDisagreement> show_disagreements(const TrialFiles& files, FileSet& set, const Scene& scene,
                                                  const TrialPredictor& predictor, const TrialEngine& engine,
                                                  const TriedGrips& tried, const TrialAnalysis& analysis,
                                                  const std::atomic<bool>& stop) {
  std::vector<ShownDisagreement> all;
  for (const Disagreement& which : analysis.disagreements) {
    if (stop) return all;
    ShownDisagreement shown{which, "", "", "", ""};
    const TrialGrip& grip = tried.grips[which.grip];
    const TrialCase& one = tried.cases_of(which.grip)[which.place];
    const std::string path = files.recording(all.size() + 1);
    const std::vector<TrialTrack> tracks = draw_and_run(predictor, engine, grip, tried.cases_of(which.grip), which.place, shown);
    try {
      if (shown.error.empty()) {
        write_trial_recording(set.temporary_path(path), scene, *predictor.core(), engine.name(), grip, one,
                              tried.found[which.grip].outcomes[which.place], tracks);
        shown.recording = TrialFiles::recording_name(all.size() + 1);
      }
    } catch (const Error& error) {
      // a full disk: once there is room, --resume writes what the page would lack
      if (error.code == ExitCode::failure) throw;
      shown.error = set.with_own_names(error.what());
    }
    if (shown.recording.empty()) set.remove_on_commit(path);
    all.push_back(shown);
  }
  for (std::size_t number = all.size() + 1; number <= MOST_DISAGREEMENTS; ++number) set.remove_on_commit(files.recording(number));
  return all;
}

}  // namespace wholehand
