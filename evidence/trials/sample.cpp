// SPDX-License-Identifier: MIT
#include "evidence/trials/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "base/numbers/random_bits.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/core_backend.h"
#include "shaders/status.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/lists/robust.h"

namespace wholehand {
namespace {

constexpr std::size_t READ_AT_ONCE = 1 << 16;

// How many each stratum gives: fairly, and all together `count` where they have as many.
std::array<std::size_t, SCORE_STRATA> shares_of(const std::array<std::vector<Candidate>, SCORE_STRATA>& strata, std::size_t count) {
  std::array<std::size_t, SCORE_STRATA> order{}, shares{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return strata[a].size() < strata[b].size(); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t left = order.size() - k;
    shares[order[k]] = std::min(strata[order[k]].size(), count / left);  // the fuller ones take what is over
    count -= shares[order[k]];
  }
  return shares;
}

std::vector<std::size_t> asked_vessels(const Scene& scene, const TrialOptions& options) {
  if (options.vessel) return {*options.vessel};
  std::vector<std::size_t> vessels(scene.vessels.size());
  std::iota(vessels.begin(), vessels.end(), std::size_t{0});
  return vessels;
}

std::vector<Candidate> listed_best(const sweeps::SweepResult& result, const sweeps::Plan& plan, std::size_t vessel,
                                   std::size_t count) {
  std::vector<Candidate> all;
  std::size_t fewest = count;
  for (std::size_t scale = 0; scale < plan.hand_scales(); ++scale) {
    std::vector<Candidate> list = result.best(vessel, scale);
    fewest = std::min(fewest, list.size());
    list.resize(std::min(list.size(), count));
    all.insert(all.end(), list.begin(), list.end());
  }
  if (fewest < count)
    print_note(fmt::format("of vessel {} the result lists {}, and --best asks for {}; `wholehand sweep --best` lists more",
                           vessel + 1, counted(all.size(), "grip"), count * plan.hand_scales()));
  return all;
}

}  // namespace

std::uint64_t grip_key(std::uint64_t seed, std::size_t vessel, std::uint64_t number) {
  return mixed_bits(mixed_bits(seed + SPLIT_MIX_STEP * (vessel + 1)) + SPLIT_MIX_STEP * (number + 1));
}

std::vector<Candidate> stratified_sample(const std::vector<Candidate>& eligible, std::size_t count, std::size_t vessel,
                                         std::uint64_t seed) {
  if (eligible.empty()) return {};
  const auto by_score = [](const Candidate& a, const Candidate& b) { return a.score < b.score; };
  const auto [least, most] = std::minmax_element(eligible.begin(), eligible.end(), by_score);
  const double low = least->score, range = most->score - low;
  std::array<std::vector<Candidate>, SCORE_STRATA> strata;
  for (const Candidate& one : eligible) {
    const double place = range > 0 ? (one.score - low) / range * SCORE_STRATA : 0;
    strata[std::min(static_cast<std::size_t>(place), SCORE_STRATA - 1)].push_back(one);
  }
  const auto shares = shares_of(strata, count);
  std::vector<Candidate> chosen;
  for (std::size_t k = 0; k < SCORE_STRATA; ++k) {
    std::sort(strata[k].begin(), strata[k].end(), [&](const Candidate& a, const Candidate& b) {
      return std::pair(grip_key(seed, vessel, a.index), a.index) < std::pair(grip_key(seed, vessel, b.index), b.index);
    });
    chosen.insert(chosen.end(), strata[k].begin(), strata[k].begin() + static_cast<std::ptrdiff_t>(shares[k]));
  }
  std::sort(chosen.begin(), chosen.end(), [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
  return chosen;
}

std::vector<std::uint64_t> looked_at(std::uint64_t grips, std::size_t most, std::size_t vessel, std::uint64_t seed) {
  std::vector<std::uint64_t> numbers(static_cast<std::size_t>(std::min<std::uint64_t>(grips, most)));
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    // without overflow: the stretches differ in length by one at most
    const std::uint64_t whole = grips / numbers.size(), rest = grips % numbers.size();
    const std::uint64_t first = whole * k + std::min<std::uint64_t>(k, rest), length = whole + (k < rest ? 1 : 0);
    numbers[k] = first + (length > 1 ? grip_key(seed, vessel, k) % length : 0);
  }
  return numbers;
}

std::vector<Candidate> plausible_by_core(const Scene& scene, const sweeps::Plan& plan, std::shared_ptr<const Evaluator> core,
                                         std::size_t vessel, const TrialOptions& options, const std::atomic<bool>& stop) {
  const std::vector<std::uint64_t> numbers = looked_at(plan.grips(), options.most_looked, vessel, options.seed);
  CoreBackend backend(std::move(core), scene, make_field_set({FIELD_SCORE, FIELD_STATUS}, scene), Precision::full, options.threads);
  std::vector<Candidate> plausible;
  Progress progress(numbers.size(), 0, "grips");
  RunRequest request;
  request.vessel = vessel;
  request.last = numbers.size();
  request.stop = &stop;
  request.grips = [&](std::size_t v, std::uint64_t first, std::size_t count, GripInput* out) {
    for (std::size_t k = 0; k < count; ++k) out[k] = plan.grip(v, numbers[static_cast<std::size_t>(first) + k]);
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i)
      if (is_plausible(chunk.uint(backend.fields().plane[FIELD_STATUS], i)))
        plausible.push_back({chunk.real(backend.fields().plane[FIELD_SCORE], i), chunk.first + i});
    progress.update("scores of " + scene.vessels[vessel].name, chunk.first + chunk.count);
  };
  backend.run(request);
  if (stop) return {};
  for (Candidate& one : plausible) one.index = numbers[static_cast<std::size_t>(one.index)];
  return plausible;
}

std::vector<Candidate> plausible_in_result(const sweeps::SweepResult& result, const sweeps::Plan& plan, std::size_t vessel,
                                           const TrialOptions& options) {
  const sweeps::Variable &score = *result.find("score"), *plausible = result.find("plausible");
  const std::vector<std::uint64_t> numbers = looked_at(plan.grips(), options.most_looked, vessel, options.seed);
  std::vector<Candidate> found;
  std::vector<double> scores(READ_AT_ONCE), is_plausible(READ_AT_ONCE, 0);
  std::size_t next = 0;
  for (std::uint64_t first = 0; first < plan.grips() && next < numbers.size(); first += READ_AT_ONCE) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(READ_AT_ONCE, plan.grips() - first));
    if (numbers[next] >= first + count) continue;
    result.read(score, vessel, 0, first, count, scores.data());
    if (plausible) result.read(*plausible, vessel, 0, first, count, is_plausible.data());
    for (; next < numbers.size() && numbers[next] < first + count; ++next) {
      const auto at = static_cast<std::size_t>(numbers[next] - first);
      if (scores[at] > 0 || is_plausible[at] == 1) found.push_back({scores[at], numbers[next]});
    }
  }
  return found;
}

PartedByDepth parted_by_depth(const Scene& scene, const sweeps::Plan& plan, std::shared_ptr<const Evaluator> core,
                              std::size_t vessel, const std::vector<Candidate>& eligible, const TrialOptions& options,
                              const std::atomic<bool>& stop) {
  if (eligible.empty()) return {};
  CoreBackend backend(std::move(core), scene, make_field_set({FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH}, scene), Precision::full,
                      options.threads);
  const int phalanges = backend.fields().plane[FIELD_PHALANX_DEPTH], palm = backend.fields().plane[FIELD_PALM_DEPTH];
  PartedByDepth parts;
  RunRequest request;
  request.vessel = vessel;
  request.last = eligible.size();
  request.stop = &stop;
  request.grips = [&](std::size_t v, std::uint64_t first, std::size_t count, GripInput* out) {
    for (std::size_t k = 0; k < count; ++k) out[k] = plan.grip(v, eligible[static_cast<std::size_t>(first) + k].index);
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t k = 0; k < chunk.count; ++k) {
      const bool is_deep = std::max(chunk.real(phalanges, k), chunk.real(palm, k)) > options.settings.start_overlap;
      (is_deep ? parts.deep : parts.usual).push_back(eligible[static_cast<std::size_t>(chunk.first) + k]);
    }
  };
  backend.run(request);
  return parts;
}

std::vector<Candidate> sample_of_parts(const PartedByDepth& parts, std::size_t count, std::size_t vessel, std::uint64_t seed) {
  const std::size_t missing = count - std::min(count, parts.usual.size());
  std::vector<Candidate> chosen = stratified_sample(parts.deep, std::max(count / DEEP_ONE_OF, missing), vessel, seed);
  const std::vector<Candidate> usual = stratified_sample(parts.usual, count - chosen.size(), vessel, seed);
  chosen.insert(chosen.end(), usual.begin(), usual.end());
  std::sort(chosen.begin(), chosen.end(), [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
  return chosen;
}

std::vector<Candidate> best_different(const Scene& scene, const sweeps::Plan& plan, const Evaluator& core, std::size_t vessel,
                                      const std::vector<Candidate>& plausible, const TrialOptions& options,
                                      const std::atomic<bool>& stop) {
  const double apart = scene.output.apart;
  const std::size_t candidates = sweeps::robust_candidates(scene, options.best);
  sweeps::ListChooser chooser(plan, &core, vessel,
                              {candidates, apart, sweeps::usual_pool(plan, candidates, apart), options.threads});
  std::vector<Candidate> held = plausible;
  if (has_effort(scene)) std::erase_if(held, [](const Candidate& one) { return !(one.score > 0); });  // 0: it does not hold
  while (!chooser.is_complete()) {
    chooser.offer(held);
    chooser.end_pass();
  }
  std::vector<std::vector<sweeps::BestGrip>> lists(scene.vessels.size() * plan.hand_scales());
  for (std::size_t scale = 0; scale < plan.hand_scales(); ++scale)
    for (const Candidate& one : chooser.progress()[scale].chosen)
      lists[vessel * plan.hand_scales() + scale].push_back(sweeps::bare_grip(plan, vessel, one));
  const sweeps::OpenBackend open = [&](const Scene& other, const FieldSet& fields) {
    return std::make_unique<CoreBackend>(make_core_evaluator(other), other, fields, Precision::full, options.threads);
  };
  if (!sweeps::rank_robustly(open, scene, plan, options.best, &stop, lists)) return {};
  std::vector<Candidate> best;
  for (const auto& list : lists)
    for (const sweeps::BestGrip& one : list) best.push_back(one.candidate);
  return best;
}

std::size_t remove_impossible(const Evaluator& core, std::vector<TrialGrip>& grips) {
  return std::erase_if(grips, [&](const TrialGrip& one) {
    GripResult found;
    core.grip(one.vessel, one.grip, found);
    return found.reason != Reason::none || !found.plausible;
  });
}

std::vector<TrialGrip> choose_trial_grips(const GripSourceOfTrials& source, const TrialOptions& options,
                                          const std::atomic<bool>& stop) {
  const std::vector<std::size_t> vessels = asked_vessels(source.scene, options);
  const bool has_scores = source.result && source.result->find("score");
  const bool has_lists = source.result && source.result->lists_best();
  std::vector<TrialGrip> grips;
  for (std::size_t k = 0; k < vessels.size() && !stop; ++k) {
    const std::size_t v = vessels[k];
    std::vector<Candidate> plausible = has_scores ? plausible_in_result(*source.result, source.plan, v, options)
                                                  : plausible_by_core(source.scene, source.plan, source.core, v, options, stop);
    const std::vector<Candidate> best = has_lists
                                            ? listed_best(*source.result, source.plan, v, options.best)
                                            : best_different(source.scene, source.plan, *source.core, v, plausible, options, stop);
    const auto add = [&](const Candidate& one, TrialSample sample, std::size_t rank) {
      grips.push_back({v, one.index, source.plan.grip(v, one.index), sample, one.score, rank});
    };
    std::vector<std::size_t> places(source.plan.hand_scales());
    for (const Candidate& one : best) add(one, TrialSample::best, ++places[source.plan.hand_scale_of(one.index)]);
    std::erase_if(plausible, [&](const Candidate& one) {
      return std::any_of(best.begin(), best.end(), [&](const Candidate& listed) { return listed.index == one.index; });
    });
    const std::size_t share = options.grips / vessels.size() + (k < options.grips % vessels.size() ? 1 : 0);
    const PartedByDepth parts = parted_by_depth(source.scene, source.plan, source.core, v, plausible, options, stop);
    for (const Candidate& one : sample_of_parts(parts, share, v, options.seed)) add(one, TrialSample::stratified, 0);
  }
  if (stop) return {};
  const std::size_t impossible = source.result ? remove_impossible(*source.core, grips) : 0;
  if (impossible > 0)
    print_note(fmt::format("{} of the result {} not feasible and plausible in double precision, and {} left out",
                           counted(impossible, "chosen grip"), impossible == 1 ? "is" : "are", impossible == 1 ? "is" : "are"));
  if (grips.empty())
    throw usage_error("no grip is feasible and plausible, so there is nothing to try; `wholehand sweep` tells why");
  return grips;
}

}  // namespace wholehand
