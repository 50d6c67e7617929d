// SPDX-License-Identifier: MIT
#include "evidence/trials/mujoco_engine.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "base/text/error.h"
#include "evidence/trials/grip_trial.h"

namespace wholehand {
namespace {

constexpr std::size_t FEW_PIECES = 8;

class MujocoEngine final : public TrialEngine {
 public:
  MujocoEngine(const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings)
      : scene_(scene), evaluator_(evaluator), settings_(settings), library_(load_mujoco()) {}

  std::string name() const override { return library_.name; }

  void check(std::size_t vessel) const override {
    check_hand();
    form(vessel);
  }

  std::string form_text(std::size_t vessel) const override { return form(vessel).text; }

  std::vector<TrialOutcome> run(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases,
                                std::vector<TrialTrack>* tracks) const override {
    check_hand();
    std::vector<TrialOutcome> outcomes(cases.size());
    if (tracks) tracks->assign(cases.size(), {});
    // a model of its own for every grip and every call, so that other threads do not change the bits
    const BodyForm& body = form(vessel);
    const int room = body.names.size() > FEW_PIECES ? MOST_PIECE_CONTACTS : MOST_CONTACTS;
    GripTrial trial(library_, scene_, evaluator_, settings_, vessel, body, grip, room);
    tilt(trial, cases, outcomes, tracks);
    push(trial, cases, outcomes, tracks);
    return outcomes;
  }

 private:
  void check_hand() const {
    if (settings_.model != TrialModel::hand || scene_.pose != Pose::paper) return;
    throw usage_error(
        "pose = \"paper\" turns the points of the hand one by one, so that its bones have no joints; trials take pose = "
        "\"articulated\" or \"rigged\"");
  }

  // Made on first use, because the pieces of a mesh take seconds.
  const BodyForm& form(std::size_t vessel) const {
    const std::lock_guard guard(making_forms_);
    const auto known = forms_.find(vessel);
    return known != forms_.end() ? known->second : forms_.emplace(vessel, trial_form(scene_, vessel)).first->second;
  }

  // All cases of a fill are one run.
  void tilt(GripTrial& trial, const std::vector<TrialCase>& cases, std::vector<TrialOutcome>& outcomes,
            std::vector<TrialTrack>* tracks) const {
    std::map<double, std::vector<std::size_t>> fills;
    for (std::size_t k = 0; k < cases.size(); ++k)
      if (cases[k].protocol == TrialProtocol::fill_tilt) fills[cases[k].fill].push_back(k);
    for (auto& [fill, places] : fills) {
      std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return cases[a].tilt < cases[b].tilt; });
      std::vector<double> tilts;
      for (const std::size_t k : places) tilts.push_back(cases[k].tilt);
      TrialTrack track;
      std::vector<std::size_t> ends;
      const auto found = trial.tilt(fill, tilts, tracks ? &track : nullptr, &ends);
      for (std::size_t i = 0; i < places.size(); ++i) {
        outcomes[places[i]] = found[i];
        if (!tracks) continue;
        auto& kept = (*tracks)[places[i]];
        kept.interval = track.interval;
        kept.frames.assign(track.frames.begin(), track.frames.begin() + static_cast<std::ptrdiff_t>(ends[i]));
      }
    }
  }

  void push(GripTrial& trial, const std::vector<TrialCase>& cases, std::vector<TrialOutcome>& outcomes,
            std::vector<TrialTrack>* tracks) const {
    for (std::size_t k = 0; k < cases.size(); ++k) {
      if (cases[k].protocol != TrialProtocol::six_forces) continue;
      const auto& material = settings_.materials.at(static_cast<std::size_t>(cases[k].material));
      outcomes[k] = trial.push(cases[k].fill, cases[k].direction, material, tracks ? &(*tracks)[k] : nullptr);
    }
  }

  const Scene& scene_;
  const Evaluator& evaluator_;
  const TrialSettings settings_;
  const MujocoLibrary& library_;
  mutable std::mutex making_forms_;
  mutable std::map<std::size_t, BodyForm> forms_;  // of vessels
};

}  // namespace

std::unique_ptr<TrialEngine> make_mujoco_engine(const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings) {
  return std::make_unique<MujocoEngine>(scene, evaluator, settings);
}

}  // namespace wholehand
