// SPDX-License-Identifier: MIT
#include "evidence/trials/dataset.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "base/files/files.h"
#include "base/system/version.h"
#include "evidence/trials/cases.h"
#include "evidence/trials/output.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/result_definition.h"

namespace wholehand {
namespace {

constexpr double ABSENT = std::numeric_limits<double>::quiet_NaN();

// One trial with its grip.
struct TrialView {
  const TrialGrip& grip;
  const GripFinding& found;
  const TrialCase& one;
  const CasePrediction& said;
  const TrialOutcome& outcome;
  std::size_t place;  // of the grip
  bool is_push() const { return one.protocol == TrialProtocol::six_forces; }
};

class Dataset {
 public:
  Dataset(const std::string& path, const TriedGrips& tried) : file_(path, TRIALS_REMEDY), tried_(tried) {}

  void write(const Scene& scene, const TrialOptions& options, const TrialOrigin& origin) {
    std::size_t trials = 0;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g) trials += tried_.cases_of(g).size();
    std::vector<std::string> names;
    for (const VesselData& vessel : scene.vessels) names.push_back(vessel.name);
    file_.dimension("vessel", names.size());
    file_.dimension("grip", tried_.grips.size());
    file_.dimension("trial", trials);
    file_.dimension("term", SCORE_TERM_COUNT);
    write_attributes(scene, options, origin);
    file_.labels("vessel", "vessel", names);
    file_.labels("term", "term of the score", {"fingers", "contacts", "depth", "posture", "force", "hold"});
    write_grips();
    write_predictions();
    write_placements();
    write_cases(options.settings);
    write_outcomes(options.settings);
    file_.finish({});
  }

 private:
  using OfGrip = std::function<double(const TrialGrip&, const GripPrediction&)>;
  using OfTrial = std::function<double(const TrialView&)>;

  void write_attributes(const Scene& scene, const TrialOptions& options, const TrialOrigin& origin) {
    const TrialSettings& settings = options.settings;
    file_.text(NC_GLOBAL, "Conventions", "CF-1.8");
    file_.text(NC_GLOBAL, "title", "trials of grips of " + (scene.name.empty() ? std::string("a scene") : scene.name));
    file_.text(NC_GLOBAL, "program", "wholehand");
    file_.text(NC_GLOBAL, "version", version());
    file_.text(NC_GLOBAL, "engine", origin.engine);
    std::string forms;
    for (std::size_t v = 0; v < tried_.forms.size(); ++v)
      if (!tried_.forms[v].empty())
        forms += fmt::format("{}{}: {}", forms.empty() ? "" : "; ", scene.vessels[v].name, tried_.forms[v]);
    if (!forms.empty()) file_.text(NC_GLOBAL, "forms", forms);
    file_.text(NC_GLOBAL, "identity", origin.identity);
    file_.text(NC_GLOBAL, "scene", scene.text);
    file_.text(NC_GLOBAL, "seed", fmt::format("{}", options.seed));
    file_.text(NC_GLOBAL, "model", TRIAL_MODEL_NAMES[static_cast<std::size_t>(settings.model)]);
    const auto number = [this](const char* name, double value) { file_.number(NC_GLOBAL, name, value); };
    number("squeeze", settings.squeeze);
    if (!std::isnan(settings.mass)) number("mass_kg", settings.mass);
    if (!std::isnan(settings.friction)) number("friction", settings.friction);
    number("tilt_rate_rad_s", settings.tilt_rate);
    number("hold_time_s", settings.hold_time);
    number("push_time_s", settings.push_time);
    number("push_acceleration_m_s2", settings.push_acceleration);
    number("largest_move_m", settings.largest_move);
    number("largest_turn_rad", settings.largest_turn);
    number("slip_m", settings.slip);
  }

  void of_grips(const char* name, const char* units, const char* long_name, const OfGrip& value) {
    std::vector<double> values;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g) values.push_back(value(tried_.grips[g], tried_.found[g].prediction));
    file_.doubles(name, {"grip"}, units, long_name, values);
  }

  void integers_of_grips(const char* name, const char* long_name, const std::function<int(const TrialGrip&)>& value,
                         const sweeps::IntegerCodes& codes = {}) {
    std::vector<int> values;
    for (const TrialGrip& grip : tried_.grips) values.push_back(value(grip));
    file_.integers(name, {"grip"}, "", long_name, values, codes);
  }

  std::vector<double> of_each_trial(const OfTrial& value) const {
    std::vector<double> values;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g)
      for (std::size_t k = 0; k < tried_.cases_of(g).size(); ++k) {
        const GripFinding& found = tried_.found[g];
        values.push_back(value({tried_.grips[g], found, tried_.cases_of(g)[k], found.prediction.cases[k], found.outcomes[k], g}));
      }
    return values;
  }

  void of_trials(const char* name, const char* units, const char* long_name, const OfTrial& value) {
    file_.doubles(name, {"trial"}, units, long_name, of_each_trial(value));
  }

  void integers_of_trials(const char* name, const char* long_name, const OfTrial& value, const sweeps::IntegerCodes& codes = {}) {
    const std::vector<double> values = of_each_trial(value);
    file_.integers(name, {"trial"}, "", long_name, {values.begin(), values.end()}, codes);
  }

  void write_grips() {
    using Grip = TrialGrip;
    using Said = GripPrediction;
    integers_of_grips("grip_vessel", "place of the vessel", [](const Grip& grip) { return static_cast<int>(grip.vessel); });
    integers_of_grips("grip_sample", "sample that the grip is of", [](const Grip& grip) { return static_cast<int>(grip.sample); },
                      {{TRIAL_SAMPLE_NAMES.begin(), TRIAL_SAMPLE_NAMES.end()}});
    of_grips("grip_number", "1", "number of the grip in its vessel's plan",
             [](const Grip& grip, const Said&) { return static_cast<double>(grip.number); });
    of_grips("height", "m", "height of the thumb-index line", [](const Grip& grip, const Said&) { return grip.grip.height; });
    of_grips("azimuth", "rad", "azimuth of that line", [](const Grip& grip, const Said&) { return grip.grip.azimuth; });
    of_grips("obliquity", "rad", "angle of that line to the horizontal",
             [](const Grip& grip, const Said&) { return grip.grip.obliquity; });
    of_grips("roll", "rad", "turn of the hand about that line", [](const Grip& grip, const Said&) { return grip.grip.roll; });
    of_grips("offset", "m", "distance of that line from the axis", [](const Grip& grip, const Said&) { return grip.grip.offset; });
    of_grips("hand_scale", "1", "size of the hand", [](const Grip& grip, const Said&) { return grip.grip.hand_scale; });
  }

  void write_predictions() {
    using Grip = TrialGrip;
    using Said = GripPrediction;
    of_grips("worst_effort", "1", "largest effort on the ways to the states that were tried",
             [](const Grip&, const Said& said) { return said.worst_effort; });
    of_grips("tips_worst_effort", "1", "the same of thumb and index tip alone",
             [](const Grip&, const Said& said) { return said.tips_worst_effort; });
    of_grips("scene_worst_effort", "1", "largest effort of all states of the scene",
             [](const Grip&, const Said& said) { return said.scene_worst_effort; });
    of_grips("push", "N", "push that is held upright and full", [](const Grip&, const Said& said) { return said.push; });
    of_grips("friction_needed", "1", "least friction that holds all states of the scene",
             [](const Grip&, const Said& said) { return said.friction_needed; });
    of_grips("epsilon", "1", "Ferrari and Canny's epsilon, middle of its bracket",
             [](const Grip&, const Said& said) { return said.epsilon; });
    of_grips("score", "1", "score", [](const Grip&, const Said& said) { return said.score; });
    std::vector<double> terms;
    for (const GripFinding& found : tried_.found)
      terms.insert(terms.end(), found.prediction.terms.begin(), found.prediction.terms.end());
    file_.doubles("score_terms", {"grip", "term"}, "1", "terms of the score", terms);
  }

  void write_placements() {
    std::vector<double> lows, means, shares;
    std::array<std::vector<int>, 4> numbers;
    for (const GripFinding& found : tried_.found) {
      PlacementCount count;
      count.add(found.placements);
      lows.push_back(found.robust.low);
      means.push_back(found.robust.mean);
      shares.push_back(found.robust.share);
      const std::array<std::size_t, 4> counts{count.all, count.held, count.discarded, count.impossible};
      for (std::size_t k = 0; k < counts.size(); ++k)
        numbers[k].push_back(count.all > 0 ? static_cast<int>(counts[k]) : static_cast<int>(sweeps::MISSING));
    }
    file_.doubles("robust_low", {"grip"}, "1", "10th percentile of the score over the deviations of [robust]", lows);
    file_.doubles("robust_mean", {"grip"}, "1", "mean of these scores", means);
    file_.doubles("robust_share", {"grip"}, "1", "share of these deviations that are feasible, plausible and held by their effort",
                  shares);
    constexpr std::array<std::pair<const char*, const char*>, 4> NAMES{
        {{"placements", "random deviations at which the grip was tried"},
         {"placements_held", "of these, held in every state"},
         {"placements_discarded", "of these, discarded"},
         {"placements_impossible", "of these, infeasible or implausible, and so not tried"}}};
    for (std::size_t k = 0; k < NAMES.size(); ++k)
      file_.integers(NAMES[k].first, {"grip"}, "1", NAMES[k].second, numbers[k], {{}, true});
  }

  void write_cases(const TrialSettings& settings) {
    integers_of_trials("trial_grip", "place of the grip", [](const TrialView& at) { return static_cast<double>(at.place); });
    integers_of_trials("protocol", "protocol of the trial",
                       [](const TrialView& at) { return static_cast<double>(static_cast<int>(at.one.protocol)); },
                       {{TRIAL_PROTOCOL_NAMES.begin(), TRIAL_PROTOCOL_NAMES.end()}});
    of_trials("fill", "1", "fill, as a fraction of the capacity", [](const TrialView& at) { return at.one.fill; });
    of_trials("tilt", "rad", "tilt; of fill-tilt", [](const TrialView& at) { return at.is_push() ? ABSENT : at.one.tilt; });
    integers_of_trials("direction", "direction of the push, in the vessel's frame; of six-forces",
                       [](const TrialView& at) { return at.is_push() ? at.one.direction : sweeps::MISSING; },
                       {{FORCE_DIRECTION_NAMES.begin(), FORCE_DIRECTION_NAMES.end()}, true});
    std::vector<std::string> materials;
    for (const TrialMaterial& material : settings.materials) materials.push_back(material.name);
    integers_of_trials("material", "whose mass and friction the vessel has; of six-forces",
                       [](const TrialView& at) { return at.is_push() ? at.one.material : sweeps::MISSING; }, {materials, true});
    of_trials("effort", "1", "effort of the whole hand", [](const TrialView& at) { return at.said.effort; });
    of_trials("tips_effort", "1", "effort of thumb and index tip alone", [](const TrialView& at) { return at.said.tips; });
    of_trials("leg_effort", "1", "largest effort on the way to the state", [](const TrialView& at) { return at.said.leg_effort; });
    of_trials("leg_tips_effort", "1", "the same of thumb and index tip alone",
              [](const TrialView& at) { return at.said.leg_tips; });
  }

  void write_outcomes(const TrialSettings& settings) {
    const auto when_run = [](const TrialView& at, double value) { return at.outcome.discarded ? ABSENT : value; };
    const auto when_lost = [](const TrialView& at, double value) {
      return at.outcome.discarded || at.outcome.held ? ABSENT : value;
    };
    integers_of_trials("held", "whether the vessel was held; never of a discarded trial",
                       [](const TrialView& at) { return at.outcome.held ? 1.0 : 0.0; }, {{"not_held", "held"}});
    integers_of_trials("discarded", "whether the trial was discarded",
                       [](const TrialView& at) { return at.outcome.discarded ? 1.0 : 0.0; }, {{"not_discarded", "discarded"}});
    std::vector<std::string> reasons(TRIAL_REASON_NAMES.begin(), TRIAL_REASON_NAMES.end());
    reasons[static_cast<std::size_t>(TrialReason::none)] = "held";  // the table leaves its cell empty
    integers_of_trials("reason", "why the trial was discarded, or the vessel lost",
                       [](const TrialView& at) { return static_cast<double>(static_cast<int>(at.outcome.reason)); }, {reasons});
    of_trials("slip", "m", "largest way of a contact on the vessel",
              [=](const TrialView& at) { return when_run(at, at.outcome.slip); });
    integers_of_trials("slipped", "whether a contact slid farther than slip_m; not of a discarded trial",
                       [&](const TrialView& at) {
                         return at.outcome.discarded ? sweeps::MISSING : has_slipped(at.outcome, settings) ? 1.0 : 0.0;
                       },
                       {{"not_slipped", "slipped"}, true});
    of_trials("move", "m", "largest way of the vessel in the hand",
              [=](const TrialView& at) { return when_run(at, at.outcome.move); });
    of_trials("turn", "rad", "largest turn of the vessel in the hand",
              [=](const TrialView& at) { return when_run(at, at.outcome.turn); });
    of_trials("lost_after", "s", "time from the release to the loss",
              [=](const TrialView& at) { return when_lost(at, at.outcome.when); });
    of_trials("tilt_lost", "rad", "tilt at the loss; of fill-tilt",
              [=](const TrialView& at) { return at.is_push() ? ABSENT : when_lost(at, at.outcome.tilt_lost); });
    std::vector<std::string> details;
    for (const GripFinding& found : tried_.found)
      for (const TrialOutcome& outcome : found.outcomes) details.push_back(outcome.detail);
    file_.strings("detail", {"trial"}, "what the engine said of a trial that it could not compute", details);
  }

  sweeps::ResultDefinition file_;
  const TriedGrips& tried_;
};

}  // namespace

// As `Dataset` defines them; a test compares it with the files themselves.
std::uint64_t trials_dataset_room(const Scene& scene, const TriedGrips& tried) {
  constexpr std::uint64_t OF_GRIP = 24 * sizeof(double) + 6 * sizeof(int), OF_TRIAL = 11 * sizeof(double) + 8 * sizeof(int);
  constexpr std::uint64_t VARIABLES = 47, HEAD = 1000;   // of each, with its attributes
  constexpr std::uint64_t REFERENCE = 16, IN_HEAP = 24;  // of a string, beside its text
  constexpr std::uint64_t LARGEST_IN_HEAD = 1 << 16;
  std::uint64_t trials = 0, heap = 4096;
  const auto add_text = [&heap](const std::string& text) { heap += IN_HEAP + (text.size() + 7) / 8 * 8; };
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    trials += tried.cases_of(g).size();
    for (const TrialOutcome& outcome : tried.found[g].outcomes) add_text(outcome.detail);
  }
  for (const VesselData& vessel : scene.vessels) add_text(vessel.name);
  heap += heap / 8;  // its blocks are not quite full
  // a long attribute moves as it grows, and HDF5 leaves its first place empty; the longest have their own place
  const std::uint64_t text = scene.text.size() * (scene.text.size() < LARGEST_IN_HEAD ? 2 : 1) + scene.name.size();
  return VARIABLES * HEAD + tried.grips.size() * OF_GRIP + trials * (OF_TRIAL + REFERENCE) + scene.vessels.size() * REFERENCE +
         heap + text;
}

void write_trials_dataset(const std::string& path, const Scene& scene, const TrialOptions& options, const TriedGrips& tried,
                          const TrialOrigin& origin) {
  // HDF5 crashes if the disk fills up while it writes
  check_room(path, trials_dataset_room(scene, tried), TRIALS_REMEDY);
  try {
    Dataset(path, tried).write(scene, options, origin);
  } catch (...) {
    std::remove(path.c_str());
    throw;
  }
}

}  // namespace wholehand
