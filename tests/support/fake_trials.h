// SPDX-License-Identifier: MIT
// A stand-in for a physics engine, and a scene with few grips to try with it.
#pragma once

#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/numbers/random_bits.h"
#include "base/text/error.h"
#include "core/reader/reader.h"
#include "evidence/trials/options.h"
#include "tests/support/scenes.h"

namespace wholehand {

// Two vessels of the default scene with its strength, 40 grips of each, and few states.
inline Scene scene_for_trials() {
  Scene scene = three_beakers();
  scene.vessels.erase(scene.vessels.begin() + 1);
  scene.liquid->fills = {0, 0.5, 1};
  scene.tilts = linspace(0, radians(150), 6);
  scene.name = "trial scene";
  scene.text = "the text of a scene";
  scene.strength = StrengthData{};
  scene.grips.height = axis_of(0.3, 0.9, 5);
  scene.grips.obliquity = axis_of(0, radians(10), 2);
  scene.grips.roll = axis_of(radians(-60), 0, 4);
  return scene;
}

// The shipped scene with few grips: its text is one that recordings can have.
inline Scene shipped_scene_for_trials() {
  Scene scene = read_scene_file(std::string(WHOLEHAND_SOURCE_DIR) + "/examples/scenes/three_beakers.toml");
  const Scene few = scene_for_trials();
  scene.grips = few.grips;
  scene.tilts = few.tilts;
  return scene;
}

inline TrialOptions few_trials(const std::string& folder) {
  TrialOptions options;
  options.folder = folder;
  options.best = 2;
  options.grips = 16;
  options.threads = 2;
  return options;
}

// Holds what takes an effort below 1, roughly, give or take a factor that the grip's own numbers draw.
class FakeTrialEngine : public TrialEngine {
 public:
  explicit FakeTrialEngine(const Scene& scene) : core_(make_core_evaluator(scene)) {
    for (const VesselData& vessel : scene.vessels) names_.push_back(vessel.name);
  }

  std::string name() const override { return engine_name; }

  void check(std::size_t vessel) const override {
    if (names_[vessel] == without_model) throw usage_error("vessel '" + without_model + "' has no model: it is in no piece");
  }

  std::vector<TrialOutcome> run(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases,
                                std::vector<TrialTrack>* tracks) const override {
    if (before_run) before_run();
    if (before_tracks && tracks) before_tracks();
    if (count && !tracks) ++*count;
    GripResult result;
    core_->grip(vessel, grip, result);
    const double worst = 1 / core_->score(vessel, grip, result).terms.hold - 1;
    const double luck = std::exp(spread * (draw(grip) - 0.5));
    std::vector<TrialOutcome> outcomes;
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const bool goes_on = k > 0 && cases[k].protocol == TrialProtocol::fill_tilt && cases[k - 1].fill == cases[k].fill &&
                           cases[k - 1].protocol == TrialProtocol::fill_tilt;
      TrialOutcome one = outcome_of(worst * luck * (0.5 + 0.5 * std::sin(cases[k].tilt)), cases[k]);
      if (goes_on && !outcomes.back().held && !outcomes.back().discarded) one.reason = TrialReason::earlier;
      if (one.reason == TrialReason::earlier) one.held = false;
      if (goes_on && outcomes.back().discarded) one = outcomes.back();
      if (draw(grip) < discarded) one = discarded_outcome(grip);
      outcomes.push_back(one);
      if (tracks) tracks->push_back(track_of(result, one, cases[k]));
    }
    return outcomes;
  }

  std::string engine_name = "stand-in 1";
  double spread = 1;     // of the logarithm of the factor
  double discarded = 0;  // share of the grips
  std::function<void()> before_run;
  std::function<void()> before_tracks;  // before a run with tracks: of a disagreement
  std::atomic<int>* count = nullptr;    // of the runs without tracks: those of the trials, not of the disagreements
  std::string without_model;            // a vessel

 private:
  static double draw(const GripInput& grip) {
    return unit_interval(mixed_bits(std::bit_cast<std::uint64_t>(grip.height) + 3 * std::bit_cast<std::uint64_t>(grip.roll)));
  }

  static TrialOutcome outcome_of(double load, const TrialCase& one) {
    TrialOutcome outcome;
    outcome.held = load < 1;
    outcome.slip = std::min(0.01, 1e-3 * load);
    outcome.turn = std::min(0.5, 0.1 * load);
    outcome.move = std::min(0.06, 0.02 * load);
    if (outcome.held) return outcome;
    outcome.reason = TrialReason::turned;
    outcome.when = 0.5;
    outcome.tilt_lost = one.tilt;
    return outcome;
  }

  static TrialOutcome discarded_outcome(const GripInput& grip) {
    TrialOutcome outcome;
    outcome.discarded = true;
    outcome.held = std::bit_cast<std::uint64_t>(grip.height) % 2 == 0;  // not to be believed
    outcome.reason = TrialReason::diverged;
    outcome.detail = "Nan, Inf or huge value in QACC at DOF 0.\nThe simulation is unstable.";
    return outcome;
  }

  static TrialTrack track_of(const GripResult& result, const TrialOutcome& outcome, const TrialCase& one) {
    TrialTrack track;
    for (int k = 0; k < 100; ++k) {
      TrialFrame frame;
      const double share = k / 99.0;
      frame.time = k * track.interval;
      frame.place = {0, outcome.held ? 0 : -0.05 * share, 0};
      frame.up = {std::sin(share * one.tilt), std::cos(share * one.tilt), 0};
      frame.joints = result.posed;
      track.frames.push_back(frame);
    }
    return track;
  }

  std::unique_ptr<const Evaluator> core_;
  std::vector<std::string> names_;
};

inline OpenTrialEngine open_fake_engine(const std::function<void(FakeTrialEngine&)>& change = {}) {
  return [change](const Scene& scene, const Evaluator&, const TrialSettings&) {
    auto engine = std::make_unique<FakeTrialEngine>(scene);
    if (change) change(*engine);
    return engine;
  };
}

}  // namespace wholehand
