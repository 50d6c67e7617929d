// SPDX-License-Identifier: MIT
#include "sweeps/run/run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/files/output_lock.h"
#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "core/evaluator.h"
#include "core/meshes/vessel.h"
#include "host/open_backend.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/result/tally.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/ending.h"
#include "sweeps/run/sweep.h"
#include "sweeps/run/sweep_state.h"

namespace wholehand::sweeps {
namespace {

constexpr double MARK_SHARE = 0.02;           // of the time, at most, for marks
constexpr std::uint64_t MOST_STRETCHES = 64;  // of a vessel's grips with a checksum each, and one more for each --resume

// The passes of one process over the grips of a sweep.
class Passes {
 public:
  Passes(const Sweep& sweep, SweepState& state, ResultFile& file, InterruptGuard& interrupt)
      : sweep_(sweep),
        state_(state),
        file_(file),
        interrupt_(interrupt),
        plan_(sweep.plan()),
        vessels_(state.mark().vessels),
        mark_interval_(sweep.options().tuning.mark_seconds) {}

  // Recomputes what the file no longer holds as it was written. False: interrupted; the mark still stands.
  bool repair() {
    for (std::size_t v = 0; v < vessels_.size(); ++v) {
      for (const Stretch& stretch : vessels_[v].stretches)
        if (!sweep_.repair_stretch(v, stretch, file_, interrupt_)) return false;
    }
    return true;
  }

  // Continues every vessel to its end. False: interrupted; everything done so far is marked.
  bool sweep() {
    Progress progress(sweep_.total(), state_.done(), "grips", sink());
    last_mark_ = monotonic_now();
    for (std::size_t v = 0; v < vessels_.size(); ++v) {
      reset_score_cache();
      while (vessels_[v].done < plan_.grips()) {
        run_stretch(v, progress);
        if (sweep_.is_asked_to_end(interrupt_) && state_.done() < sweep_.total()) {
          progress.clear();
          save();
          return false;
        }
        if (is_mark_due() && state_.done() < sweep_.total()) save();
      }
      file_.start_sync();
      progress.clear();
      if (sweep_.needs_distinct_grips() && !choose(v)) return false;
    }
    return true;
  }

 private:
  ProgressSink sink() const { return sweep_.is_quiet() ? ProgressSink::none : progress_sink(ProgressSink::none); }
  bool is_mark_due() const { return monotonic_now() - last_mark_ >= mark_interval_; }

  void save() {
    const double start = monotonic_now();
    state_.save(file_);
    last_mark_ = monotonic_now();
    mark_interval_ = std::max(sweep_.options().tuning.mark_seconds, (last_mark_ - start) / MARK_SHARE);
  }

  // Grips of a vessel until its end, an interrupt, or the time for a progress mark.
  void run_stretch(std::size_t v, Progress& progress) {
    VesselProgress& vessel = vessels_[v];
    const std::uint64_t before = state_.done();
    std::uint64_t delivered = 0;
    RunRequest request = sweep_.grips_of(v, vessel.done, plan_.grips(), interrupt_);
    HandLists best(plan_, sweep_.kept_best(), vessel.best);
    request.best = sweep_.ranks_here() ? 0 : sweep_.candidates();
    std::atomic<double> least_score{best.least()};
    // Only grips that may still be listed get efforts. Lists of different grips reach far below the best ones, so that all grips are judged there
    // (docs/results).
    if (sweep_.variables().empty() && sweep_.best_wanted() > 0 && !sweep_.needs_distinct_grips())
      request.least_score = &least_score;
    std::vector<Candidate> eligible;
    request.sink = [&](const PlaneChunk& chunk) {
      file_.write(chunk);
      count_grips(chunk, sweep_.fields(), sweep_.gate(v), vessel.counts);
      if (sweep_.ranks_here()) {
        best.offer(chunk, sweep_.fields());
        least_score = best.least();
      }
      if (!score_cache_.empty()) {
        eligible.clear();
        add_eligible(chunk, sweep_.fields(), eligible);
        cache_scores(eligible, chunk.count);
      }
      if (sweep_.has_heat_map()) state_.maps()[v].add(plan_, chunk, sweep_.fields());
      delivered += chunk.count;
      progress.update(sweep_.scene().vessels[v].name, before + delivered);
      if (is_mark_due() || sweep_.is_time_up()) interrupt_.flag() = true;
    };
    const RunResult result = state_.run(std::move(request));
    interrupt_.clear();
    sweep_.check_delivered(result, delivered, sweep_.is_asked_to_end(interrupt_));
    state_.note_once(result.notes, &progress);
    if (delivered == 0) vessel.counts.grips += result.done;
    best.offer(result.best);  // none where they were chosen here
    vessel.best = best.all();
    vessel.done += result.done;
    if (!file_.has_grips() || result.done == 0) return;  // an interrupt may come before the first chunk
    const Stretch stretch = file_.stretch();
    keep_stretch(vessel.stretches, stretch);
    if (stretch.last - stretch.first >= plan_.grips() / MOST_STRETCHES) file_.end_stretch();
  }

  // Chooses the lists of a vessel whose grips are all computed, from the best of them and, if needed, in further passes over all. False: interrupted;
  // the mark has what is decided.
  bool choose(std::size_t v) {
    const bool is_first = vessels_[v].lists.empty();
    ListChooser chooser(plan_, sweep_.evaluator(), v, sweep_.list_request(), vessels_[v].lists);
    if (is_first) {
      chooser.offer(vessels_[v].best);
      state_.end_pass(v, chooser);
    }
    while (!chooser.is_complete()) {
      const bool is_known = cached_count_ == plan_.grips();
      if (sweep_.is_asked_to_end(interrupt_) || (!is_known && !pass_again(v, chooser))) {
        save();
        return false;
      }
      if (is_known) pass_cached_scores(chooser);
      state_.end_pass(v, chooser);
      if (is_mark_due()) save();
    }
    return true;
  }

  // Room for the scores of the next vessel, if there are not too many.
  void reset_score_cache() {
    const bool has_room = sweep_.needs_distinct_grips() && plan_.grips() <= sweep_.options().tuning.cached_scores;
    score_cache_.assign(has_room ? static_cast<std::size_t>(plan_.grips()) : 0, std::numeric_limits<double>::quiet_NaN());
    cached_count_ = 0;
  }

  // Chunks come in ascending order; those from before an interrupt do not come again, so then a further pass is needed.
  void cache_scores(const std::vector<Candidate>& eligible, std::size_t of_grips) {
    if (score_cache_.empty()) return;
    for (const Candidate& grip : eligible) score_cache_[static_cast<std::size_t>(grip.index)] = grip.score;
    cached_count_ += of_grips;
  }

  // A further pass over known scores. An interrupt is checked before the next pass.
  void pass_cached_scores(ListChooser& chooser) const {
    constexpr std::size_t AT_ONCE = 1 << 16;
    std::vector<Candidate> eligible;
    for (std::size_t first = 0; first < score_cache_.size(); first += AT_ONCE) {
      eligible.clear();
      for (std::size_t i = first; i < std::min(score_cache_.size(), first + AT_ONCE); ++i)
        if (!std::isnan(score_cache_[i])) eligible.push_back({score_cache_[i], i});
      chooser.offer(eligible);
    }
  }

  // All grips of a vessel once more, for the chooser alone. False: interrupted.
  bool pass_again(std::size_t v, ListChooser& chooser) {
    Progress progress(plan_.grips(), 0, "grips", sink());
    std::uint64_t delivered = 0;
    RunRequest request = sweep_.grips_of(v, 0, plan_.grips(), interrupt_);
    std::vector<Candidate> eligible;
    reset_score_cache();
    request.sink = [&](const PlaneChunk& chunk) {
      eligible.clear();
      add_eligible(chunk, sweep_.fields(), eligible);
      chooser.offer(eligible);
      cache_scores(eligible, chunk.count);
      delivered += chunk.count;
      if (sweep_.is_time_up()) interrupt_.flag() = true;
      progress.update(sweep_.scene().vessels[v].name + ", again for different best grips", delivered);
    };
    const RunResult result = state_.run(std::move(request));
    state_.note_once(result.notes, &progress);
    return result.done == plan_.grips();
  }

  const Sweep& sweep_;
  SweepState& state_;
  ResultFile& file_;
  InterruptGuard& interrupt_;
  const Plan& plan_;
  std::vector<VesselProgress>& vessels_;
  double mark_interval_;
  double last_mark_ = 0;             // s of the clock
  std::vector<double> score_cache_;  // scores of the current vessel; NaN: not eligible. Empty: not kept
  std::uint64_t cached_count_ = 0;   // grips whose outcome is included
};

}  // namespace

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  const bool is_quiet = static_cast<bool>(options.hooks.note);
  SweepParts parts;
  parts.open_backend = [&](const BackendChoice& choice, const FieldSet& fields) {
    return open_backend(scene, fields, choice.on, choice.precision, options.threads,
                        is_quiet ? host::CompileWatch() : show_compiling());
  };
  parts.open_evaluator = [&] { return make_core_evaluator(scene); };
  parts.prepare = [&](const BackendChoice& asked) {
    if (!has_meshes(scene)) return asked;
    MeshOptions meshes;
    meshes.is_quiet = is_quiet;
    if (!is_quiet) meshes.say = print_note;  // else findings are not notes: the other program asks for them where it wants
    const auto limit = [&](const BackendChoice& here) { meshes.most_bytes = largest_lattice(largest_buffer(here.on)); };
    // by itself, so that a note comes before meshes that take long
    const BackendChoice choice = with_core_fallback(asked, options.hooks, limit);
    return with_core_fallback(choice, options.hooks, [&](const BackendChoice& here) {
      if (here.on != choice.on) limit(here);
      load_meshes(scene, meshes);
    });
  };
  parts.open_core = [&](const Scene& other, const FieldSet& fields) {
    return open_backend(other, fields, "core", Precision::full, options.threads);
  };
  return run_sweep(scene, options, choose_backend(scene, options), parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return run_sweep(scene, options, named_backend(options.on, options.precision), parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts) {
  // a file that grows past its limit is an error of the write, not the end of the process
  std::signal(SIGXFSZ, SIG_IGN);
  Sweep sweep(scene, options, choice, parts);
  // The process is not a quiet sweep's to end: a signal before the first grips waits for them.
  std::optional<InterruptGuard> guard;
  if (sweep.is_quiet()) guard.emplace().on_second_signal([](int) {});
  // first, because it needs neither disk space nor an output path
  if (sweep.is_already_complete()) return sweep.report_already_complete();
  sweep.check();
  const OutputLock lock(sweep.names().lock);
  if (sweep.is_already_complete()) return sweep.report_already_complete();  // by who had the lock until now
  sweep.open();
  sweep.print_header();
  const ResultContents written = sweep.contents();
  SweepState state(sweep);
  const FileStart start = state.begin() ? FileStart::resumed : FileStart::reserved;
  // An interrupt while the file is laid out waits for the first grips. One after the last grip lets the ending finish, except refined grips and
  // robust scores.
  InterruptGuard& interrupt = guard ? *guard : guard.emplace();
  ResultFile file(sweep.names(), written, sweep.fields(), start, parts.open_output);
  Passes passes(sweep, state, file, interrupt);
  if (!passes.repair() || !passes.sweep()) return state.interrupted();
  bool is_whole = false;
  state.run_and_save_on_failure(file, [&] {
    BestLists best = find_best(sweep, state);
    is_whole = choose_best(sweep, best, interrupt);
    if (is_whole) return publish(sweep, state, file, std::move(best));
    state.save(file);
  });
  return is_whole ? ExitCode::done : state.interrupted();
}

}  // namespace wholehand::sweeps
