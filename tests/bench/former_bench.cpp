// SPDX-License-Identifier: MIT
// The kernels of grips and forces against those of commit 289a04a, which tests/bench/former keeps: the same grips, without efforts, table and
// spheres between the joints, in turns. `ratio` is of processor seconds, as other work on the machine changes the wall's; that of others is
// the program's own work on both sides. `differ`: grips whose status or masks differ. `others`: places in the lists of the best 20 grips
// of each vessel that have another grip, of so many `places`.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/gather.h"
#include "evidence/compare.h"
#include "host/grip_backend.h"
#include "scene/reader.h"
#include "scene/shipped.h"
#include "tests/bench/bench.h"
#include "tests/bench/cost.h"
#include "tests/bench/shaders.h"

namespace wholehand::bench {
namespace {

constexpr int HEIGHTS = 640;             // as in grip_bench.cpp
constexpr double MILLION = 1e6;          // grips
constexpr std::size_t BEST = 20;         // grips of a vessel
constexpr std::uint64_t BATCH = 16384;   // grips whose every plane is held at once
constexpr double MOST_DIFFERING = 1e-3;  // share of grips whose outcomes may change within rounding: that of `check`

Scene as_it_was(Scene scene) {
  scene.strength.reset();
  scene.table.reset();
  scene.hand.between = 0;
  return scene;
}

std::unique_ptr<Backend> backend_of(const Scene& scene, const Options& options, std::span<const EmbeddedShader> shaders,
                                    const FieldSet& fields) {
  host::GripBackendOptions on_device;
  on_device.precision = Precision::single;
  on_device.shaders = shaders;
  if (!shaders.empty()) on_device.forces_together = 1;  // the former shaders know no other
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, options.device, on_device);
}

// Status and masks of all grips of a plan, in one list.
std::vector<std::uint32_t> outcomes_of(Backend& backend, const Scene& scene, const Plan& plan) {
  const auto words = static_cast<std::size_t>(backend.fields().uint_kept);
  std::vector<std::uint32_t> outcomes(scene.vessels.size() * plan.grips() * words);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request = request_of(plan, v);
    request.sink = [&](const PlaneChunk& chunk) {
      for (std::size_t i = 0; i < chunk.count; ++i)
        for (std::size_t p = 0; p < words; ++p)
          outcomes[(v * plan.grips() + chunk.first + i) * words + p] = chunk.uint(static_cast<int>(p), i);
    };
    backend.run(request);
  }
  return outcomes;
}

// How many grips have another status or other masks in one than in the other.
double differing(Backend& one, Backend& other, const Scene& scene, const Plan& plan) {
  const std::vector<std::uint32_t> first = outcomes_of(one, scene, plan), second = outcomes_of(other, scene, plan);
  const auto words = static_cast<std::ptrdiff_t>(one.fields().uint_kept);
  double count = 0;
  for (auto a = first.begin(), b = second.begin(); a != first.end(); a += words, b += words)
    if (!std::equal(a, a + words, b)) ++count;
  return count;
}

void over_former(benchmark::State& state, const Options& options, const Scene& scene) {
  const Plan plan(scene, false);
  const FieldSet fields = make_field_set(KEPT, scene);
  const auto now = backend_of(scene, options, {}, fields), former = backend_of(scene, options, former_shaders(), fields);
  const double differ = differing(*now, *former, scene, plan);  // warms the device's compiler as well
  if (differ > MOST_DIFFERING * static_cast<double>(plan.grips() * scene.vessels.size())) {
    state.SkipWithError("more than one grip in a thousand has another status or other masks");
    return;
  }
  double now_seconds = 0, former_seconds = 0, grips = 0;
  for (auto _ : state) {
    const double seconds = cost_of([&] { grips += static_cast<double>(run_all(*now, scene, plan)); }).processor;
    now_seconds += seconds;
    state.SetIterationTime(seconds);
    former_seconds += cost_of([&] { run_all(*former, scene, plan); }).processor;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
  state.counters["differ"] = differ;
  state.counters["hash"] = hash_all(*now, scene, plan);
  state.counters["ratio"] = former_seconds / now_seconds;
  state.SetLabel("processor seconds of the former shaders over it");
}

// The scene with its own grips and as many more heights as `grips` take in all.
Scene with_more_heights(Scene scene, double grips) {
  const double own = static_cast<double>(Plan(scene, false).grips() * scene.vessels.size());
  std::vector<double>& heights = scene.grips.height.values;
  const auto more = static_cast<std::size_t>(std::ceil(grips / own * static_cast<double>(heights.size())));
  if (heights.size() > 1 && more > heights.size()) {
    const double low = heights.front(), high = heights.back();
    heights.clear();
    for (std::size_t k = 0; k < more; ++k)
      heights.push_back(low + (high - low) * static_cast<double>(k) / static_cast<double>(more - 1));
  }
  return scene;
}

// The extreme scenes. Outcomes may differ where they change within rounding, which `check` allows for one grip in a thousand.
void same_outcomes(benchmark::State& state, const Options& options) {
  const std::vector<std::string> files = extreme_scene_files();
  for (auto _ : state) {
    double grips = 0, differ = 0;
    for (const std::string& file : files) {
      const Scene scene = with_more_heights(as_it_was(read_scene_file(file)), MILLION / static_cast<double>(files.size()));
      const Plan plan(scene, false);
      const FieldSet fields = make_field_set(KEPT, scene);
      const auto now = backend_of(scene, options, {}, fields), former = backend_of(scene, options, former_shaders(), fields);
      grips += static_cast<double>(plan.grips() * scene.vessels.size());
      const double here = differing(*now, *former, scene, plan);
      if (here > 0) std::fprintf(stderr, "%s: %.0f of %zu\n", file.c_str(), here, plan.grips() * scene.vessels.size());
      differ += here;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(grips));
    state.counters["grips"] = grips;
    state.counters["differ"] = differ;
    if (differ > MOST_DIFFERING * grips) state.SkipWithError("more than one grip in a thousand has another status or other masks");
  }
}

// The best of a vessel by both, place by place, without the grips whose outcomes differ: each of those moves all that follow by a place. Where
// a place has another grip, that grip must be nearly as good by the one backend as the one that has its place: two scores apart, each by what
// a score differs at most between the backends.
struct Ranking {
  double places = 0, others = 0;  // others: places with another grip
  double widest = 0;              // between the scores of the two grips of a place
  bool holds = true;
  // `scores` of the one; NaN of grips whose outcomes differ.
  void add(std::vector<Candidate> one, std::vector<Candidate> other, const std::vector<double>& scores, double most) {
    for (std::vector<Candidate>* list : {&one, &other}) {
      std::erase_if(*list, [&](const Candidate& candidate) { return std::isnan(scores[candidate.index]); });
      list->resize(std::min(list->size(), BEST));
    }
    holds = holds && !one.empty() && one.size() == other.size();
    for (std::size_t k = 0; k < std::min(one.size(), other.size()); ++k) {
      ++places;
      if (one[k].index == other[k].index) continue;
      ++others;
      const double apart = std::abs(one[k].score - scores[other[k].index]);
      widest = std::max(widest, apart);
      holds = holds && apart <= 2 * most;
    }
  }
};

// Whether status and masks of a grip are the same.
bool same_words(const GatheredPlanes& a, const GatheredPlanes& b, std::size_t i) {
  const int words = a.fields.uint_kept;
  for (int p = 0; p < words; ++p)
    if (a.uints[static_cast<std::size_t>(p) * a.count + i] != b.uints[static_cast<std::size_t>(p) * b.count + i]) return false;
  return true;
}

// So many grips of a shipped scene by both. False: more outcomes differ than `check` allows, a score does, or the ranking is another one.
// Other numbers may be outside the tolerances of `check` in as few grips as outcomes may differ: the tolerance is found by moving a grip some
// twenty times, and one in a million that grazes a wall moves further. Those are printed.
bool same_answers(benchmark::State& state, const Options& options, const Scene& scene) {
  const Plan plan(scene, false);
  const auto core = make_core_evaluator(scene);
  const FieldSet fields = compared_fields(scene);
  const auto now = backend_of(scene, options, {}, fields), former = backend_of(scene, options, former_shaders(), fields);
  Comparer comparer(scene, *core, allowance(Precision::single), Spreads::where_needed);
  Ranking ranking;
  double differs_most = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    double most = 0;
    std::vector<double> scores;
    std::size_t changed = 0;  // grips whose outcomes differ
    for (std::uint64_t first = 0; first < plan.grips(); first += BATCH) {
      std::vector<GripInput> grips(static_cast<std::size_t>(std::min(BATCH, plan.grips() - first)));
      plan.fill(v, first, grips.size(), grips.data());
      const GatheredPlanes a = gather(*now, v, grips), b = gather(*former, v, grips);
      comparer.add(v, grips, a, b);
      const int score = fields.plane[FIELD_SCORE];
      for (std::size_t i = 0; i < grips.size(); ++i) {
        const bool is_same = same_words(a, b, i);
        changed += is_same ? 0 : 1;
        scores.push_back(is_same ? a.real(score, i) : std::numeric_limits<double>::quiet_NaN());
        if (is_same) most = std::max(most, figure_difference(a.real(score, i), b.real(score, i)));
      }
    }
    RunRequest request = request_of(plan, v);
    request.best = BEST + changed;
    ranking.add(now->run(request).best, former->run(request).best, scores, most);
    differs_most = std::max(differs_most, most);
  }
  bool holds = ranking.holds && std::isfinite(differs_most) && comparer.excluded() <= comparer.allowed();
  for (const Comparison& row : comparer.rows()) {
    const bool decides = row.quantity == "discrete outcomes" || row.kernel == "score";
    holds = holds && row.outside <= (decides ? 0 : comparer.allowed());
    if (row.outside > 0)
      std::fprintf(stderr, "%s: %s differ by more than the tolerance in %.0f grips, by %.2f of it at most\n", scene.name.c_str(),
                   row.quantity.c_str(), static_cast<double>(row.outside), row.worst_ratio);
  }
  std::fprintf(stderr,
               "%s: of %.0f grips, %zu have other outcomes, and scores of the rest differ by %.1e at most; of the best %.0f, %.0f "
               "are others, "
               "whose scores are %.1e apart at most\n",
               scene.name.c_str(), static_cast<double>(comparer.grips()), comparer.flips().size(), differs_most, ranking.places,
               ranking.others, ranking.widest);
  state.counters["grips"] += static_cast<double>(comparer.grips());
  state.counters["differ"] += static_cast<double>(comparer.flips().size());
  state.counters["places"] += ranking.places;
  state.counters["others"] += ranking.others;
  return holds;
}

// A million grips of the shipped scenes.
void same_answers_of_all(benchmark::State& state, const Options& options) {
  const std::vector<std::string> names = shipped_scenes();
  for (auto _ : state)
    for (const std::string& name : names) {
      const Scene scene = as_it_was(read_scene_file(find_scene(name)));
      if (!same_answers(state, options, with_more_heights(scene, MILLION / static_cast<double>(names.size()))))
        state.SkipWithError("outcomes, scores or the ranking of a shipped scene differ by more than `check` allows");
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.counters["grips"].value));
}

}  // namespace

void add_former_benchmarks(const Options& options) {
  const auto add = [&options](const char* name, Scene (*make)(int)) {
    benchmark::RegisterBenchmark(
        name, [&options, make](benchmark::State& state) { over_former(state, options, as_it_was(make(HEIGHTS))); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("former_vulkan_float", grips_scene);
  add("former_whole_vulkan_float", whole_scene);
  const auto add_once = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(name.c_str(), run)->Iterations(1)->Unit(benchmark::kSecond);
  };
  add_once("outcomes_of_former", [&options](benchmark::State& state) { same_outcomes(state, options); });
  add_once("answers_of_former", [&options](benchmark::State& state) { same_answers_of_all(state, options); });
}

}  // namespace wholehand::bench
