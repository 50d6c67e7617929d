// SPDX-License-Identifier: MIT
#include "sweeps/rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "base/text/error.h"
#include "base/text/nearest_name.h"
#include "base/text/text.h"
#include "core/core_backend.h"
#include "core/counted_tilts.h"
#include "core/fields.h"
#include "core/planes.h"
#include "core/tolerances.h"
#include "shaders/layout.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/lists/robust.h"
#include "sweeps/rank/unheld.h"

namespace wholehand::sweeps {
namespace {

constexpr const char* NEEDS_EFFORTS =
    "needs efforts, which the scene does not have ([tilts], and [strength] without efforts = false)";

constexpr std::size_t GRIPS_AT_ONCE = 1 << 16;  // grips read at once
constexpr double LARGEST_WEIGHT = 1000;

constexpr std::array<std::string_view, 6> TERMS{"fingers", "contacts", "depth", "posture", "force", "hold"};

std::string variable_of(std::size_t term) { return fmt::format("score_{}", TERMS[term]); }

bool has_term(const Scene& scene, std::size_t term) { return term < 4 || !scene.tilts.empty(); }

using FindVariable = std::function<const Variable*(const std::string&)>;  // null where it is not there

FindVariable find_in(const SweepResult& result) {
  return [&result](const std::string& name) { return result.find(name); };
}

// Whether a sweep keeps the variable by default.
bool is_usual(const std::string& name) {
  return std::ranges::any_of(variable_catalogue(),
                             [&](const Variable& variable) { return name == variable.name && variable.by_default; });
}

// The variables of these names; throws for all that are missing. `who` lacks them.
std::vector<const Variable*> needed(const FindVariable& find, const std::vector<std::string>& names, const std::string& source) {
  std::vector<const Variable*> variables;
  std::vector<std::string> missing;
  for (const std::string& name : names) {
    variables.push_back(find(name));
    if (!variables.back()) missing.push_back(name);
  }
  if (missing.empty()) return variables;
  if (!std::ranges::all_of(missing, is_usual)) {
    throw usage_error(
        fmt::format("{} lacks {}, which a sweep keeps on request; add {} to [output] also, or to its keep, and sweep again", source,
                    joined(missing, ", "), missing.size() == 1 ? "it" : "them"));
  }
  throw usage_error(
      fmt::format("{} lacks {}, as keep of the sweep does not name {}; add {} to keep, or remove keep, and sweep again", source,
                  joined(missing, ", "), missing.size() == 1 ? "it" : "them", missing.size() == 1 ? "it" : "them"));
}

std::vector<const Variable*> needed(const SweepResult& result, const std::vector<std::string>& names) {
  return needed(find_in(result), names, result.path() + ":");
}

// The variables that decide whether a grip is listed.
std::vector<std::string> eligible_names(const Scene& scene) {
  return has_effort(scene) ? std::vector<std::string>{"plausible", "not_held"} : std::vector<std::string>{"plausible"};
}

// The criterion of a list, besides the scores.
std::vector<std::string> key_names(RankBy by) {
  if (by == RankBy::worst_effort) return {"worst_effort"};
  if (by == RankBy::push) return {"push"};
  return {};
}

// The inputs of scores by these weights: the sweep's own scores if the weights are its own, else its terms.
std::vector<std::string> score_names(const std::array<double, 6>& weights, const Scene& scene, const FindVariable& find) {
  std::vector<std::string> names;
  for (std::size_t term = 0; term < weights.size(); ++term)
    if (weights[term] > 0) names.push_back(variable_of(term));
  const bool has_terms = std::all_of(names.begin(), names.end(), [&](const std::string& name) { return find(name); });
  if (weights == effective_weights(scene) && (find("score") || !has_terms)) return {"score"};
  return names;
}

// Values that a condition may name besides the variables: numbers of sources from variable_catalogue().size() on, by PLACE_*; then the height in m.
enum : std::size_t { SOURCE_AXIS = 0, SOURCE_HEIGHT = 6 };

bool is_over(const Variable& variable, const char* dim) {
  return std::any_of(variable.dims.begin(), variable.dims.end(), [dim](const char* name) { return std::strcmp(name, dim) == 0; });
}

// How to make a sweep keep a variable: `keep` lists all variables, and also adds to the usual ones. Names related variables of the file, such as
// worst_effort for effort.
std::string remedy_for(const Variable& variable, const SweepResult& result, const Scene& scene) {
  std::vector<std::string> related;
  for (const Variable& other : variable_catalogue())
    if (std::string_view(other.name).ends_with(variable.name) && result.find(other.name)) related.push_back(other.name);
  const std::string instead = related.empty() ? "" : fmt::format("write {}, which it has, or ", joined(related, " or "));
  return fmt::format("is not in the file; {}add \"{}\" to [output] {} of the scene and sweep again", instead, variable.name,
                     scene.output.keep ? "keep" : "also");
}

std::string refusal_of(const Variable& variable, const SweepResult& result, const Scene& scene) {
  if (is_over(variable, "xyz")) return "is a vector, and a condition takes numbers";
  if (result.find(variable.name)) return "";
  if (variable.need == Need::tilts && scene.tilts.empty()) return "needs [tilts], which the scene of this file does not have";
  if (variable.need == Need::table && !scene.table) return "needs [table], which the scene of this file does not have";
  if (variable.need == Need::arm && !scene.arm) return "needs [arm], which the scene of this file does not have";
  if (variable.need == Need::between && scene.hand.between == 0)
    return "needs [hand] between above 0, which the scene of this file does not have";
  return remedy_for(variable, result, scene);
}

// A value under its own name and, where it has a length or an angle, under that with the unit of a scene file.
void add_names(std::vector<WhereName>& names, const WhereName& name) {
  names.push_back(name);
  if (name.units != "m" && name.units != "rad") return;
  names.push_back(name);
  names.back().name += name.units == "m" ? "_mm" : "_deg";
  names.back().unit = name.units == "m" ? WhereUnit::mm : WhereUnit::deg;
}

// Scores of a block of grips: from the file if the weights are the sweep's own.
class Scores {
 public:
  Scores(const SweepResult& result, const Scene& scene, const std::string& weights)
      : result_(result), scene_(scene), weights_(read_weights(weights, scene)) {
    const std::vector<std::string> names = score_names(weights_, scene, find_in(result));
    variables_ = needed(result, names);
    if (names.front() == "score") {
      factors_ = {1};
      return;
    }
    for (const double weight : weights_)
      if (weight > 0) factors_.push_back(weight);
  }

  // Whether the weights are those of the sweep.
  const std::array<double, 6>& weights() const { return weights_; }
  bool is_sweeps_own() const { return weights_ == effective_weights(scene_); }

  void read(std::size_t vessel, std::uint64_t first, std::size_t count, double* out) {
    std::fill_n(out, count, 0);
    values_.resize(count);
    for (std::size_t k = 0; k < variables_.size(); ++k) {
      result_.read(*variables_[k], vessel, 0, first, count, values_.data());
      for (std::size_t i = 0; i < count; ++i) out[i] += factors_[k] * values_[i];
    }
  }

 private:
  const SweepResult& result_;
  const Scene& scene_;
  std::array<double, 6> weights_;
  std::vector<const Variable*> variables_;
  std::vector<double> factors_, values_;
};

// The values that a condition needs, of a block of grips.
class ConditionValues {
 public:
  ConditionValues(const SweepResult& result, const Scene& scene, const Plan& plan, const std::vector<WhereValue>& values)
      : result_(result), scene_(scene), plan_(plan), wanted_(values), columns_(values.size()), row_(values.size()) {}

  void read(std::size_t vessel, std::uint64_t first, std::size_t count) {
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      columns_[k].resize(count);
      read_column(wanted_[k], vessel, first, count, columns_[k].data());
    }
  }

  // The columns of grip `i` of the block.
  const double* row(std::size_t i) {
    for (std::size_t k = 0; k < columns_.size(); ++k) row_[k] = columns_[k][i];
    return row_.data();
  }

 private:
  void read_column(const WhereValue& wanted, std::size_t vessel, std::uint64_t first, std::size_t count, double* out) {
    const auto catalogue = variable_catalogue();
    if (wanted.source >= catalogue.size()) {
      read_axis(wanted.source - catalogue.size(), vessel, first, count, out);
      return;
    }
    const Variable& variable = *result_.find(catalogue[wanted.source].name);
    result_.read(variable, vessel, 0, first, count, out);
    const std::size_t planes = variable_planes(variable, scene_);
    plane_.resize(count);
    for (std::size_t plane = 1; plane < planes; ++plane) {
      result_.read(variable, vessel, plane, first, count, plane_.data());
      for (std::size_t i = 0; i < count; ++i) {
        const bool replaces = wanted.fold == WhereFold::least ? plane_[i] < out[i] : plane_[i] > out[i];
        if (replaces || std::isnan(plane_[i])) out[i] = plane_[i];  // a comparison with NaN keeps it
      }
    }
  }

  void read_axis(std::size_t source, std::size_t vessel, std::uint64_t first, std::size_t count, double* out) {
    if (source != SOURCE_HEIGHT) {
      plan_.coordinates(static_cast<int>(source), first, count, out);
      return;
    }
    grips_.resize(count);
    plan_.fill(vessel, first, count, grips_.data());
    for (std::size_t i = 0; i < count; ++i) out[i] = grips_[i].height;
  }

  const SweepResult& result_;
  const Scene& scene_;
  const Plan& plan_;
  const std::vector<WhereValue>& wanted_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> row_, plane_;
  std::vector<GripInput> grips_;
};

// Whether set_worst reads it.
bool is_of_states(int field) {
  return field < REAL_FIELDS && (field_row(field).shape == FieldShape::fills || field_row(field).of_strength);
}

// The variables that the rows of a list are made of.
std::vector<std::string> row_variables(const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t term = 0; term < TERMS.size(); ++term)
    if (has_term(scene, term)) names.push_back(variable_of(term));
  names.insert(names.end(), {"closure", "gap", "fingers_used", "points_touching", "phalanx_depth", "palm_depth", "antipodal"});
  if (scene.arm) names.emplace_back("wrist_share");
  for (const int field : best_fields(scene))
    if (is_of_states(field)) names.push_back(field_row(field).variable);
  return names;
}

// Sets all reported figures of some grips, from the file.
void read_rows(const SweepResult& result, const Scene& scene, std::size_t vessel, std::vector<BestGrip>& best) {
  std::vector<std::uint64_t> grips;
  for (const BestGrip& grip : best) grips.push_back(grip.candidate.index);
  const auto pick = [&](const std::string& name, std::size_t plane = 0) {
    const Variable* variable = result.find(name);
    return variable ? result.pick(*variable, vessel, plane, grips) : std::vector<double>(grips.size(), std::nan(""));
  };
  for (std::size_t term = 0; term < TERMS.size(); ++term) {
    if (!has_term(scene, term)) continue;
    const auto values = pick(variable_of(term));
    for (std::size_t i = 0; i < best.size(); ++i) best[i].terms[term] = values[i];
  }
  const auto closure = pick("closure"), gap = pick("gap"), fingers = pick("fingers_used"), points = pick("points_touching"),
             phalanx = pick("phalanx_depth"), palm = pick("palm_depth"), antipodal = pick("antipodal");
  const auto wrist = scene.arm ? pick("wrist_share") : std::vector<double>();
  std::map<int, std::vector<std::vector<double>>> of_states;  // by field and plane
  for (const int field : best_fields(scene)) {
    if (!is_of_states(field)) continue;
    for (int plane = 0; plane < field_planes(field, scene); ++plane)
      of_states[field].push_back(pick(field_row(field).variable, static_cast<std::size_t>(plane)));
  }
  // if a mesh is missing, the counted tilts are unknown: then all of them are the end
  const VesselData& data = scene.vessels[vessel];
  const bool is_known = !data.mesh || data.mesh->body;
  const std::vector<double> last =
      is_known || scene.tilts.empty() ? last_tilts(scene, vessel) : std::vector<double>(scene_fills(scene), scene.tilts.back());
  for (std::size_t i = 0; i < best.size(); ++i) {
    best[i].closure = closure[i];
    best[i].gap = gap[i];
    best[i].fingers_used = static_cast<int>(fingers[i]);
    best[i].points_touching = static_cast<int>(points[i]);
    best[i].phalanx_depth = phalanx[i];
    best[i].palm_depth = palm[i];
    if (scene.arm) best[i].wrist_share = wrist[i];
    best[i].antipodal = antipodal[i] != 0;
    set_worst(best[i], scene, last, [&](int field, int plane) { return of_states.at(field)[static_cast<std::size_t>(plane)][i]; });
  }
}

// Sets what the sweep refined of the grips that it listed, too.
void set_refined(const SweepResult& result, const Plan& plan, std::size_t list, std::vector<BestGrip>& grips) {
  if (!result.lists_best()) return;
  const std::size_t vessel = list / plan.hand_scales(), scale = list % plan.hand_scales();
  const std::vector<Candidate> listed = result.best(vessel, scale);
  const auto refined = result.refined(vessel, scale);
  std::map<std::uint64_t, RefinedGrip> of_grip;
  for (std::size_t rank = 0; rank < listed.size(); ++rank)
    if (refined[rank]) of_grip[listed[rank].index] = *refined[rank];
  for (BestGrip& grip : grips) {
    const auto there = of_grip.find(grip.candidate.index);
    if (there == of_grip.end()) continue;
    grip.refined = there->second.grip;
    grip.refined_score = there->second.score;
  }
}

// The same of the robust scores.
void set_robust(const SweepResult& result, const Plan& plan, std::size_t list, std::vector<BestGrip>& grips) {
  if (!result.lists_best()) return;
  const std::size_t vessel = list / plan.hand_scales(), scale = list % plan.hand_scales();
  const std::vector<Candidate> listed = result.best(vessel, scale);
  const auto robust = result.robust(vessel, scale);
  for (std::size_t rank = 0; rank < robust.size(); ++rank)
    for (BestGrip& grip : grips)
      if (grip.candidate.index == listed[rank].index) {
        grip.robust = robust[rank];
      }
}

// The criterion of the lists, for a block of grips: larger is better.
class RankKeys {
 public:
  RankKeys(const SweepResult& result, Scores& scores, RankBy by) : result_(result), scores_(scores) {
    for (const Variable* variable : needed(result, key_names(by))) variable_ = variable;
    sign_ = by == RankBy::worst_effort ? -1 : 1;
  }

  void read(std::size_t vessel, std::uint64_t first, std::size_t count, double* out) {
    if (!variable_) return scores_.read(vessel, first, count, out);
    result_.read(*variable_, vessel, 0, first, count, out);
    for (std::size_t i = 0; i < count; ++i) out[i] *= sign_;
  }

  Scores& scores() { return scores_; }

 private:
  const SweepResult& result_;
  Scores& scores_;
  const Variable* variable_ = nullptr;  // null: the score
  double sign_ = 1;
};

// The scene with these weights, as kernels use them, and the factor from their score to one of read_weights.
Scene with_weights(const Scene& scene, const std::array<double, 6>& weights, double& factor) {
  Scene other = scene;
  other.score = {weights[0], weights[1], weights[2], weights[3], weights[4], weights[5]};
  factor = scene.tilts.empty() ? weights[0] + weights[1] + weights[2] + weights[3] : 1;
  return other;
}

// Ranks the grips of each list by the core's robust scores; those of a list without a holding grip stay in the order of their efforts.
void rank_held_by_robust(const Scene& scene, const Plan& plan, const std::array<double, 6>& weights, std::size_t best,
                         Ranking& ranking) {
  double factor = 1;
  const Scene weighted = with_weights(scene, weights, factor);
  BestLists& lists = ranking.lists;
  BestLists held = lists;
  for (std::size_t list = 0; list < lists.size(); ++list)
    if (none_holds(ranking, list)) held[list].clear();
  rank_robustly(open_core_for, weighted, plan, best, nullptr, held);
  for (std::size_t list = 0; list < lists.size(); ++list) {
    for (BestGrip& grip : held[list]) {
      grip.robust.mean *= factor;
      grip.robust.low *= factor;
    }
    if (!none_holds(ranking, list)) lists[list] = std::move(held[list]);
  }
}

// Goes through the grips of a vessel and offers those of its lists; counts them in the first pass. `least_bad`: those of lists without a holding
// grip, instead of those that hold.
void offer_grips(const SweepResult& result, const Scene& scene, const Plan& plan, std::size_t vessel, RankKeys& keys,
                 bool least_bad, const Where* where, ListChooser& chooser, Ranking& ranking, bool is_first_pass) {
  const Variable &plausible = *result.find("plausible"), *not_held = result.find("not_held"),
                 *effort = has_effort(scene) && is_first_pass ? result.find("worst_effort") : nullptr;
  const double gate = effort ? gate_tolerance(scene, result.empty_masses()[vessel]) : 0;
  const std::vector<WhereValue> none;
  ConditionValues values(result, scene, plan, where ? where->values() : none);
  const std::size_t scales = plan.hand_scales();
  std::vector<double> is_plausible(GRIPS_AT_ONCE), fails(GRIPS_AT_ONCE, 0), score(GRIPS_AT_ONCE),
      efforts(GRIPS_AT_ONCE, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> hands(GRIPS_AT_ONCE);
  std::vector<Candidate> offered;
  for (std::uint64_t first = 0; first < plan.grips(); first += GRIPS_AT_ONCE) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(GRIPS_AT_ONCE, plan.grips() - first));
    result.read(plausible, vessel, 0, first, count, is_plausible.data());
    if (has_effort(scene)) result.read(*not_held, vessel, 0, first, count, fails.data());
    if (effort) result.read(*effort, vessel, 0, first, count, efforts.data());
    keys.read(vessel, first, count, score.data());
    plan.hand_scales_of(first, count, hands.data());
    values.read(vessel, first, count);
    offered.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (is_plausible[i] != 1) continue;  // infeasible ones have none
      const std::size_t list = vessel * scales + hands[i];
      if (is_first_pass) ++ranking.plausible[list];
      if (is_first_pass && fails[i] == 1) ++ranking.not_held[list];
      if (is_at_gate(efforts[i], gate)) ++ranking.at_gate[list];
      if (least_bad ? !none_holds(ranking, list) : fails[i] == 1) continue;
      if (where && !where->holds(values.row(i))) continue;
      if (is_first_pass) ++ranking.matching[list];
      offered.push_back({score[i], first + i});
    }
    chooser.offer(offered);
  }
}

// The lists of a vessel, and how many grips they are of.
std::vector<ListProgress> rank_vessel(const SweepResult& result, const Scene& scene, const Plan& plan, std::size_t vessel,
                                      RankKeys& keys, const Where* where, const RankRequest& request, const Evaluator* core,
                                      Ranking& ranking) {
  const auto choose = [&](RankKeys& order, std::size_t best, bool least_bad) {
    const std::size_t pool = request.pool > 0 ? request.pool : usual_pool(plan, best, request.apart);
    ListChooser chooser(plan, core, vessel, {best, request.apart, pool, 0});
    bool is_first_pass = !least_bad;
    do {
      offer_grips(result, scene, plan, vessel, order, least_bad, where, chooser, ranking, is_first_pass);
      chooser.end_pass();
      is_first_pass = false;
    } while (!chooser.is_complete());
    return chooser.progress();
  };
  std::vector<ListProgress> lists =
      choose(keys, request.by == RankBy::robust ? robust_candidates(scene, request.best) : request.best, false);
  const std::size_t first = vessel * plan.hand_scales();
  bool is_unheld = false;
  for (std::size_t k = 0; k < lists.size(); ++k) is_unheld = is_unheld || none_holds(ranking, first + k);
  if (!request.least_bad || !is_unheld) return lists;
  RankKeys efforts(result, keys.scores(), RankBy::worst_effort);
  const std::vector<ListProgress> least_bad = choose(efforts, request.best, true);
  for (std::size_t k = 0; k < lists.size(); ++k)
    if (none_holds(ranking, first + k)) lists[k] = least_bad[k];
  return lists;
}

// The core for the columns that the file lacks, with a note for the user about them; null if it lacks none, or if a mesh is not there.
std::unique_ptr<CoreBackend> open_for_missing(const SweepResult& result, const Scene& scene,
                                              const std::function<std::shared_ptr<const Evaluator>()>& open_core,
                                              std::string& note) {
  std::vector<std::string> missing;
  for (const std::string& name : row_variables(scene))
    if (!result.find(name)) missing.push_back(name);
  const bool has_usual = std::ranges::all_of(missing, [](const std::string& name) { return !is_usual(name); });
  std::unique_ptr<CoreBackend> core;
  try {
    if (!missing.empty())
      core = std::make_unique<CoreBackend>(open_core(), scene, make_field_set(best_fields(scene), scene), Precision::full, 0);
    if (!has_usual)
      note = "the file lacks some columns of the table: apart from places and scores, the core computed them in double precision";
  } catch (const Error& error) {  // a mesh is not there
    if (!has_usual) throw;
    note = fmt::format("{}; {} and the hold force are left empty", error.what(), joined(missing, ", "));
  }
  return core;
}

}  // namespace

bool none_holds(const Ranking& ranking, std::size_t list) {
  return ranking.not_held[list] > 0 && ranking.not_held[list] == ranking.plausible[list];
}

std::vector<std::string> unheld_lines(const Evaluator& core, const Scene& scene, const Plan& plan, const Ranking& least_bad) {
  std::vector<std::string> lines(least_bad.lists.size());
  for (std::size_t list = 0; list < lines.size(); ++list) {
    if (!none_holds(least_bad, list) || least_bad.lists[list].empty()) continue;
    const BestGrip& grip = least_bad.lists[list].front();
    lines[list] = unheld_line(core, scene, plan, list / plan.hand_scales(),
                              {grip.efforts.worst, grip.efforts.friction_needed, grip.candidate.index});
  }
  return lines;
}

std::array<double, 6> read_weights(const std::string& text, const Scene& scene) {
  std::array<double, 6> weights = effective_weights(scene);
  std::set<std::string_view> named;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size()), sign = std::min(rest.find('='), comma);
    const std::string_view name = rest.substr(0, sign);
    const std::string_view number = sign < comma ? rest.substr(sign + 1, comma - sign - 1) : std::string_view();
    const bool is_last = comma == rest.size();
    rest.remove_prefix(is_last ? comma : comma + 1);
    const auto term = static_cast<std::size_t>(std::find(TERMS.begin(), TERMS.end(), name) - TERMS.begin());
    if (term == TERMS.size()) {
      throw usage_error(fmt::format("--weights: there is no term '{}'; the nearest is '{}' of {}", name.substr(0, 60),
                                    nearest_name(name, TERMS), joined(TERMS, ", ")));
    }
    if (!has_term(scene, term))
      throw usage_error(fmt::format("--weights: {} needs [tilts], which the scene of this file does not have", name));
    if (!named.insert(name).second) throw usage_error(fmt::format("--weights: {} is named twice", name));
    double weight = -1;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), weight);
    if (error != std::errc() || end != number.data() + number.size() || !(weight >= 0 && weight <= LARGEST_WEIGHT))
      throw usage_error(fmt::format("--weights: {}={}; allowed: a number, 0 to {}", name, number.substr(0, 60), LARGEST_WEIGHT));
    weights[term] = weight;
    if (!is_last && rest.empty()) throw usage_error("--weights: ends with a comma; name a term after it");
  }
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; }))
    throw usage_error("--weights: no term has a weight above 0");
  return weights;
}

void check_rank_by(const std::string& text) {
  for (const char* known : {"", "score", "robust", "worst_effort", "push"})
    if (text == known) return;
  throw usage_error(fmt::format("--rank-by '{}'; allowed: score, robust, worst_effort or push", text.substr(0, 60)));
}

RankBy read_rank_by(const std::string& text, const Scene& scene) {
  check_rank_by(text);
  if (text.empty()) return usual_order(scene);
  if (text == "score") return RankBy::score;
  const bool needs_effort = text == "worst_effort" || text == "push";
  if (text == "robust" && !scene.robust)
    throw usage_error(fmt::format("--rank-by robust needs [robust], which the scene does not have; allowed: score{}",
                                  has_effort(scene) ? ", worst_effort or push" : ""));
  if (needs_effort && !has_effort(scene))
    throw usage_error(fmt::format("--rank-by {} {}; allowed: score{}", text, NEEDS_EFFORTS, scene.robust ? " or robust" : ""));
  return text == "robust" ? RankBy::robust : text == "push" ? RankBy::push : RankBy::worst_effort;
}

void check_rankable(const Scene& scene, const std::vector<const Variable*>& variables, RankBy by) {
  const FindVariable find = [&](const std::string& name) {
    const auto there = std::find_if(variables.begin(), variables.end(), [&](const Variable* one) { return one->name == name; });
    return there == variables.end() ? nullptr : *there;
  };
  std::vector<std::string> names = eligible_names(scene);
  for (const auto& more : {key_names(by), score_names(effective_weights(scene), scene, find)})
    names.insert(names.end(), more.begin(), more.end());
  needed(find, names, "--rank-by: the result");
}

std::size_t usual_length(const SweepResult& result, const Scene& scene, const Plan& plan) {
  std::size_t most = 0;
  if (result.lists_best())
    for (const auto& list : lists_of_sweep(result, scene, plan)) most = std::max(most, list.size());
  if (most > 0) return most;
  return scene.output.best > 0 ? static_cast<std::size_t>(scene.output.best) : static_cast<std::size_t>(OutputData().best);
}

std::vector<WhereName> where_names(const SweepResult& result, const Scene& scene, const Plan& plan) {
  std::vector<WhereName> names;
  const auto catalogue = variable_catalogue();
  for (std::size_t k = 0; k < catalogue.size(); ++k) {
    const Variable& variable = catalogue[k];
    const std::string_view name = variable.name, meaning = variable.comment;
    WhereName entry{variable.name, variable.units, WhereKind::number, WhereUnit::own, "", refusal_of(variable, result, scene), k};
    if (name.ends_with("_mask")) entry.kind = WhereKind::mask;
    if (meaning == YES_NO) entry.kind = WhereKind::truth;
    if (variable_planes(variable, scene) > 1) entry.over = joined(variable.dims, " and ");
    add_names(names, entry);
  }
  const std::size_t first = catalogue.size() + SOURCE_AXIS;
  for (std::size_t place = 0; place < plan.axes().size(); ++place) {
    const PlanAxis& axis = plan.axes()[place];
    if (axis.name == "height") continue;
    WhereName entry{axis.name, axis.units, WhereKind::number, WhereUnit::own, "", "", first + place};
    if (place == PLACE_AZIMUTH && plan.copies() > 1)
      entry.refusal = "changes nothing in this sweep: the vessels are bodies of revolution, and one azimuth stands for all";
    add_names(names, entry);
  }
  add_names(names, {"height", "m", WhereKind::number, WhereUnit::own, "", "", catalogue.size() + SOURCE_HEIGHT});
  return names;
}

Ranking rank_grips(const SweepResult& result, const Scene& scene, const Plan& plan, const RankRequest& request,
                   const std::function<std::shared_ptr<const Evaluator>()>& open_core) {
  needed(result, eligible_names(scene));
  if (request.least_bad && !has_effort(scene)) throw usage_error(fmt::format("--least-bad: {}", NEEDS_EFFORTS));
  if (request.least_bad) needed(result, {"worst_effort"});
  Scores scores(result, scene, request.weights);
  RankKeys keys(result, scores, request.by);
  const std::vector<WhereName> names = where_names(result, scene, plan);
  const std::unique_ptr<const Where> where = request.where.empty() ? nullptr : std::make_unique<Where>(request.where, names);
  const std::size_t lists = scene.vessels.size() * plan.hand_scales();
  const std::vector<std::uint64_t> none(lists, 0);
  Ranking ranking{{}, none, none, none, none, ""};
  const bool is_robust = request.by == RankBy::robust;
  const std::shared_ptr<const Evaluator> posing = request.apart > 0 || is_robust ? open_core() : nullptr;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v)
    for (const ListProgress& list : rank_vessel(result, scene, plan, v, keys, where.get(), request, posing.get(), ranking)) {
      ranking.lists.emplace_back();
      for (const Candidate& candidate : list.chosen) ranking.lists.back().push_back(bare_grip(plan, v, candidate));
    }
  const std::unique_ptr<CoreBackend> core = open_for_missing(
      result, scene, [&] { return posing ? posing : open_core(); }, ranking.note);
  if (is_robust) rank_held_by_robust(scene, plan, scores.weights(), request.best, ranking);
  for (std::size_t list = 0; list < lists; ++list) {
    std::vector<BestGrip>& grips = ranking.lists[list];
    const std::size_t vessel = list / plan.hand_scales();
    for (BestGrip& grip : grips) scores.read(vessel, grip.candidate.index, 1, &grip.candidate.score);
    core ? evaluate_best(*core, scene, vessel, grips) : read_rows(result, scene, vessel, grips);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      grips[i].score = none_holds(ranking, list) ? 0 : grips[i].candidate.score;
      grips[i].rank = i + 1;
    }
    if (!scores.is_sweeps_own()) continue;
    set_refined(result, plan, list, grips);
    if (!is_robust) set_robust(result, plan, list, grips);
  }
  return ranking;
}

std::vector<MergedGrip> merged(std::vector<MergedGrip> grips, RankBy by, std::size_t best) {
  // the larger ranks first; what is not known is less than all
  const auto keys = [by](const BestGrip& grip) {
    std::array<double, 4> found{grip.score, -grip.efforts.worst};
    if (by == RankBy::robust) found = {grip.robust.low, grip.robust.mean, grip.score, -grip.efforts.worst};
    if (by == RankBy::worst_effort) found = {-grip.efforts.worst};
    if (by == RankBy::push) found = {grip.efforts.push};
    for (double& key : found)
      if (std::isnan(key)) key = -std::numeric_limits<double>::infinity();
    return found;
  };
  std::stable_sort(grips.begin(), grips.end(),
                   [&](const MergedGrip& a, const MergedGrip& b) { return keys(a.grip) > keys(b.grip); });
  grips.resize(std::min(grips.size(), best));
  for (std::size_t i = 0; i < grips.size(); ++i) grips[i].grip.rank = i + 1;
  return grips;
}

}  // namespace wholehand::sweeps
