// SPDX-License-Identifier: MIT
#include "sweeps/run/sweep.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <limits>
#include <utility>

#include "base/files/files.h"
#include "base/files/output_lock.h"
#include "base/system/clock.h"
#include "base/system/output.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "core/tolerances.h"
#include "sweeps/lists/best.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/lists/refine.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/cavity_notes.h"
#include "sweeps/plan/idle_notes.h"
#include "sweeps/rank/unheld.h"
#include "sweeps/result/companions.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/tally.h"
#include "sweeps/run/closing.h"
#include "sweeps/run/explain.h"
#include "sweeps/run/resume.h"
#include "sweeps/run/write_companions.h"

namespace wholehand {
namespace {

constexpr double MARK_SHARE = 0.02;           // of the time, at most, for marks
constexpr off_t LONG_CHECK = 1'000'000'000;   // bytes of a partial file: from here on a note says that they are read
constexpr std::uint64_t MOST_STRETCHES = 64;  // of a vessel's grips with a checksum each, and one more for each --resume

double since(double start) { return monotonic_now() - start; }

}  // namespace

Sweep::Sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts)
    : scene_(scene),
      options_(options),
      choice_(choice),
      parts_(parts),
      names_(output_names(options.output.empty() ? default_output(scene) : options.output)),
      best_wanted_(static_cast<std::size_t>(std::max(0, options.best.value_or(scene.output.best)))),
      by_(read_rank_by(options.rank_by, scene)),
      variables_(choose_variables(scene)),
      mark_interval_(options.tuning.mark_seconds) {}

// Refuses what it can before any work, meshes unread.
void Sweep::check() const {
  check_output_path(names_.result);
  if (options_.glb > static_cast<int>(best_wanted_)) {
    throw usage_error(fmt::format("--glb {0}: the sweep keeps only the best {1} grips of each vessel; give --best {0} too",
                                  options_.glb, best_wanted_));
  }
  if (!options_.rank_by.empty() && best_wanted_ == 0)
    throw usage_error("--rank-by: the sweep lists no grips; give --best N above 0");
  if (!has_usual_order() && options_.shards)
    throw usage_error(
        "--rank-by: orders the grips of one result, which --shards leaves to `wholehand merge`; `wholehand rank` takes it");
  if (!has_usual_order()) check_rankable(scene_, variables_, by_);
  check_not_the_scene(names_.result, scene_);
  check_overwrites_result(names_.result);
  check_companions(scene_, names_, best_wanted_ > 0, has_score(), options_.glb);
  check_room();
}

void Sweep::check_room() const {
  struct stat partial {};
  const double reserved = stat(names_.partial.c_str(), &partial) == 0 ? static_cast<double>(partial.st_blocks) * 512 : 0;
  const std::size_t real_size = choice_.precision == Precision::single ? sizeof(float) : sizeof(double);
  // a shard takes what its node computes, which is unknown yet
  const double room = options_.shards ? std::numeric_limits<double>::infinity() : free_bytes(names_.target) + reserved;
  SweepSize size = sweep_size(scene_, bytes_per_grip(variables_, scene_, real_size));
  if (size.grips <= LARGEST_SWEEP) {
    const Plan plan(scene_, keeps_vectors(variables_));
    BackendInfo info;
    info.precision = choice_.precision;
    size.bytes = static_cast<double>(result_size({scene_, plan, variables_, {}, info, version(), best_wanted_}));
  }
  check_sweep_size(scene_, size, room);
}

bool Sweep::is_already_complete() const {
  struct stat file {};
  return options_.resume && stat(names_.partial.c_str(), &file) != 0 && stat(names_.result.c_str(), &file) == 0 &&
         S_ISREG(file.st_mode);
}

ExitCode Sweep::run() {
  // a file that grows past its limit is an error of the write, not the end of the process
  std::signal(SIGXFSZ, SIG_IGN);
  // The process is not a quiet sweep's to end: a signal before the first grips waits for them.
  std::optional<InterruptGuard> guard;
  if (is_quiet()) guard.emplace().on_second_signal([](int) {});
  // first, because it needs neither disk space nor an output path
  if (is_already_complete()) return report_already_complete();
  check();
  const OutputLock lock(names_.lock);
  if (is_already_complete()) return report_already_complete();  // by who had the lock until now
  open();
  print_header();
  const ResultContents written = contents();
  const bool resumed = begin();
  // An interrupt while the file is laid out waits for the first grips. One after the last grip lets the ending finish, except refined grips and
  // robust scores.
  InterruptGuard& interrupt = guard ? *guard : guard.emplace();
  ResultFile file(names_, written, backend_->fields(), resumed ? FileStart::resumed : FileStart::reserved, parts_.open_output);
  is_marked_ = resumed;
  if (!repair(file, interrupt) || !sweep(file, interrupt)) return interrupted();
  bool is_whole = false;
  run_and_save_on_failure(file, [&] {
    BestLists best = find_best();
    is_whole = choose_best(best, interrupt);
    if (is_whole) return publish(file, std::move(best));
    save(file);
  });
  return is_whole ? ExitCode::done : interrupted();
}

void Sweep::open() {
  const Precision asked = choice_.precision;
  if (parts_.prepare) choice_ = parts_.prepare(choice_);
  plan_.emplace(scene_, keeps_vectors(variables_));
  choice_ = with_core_fallback(
      choice_, [this](const std::string& line) { note(line); },
      [this](const BackendChoice& choice) { backend_ = parts_.open_backend(choice, make_field_set(swept_fields(), scene_)); });
  if (choice_.precision != asked) check_room();  // on the core instead of the device: doubles
  info_ = identified_ = backend_->info();
  evaluator_ = parts_.open_evaluator();
  facts_ = vessel_facts(scene_, *backend_, *evaluator_);
  if (!needs_distinct_grips() && !refines()) evaluator_.reset();
}

void Sweep::print_header() const {
  if (options_.hooks.warn) options_.hooks.warn(scene_, choice_.precision);
  for (const std::string& line : cavity_notes(scene_)) note(line);
  for (const std::string& line : idle_notes(scene_, plan(), best_wanted_)) note(line);
  print_text(opening_lines(scene_, plan(), info_) + vessel_lines(scene_, facts_) + unjudged_note(scene_, plan()));
  if (!options_.explain) return;
  print_text(explain_sweep(scene_, plan(), backend_->fields(), {choice_.on, choice_.precision, options_.threads, best_wanted_}));
}

void Sweep::note(const std::string& line) const { is_quiet() ? options_.hooks.note(line) : print_note(line); }

void Sweep::print_text(const std::string& text) const {
  if (is_quiet()) return;
  print(text);
}

ResultContents Sweep::contents() const { return {scene_, plan(), variables_, facts_, info_, version(), best_wanted_}; }

bool Sweep::needs_distinct_grips() const { return best_wanted_ > 0 && scene_.output.apart > 0; }
bool Sweep::refines() const { return best_wanted_ > 0 && options_.refine; }
std::size_t Sweep::pool() const {
  return options_.tuning.pool > 0 && needs_distinct_grips() ? options_.tuning.pool
                                                            : usual_pool(plan(), candidates(), scene_.output.apart);
}
std::size_t Sweep::candidates() const { return robust_candidates(scene_, best_wanted_); }
std::size_t Sweep::kept_best() const { return needs_distinct_grips() ? pool() : candidates(); }
ListRequest Sweep::list_request() const { return {candidates(), scene_.output.apart, pool(), options_.threads}; }
// Lists of different grips reach far below the best ones, so that all grips are judged there (docs/results).
bool Sweep::skips_hopeless_efforts() const { return variables_.empty() && best_wanted_ > 0 && !needs_distinct_grips(); }
bool Sweep::ranks_here() const { return best_wanted_ > 0 && (needs_distinct_grips() || plan().hand_scales() > 1); }
// The fields that are read back. A device chooses a few of the best over all hands together; with several hand scales, or if grips must differ, the
// host chooses from the scores.
std::vector<int> Sweep::swept_fields() const {
  const std::vector<int> kept = variable_fields(variables_);
  std::set<int> fields(kept.begin(), kept.end());
  if (ranks_here()) fields.insert({FIELD_SCORE, FIELD_STATUS});
  // if no grip holds, the sweep reports the nearest one
  if (best_wanted_ > 0 && has_effort(scene_)) fields.insert({FIELD_STATUS, FIELD_WORST_EFFORT});
  return {fields.begin(), fields.end()};
}

bool Sweep::has_field(int field) const { return is_kept(backend_->fields(), field); }
bool Sweep::has_heat_map() const { return has_score() && has_field(FIELD_SCORE) && has_field(FIELD_STATUS); }

bool Sweep::has_score() const {
  return std::any_of(variables_.begin(), variables_.end(), [](const Variable* v) { return v->field == FIELD_SCORE; });
}

ExitCode Sweep::report_already_complete() const {
  check_complete(names_.result, scene_, choice_.on == "core", choice_.precision, variables_);
  note(fmt::format("{} is complete, so nothing is left to do; the same command without --resume computes it again{}", names_.result,
                   has_usual_order() ? ""
                                     : fmt::format(", and `wholehand rank {} --rank-by {}` lists its grips",
                                                   one_line(names_.result), options_.rank_by)));
  return ExitCode::done;
}

std::map<std::string, std::string> Sweep::identity() const {
  auto identity = sweep_identity(scene_, plan(), identified_, best_wanted_, variables_);
  identity["set of files"] = options_.shards ? "shards" : "one file";
  return identity;
}

// What a mark of this sweep can say at most.
MarkBounds Sweep::bounds() const {
  const bool has_stretches = !variables_.empty();
  return {scene_.vessels.size(),
          plan().grips(),
          std::max(candidates(), kept_best()) * plan().hand_scales(),
          needs_distinct_grips() ? plan().hand_scales() : 0,
          candidates(),
          has_stretches,
          has_stretches && has_field(FIELD_STATUS)};
}

// Sets the progress: from the mark of an earlier sweep if there is one to resume, else nothing done. True: resumed.
bool Sweep::begin() {
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) maps_.emplace_back(plan());
  SweepMark mark;
  std::string line = options_.resume ? "" : lost_line(names_);
  if (options_.resume) announce_check();
  const bool resumed = options_.resume && load_usable_mark(names_, identity(), bounds(), mark, line);
  if (!line.empty()) note(line);
  if (resumed) {
    mark_ = mark;
    for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) maps_[v].restore(mark_.vessels[v].heat_map);
    note(fmt::format("continuing {}: {} of {}", names_.partial, readable_number(done()),
                     counted(total(), "grip is there", "grips are there")));
  } else {
    if (options_.resume) note(fmt::format("{} holds no complete grip: starting from the first grip", names_.partial));
    mark_.identity = identity();
    mark_.vessels.resize(scene_.vessels.size());
  }
  wall_before_ = mark_.wall_seconds;
  return resumed;
}

// Before a file is read that takes long.
void Sweep::announce_check() const {
  struct stat file {};
  if (stat(names_.mark.c_str(), &file) != 0 || stat(names_.partial.c_str(), &file) != 0 || file.st_size <= LONG_CHECK) return;
  note(fmt::format("checking {} of {}", readable_bytes(static_cast<double>(file.st_size)), names_.partial));
}

std::uint64_t Sweep::total() const { return plan().grips() * scene_.vessels.size(); }

std::uint64_t Sweep::done() const {
  std::uint64_t sum = 0;
  for (const VesselProgress& vessel : mark_.vessels) sum += vessel.done;
  return sum;
}

bool Sweep::has_shards() const {
  for (const VesselProgress& vessel : mark_.vessels)
    for (const Stretch& stretch : vessel.stretches)
      if (!stretch.shard.empty()) return true;
  return false;
}

bool Sweep::is_time_up() const { return options_.time_limit > 0 && since(options_.started) >= options_.time_limit; }
bool Sweep::is_asked_to_end(InterruptGuard& interrupt) const { return interrupt.signalled() || is_time_up(); }
bool Sweep::is_mark_due() const { return since(last_mark_) >= mark_interval_; }

// Recomputes what the file no longer holds as it was written. False: interrupted; the mark still stands.
bool Sweep::repair(ResultFile& file, InterruptGuard& interrupt) {
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    for (const Stretch& stretch : mark_.vessels[v].stretches)
      if (!repair_stretch(v, stretch, file, interrupt)) return false;
  }
  return true;
}

bool Sweep::repair_stretch(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) {
  if (is_asked_to_end(interrupt)) return false;
  if (file.holds(v, stretch)) return true;
  note(fmt::format("{}{}: {} are damaged: computing them again", rank_prefix(), file.path(), readable_stretch(stretch, v)));
  return restore_stretch(v, stretch, file, interrupt);
}

bool Sweep::restore_stretch(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) {
  if (is_asked_to_end(interrupt)) return false;
  if (!compute_again(v, stretch, file, interrupt)) return false;
  if (file.holds(v, stretch)) return true;
  throw failure_error(fmt::format("{}: {} have other values when computed again; start again without --resume", file.path(),
                                  readable_stretch(stretch, v)));
}

std::string Sweep::readable_stretch(const Stretch& stretch, std::size_t v) const {
  return fmt::format("grips {} to {} of {}", readable_number(stretch.first), readable_number(stretch.last - 1),
                     scene_.vessels[v].name);
}

bool Sweep::compute_again(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) {
  RunRequest request = grips_of(v, interrupt);
  request.first = stretch.first;
  request.last = stretch.last;
  request.sink = [&](const PlaneChunk& chunk) {
    file.write(chunk);
    if (is_time_up()) interrupt.flag() = true;
  };
  const RunResult result = backend_->run(request);
  file.end_stretch();
  return result.done == stretch.last - stretch.first;
}

RunRequest Sweep::grips_of(std::size_t v, InterruptGuard& interrupt) const {
  RunRequest request;
  request.vessel = v;
  request.stop = &interrupt.flag();
  request.grips = [&plan = plan()](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
    plan.fill(w, first, count, out);
  };
  return request;
}

// Continues every vessel to its end. False: interrupted; everything done so far is marked.
bool Sweep::sweep(ResultFile& file, InterruptGuard& interrupt) {
  Progress progress(total(), done(), "grips", is_quiet() ? ProgressSink::none : progress_sink(ProgressSink::none));
  last_mark_ = monotonic_now();
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    reset_score_cache();
    while (mark_.vessels[v].done < plan().grips()) {
      run_stretch(v, file, interrupt, progress);
      if (is_asked_to_end(interrupt) && done() < total()) {
        progress.clear();
        save(file);
        return false;
      }
      if (is_mark_due() && done() < total()) save(file);
    }
    file.start_sync();
    progress.clear();
    if (needs_distinct_grips() && !choose(v, file, interrupt)) return false;
  }
  return true;
}

// Grips of a vessel until its end, an interrupt, or the time for a progress mark.
void Sweep::run_stretch(std::size_t v, ResultFile& file, InterruptGuard& interrupt, Progress& progress) {
  VesselProgress& vessel = mark_.vessels[v];
  const std::uint64_t before = done();
  std::uint64_t delivered = 0;
  double sink_seconds = 0;
  RunRequest request = grips_of(v, interrupt);
  request.first = vessel.done;
  request.last = plan().grips();
  HandLists best(plan(), kept_best(), vessel.best);
  request.best = ranks_here() ? 0 : candidates();
  std::atomic<double> least_score{best.least()};
  if (skips_hopeless_efforts()) request.least_score = &least_score;
  std::vector<Candidate> eligible;
  request.sink = [&](const PlaneChunk& chunk) {
    const double start = monotonic_now();
    file.write(chunk);
    count_grips(chunk, backend_->fields(), gate(v), vessel.counts);
    if (ranks_here()) {
      best.offer(chunk, backend_->fields());
      least_score = best.least();
    }
    if (!score_cache_.empty()) {
      eligible.clear();
      add_eligible(chunk, backend_->fields(), eligible);
      cache_scores(eligible, chunk.count);
    }
    if (has_heat_map()) maps_[v].add(plan(), chunk, backend_->fields());
    delivered += chunk.count;
    progress.update(scene_.vessels[v].name, before + delivered);
    if (is_mark_due() || is_time_up()) interrupt.flag() = true;
    sink_seconds += since(start);
  };
  const double start = monotonic_now();
  const RunResult result = backend_->run(request);
  wait_seconds_ += since(start) - sink_seconds;
  interrupt.clear();
  // a backend without results to deliver need not call the sink; one with results must deliver all of them
  if ((delivered != result.done && !(delivered == 0 && variables_.empty())) || (result.done == 0 && !is_asked_to_end(interrupt))) {
    throw failure_error(fmt::format("{}: handed over {} of {} grips", backend_->info().device, readable_number(delivered),
                                    readable_number(result.done)));
  }
  if (delivered == 0) vessel.counts.grips += result.done;
  best.offer(result.best);  // none where they were chosen here
  vessel.best = best.all();
  vessel.done += result.done;
  if (file.has_grips() && result.done > 0) {  // an interrupt may come before the first chunk
    const Stretch stretch = file.stretch();
    keep_stretch(vessel.stretches, stretch);
    if (stretch.last - stretch.first >= plan().grips() / MOST_STRETCHES) file.end_stretch();
  }
  kernel_seconds_ += result.kernel_seconds;
  mark_.kernel_seconds += result.kernel_seconds;
  note_once(result.notes, &progress);
}

void Sweep::note_once(const std::vector<std::string>& notes, Progress* progress) {
  for (const std::string& line : notes) {
    if (!noted_.insert(line).second) continue;
    if (progress) progress->clear();
    note(line);
  }
}

// Chooses the lists of a vessel whose grips are all computed, from the best of them and, if needed, in further passes over all. False: interrupted;
// the mark has what is decided.
bool Sweep::choose(std::size_t v, ResultFile& file, InterruptGuard& interrupt) {
  VesselProgress& vessel = mark_.vessels[v];
  const bool is_first = vessel.lists.empty();
  ListChooser chooser(plan(), evaluator_.get(), v, list_request(), vessel.lists);
  if (is_first) {
    chooser.offer(vessel.best);
    choose_from_pass(chooser, vessel);
  }
  while (!chooser.is_complete()) {
    const bool is_known = cached_count_ == plan().grips();
    if (is_asked_to_end(interrupt) || (!is_known && !pass_again(v, chooser, interrupt))) {
      save(file);
      return false;
    }
    if (is_known) pass_cached_scores(chooser);
    choose_from_pass(chooser, vessel);
    if (is_mark_due()) save(file);
  }
  return true;
}

void Sweep::choose_from_pass(ListChooser& chooser, VesselProgress& vessel, const ListChooser::PoseHands& pose) {
  chooser.end_pass(pose);
  vessel.lists = chooser.progress();
  vessel.best = chooser.chosen();
}

// Room for the scores of the next vessel, if there are not too many.
void Sweep::reset_score_cache() {
  const bool has_room = needs_distinct_grips() && plan().grips() <= options_.tuning.cached_scores;
  score_cache_.assign(has_room ? static_cast<std::size_t>(plan().grips()) : 0, std::numeric_limits<double>::quiet_NaN());
  cached_count_ = 0;
}

// Chunks come in ascending order; those from before an interrupt do not come again, so then a further pass is needed.
void Sweep::cache_scores(const std::vector<Candidate>& eligible, std::size_t of_grips) {
  if (score_cache_.empty()) return;
  for (const Candidate& grip : eligible) score_cache_[static_cast<std::size_t>(grip.index)] = grip.score;
  cached_count_ += of_grips;
}

// A further pass over known scores. An interrupt is checked before the next pass.
void Sweep::pass_cached_scores(ListChooser& chooser) const {
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
bool Sweep::pass_again(std::size_t v, ListChooser& chooser, InterruptGuard& interrupt) {
  Progress progress(plan().grips(), 0, "grips", is_quiet() ? ProgressSink::none : progress_sink(ProgressSink::none));
  std::uint64_t delivered = 0;
  RunRequest request = grips_of(v, interrupt);
  request.last = plan().grips();
  std::vector<Candidate> eligible;
  reset_score_cache();
  request.sink = [&](const PlaneChunk& chunk) {
    const double start = monotonic_now();
    eligible.clear();
    add_eligible(chunk, backend_->fields(), eligible);
    chooser.offer(eligible);
    cache_scores(eligible, chunk.count);
    delivered += chunk.count;
    if (is_time_up()) interrupt.flag() = true;
    progress.update(scene_.vessels[v].name + ", again for different best grips", delivered);
    wait_seconds_ -= since(start);
  };
  const double start = monotonic_now();
  const RunResult result = backend_->run(request);
  wait_seconds_ += since(start);
  kernel_seconds_ += result.kernel_seconds;
  mark_.kernel_seconds += result.kernel_seconds;
  note_once(result.notes, &progress);
  return result.done == plan().grips();
}

// Syncs everything up to here to the disk, then saves the mark that says so.
void Sweep::save(ResultFile& file) {
  const double start = monotonic_now();
  file.sync();
  file.check_own();
  file.vouch_for_structure(mark_);
  mark_.wall_seconds = wall_before_ + since(options_.started);
  for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) mark_.vessels[v].heat_map = maps_[v].scores();
  save_mark(names_.mark, mark_);
  is_marked_ = true;
  last_mark_ = monotonic_now();
  mark_interval_ = std::max(options_.tuning.mark_seconds, since(start) / MARK_SHARE);
}

ExitCode Sweep::interrupted() const {
  note(fmt::format("interrupted at {} of {}; the same command with --resume goes on with {}", readable_number(done()),
                   counted(total(), "grip"), names_.partial));
  return ExitCode::interrupted;
}

CompanionRequest Sweep::companions() const {
  return {scene_, plan(), names_, parts_, best_wanted_, options_.glb, [this](const std::string& line) { note(line); }};
}

BestLists Sweep::find_best() const {
  BestLists lists;
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    const HandLists kept(plan(), candidates(), mark_.vessels[v].best);
    for (std::size_t s = 0; s < plan().hand_scales(); ++s) {
      std::vector<BestGrip>& list = lists.emplace_back();
      for (const Candidate& candidate : kept.sorted(s)) list.push_back(bare_grip(plan(), v, candidate));
    }
  }
  return lists;
}

void Sweep::run_and_save_on_failure(ResultFile& file, const std::function<void()>& ending) {
  try {
    ending();
  } catch (...) {
    try {
      save(file);
    } catch (const std::exception&) {
      // the user must know the first failure
    }
    throw;
  }
}

// It may take as long as the sweep.
bool Sweep::choose_best(BestLists& best, InterruptGuard& interrupt) const {
  const auto look = [&] {
    if (is_asked_to_end(interrupt)) interrupt.flag() = true;
    return interrupt.flag().load();
  };
  if (best_wanted_ > 0 && !rank_robustly(parts_.open_core, scene_, plan(), best_wanted_, &interrupt.flag(), best, look))
    return false;
  return !refines() || refine_lists(*evaluator_, scene_, plan(), options_.threads, best, look);
}

// Whether the result has what `rank --least-bad` needs.
bool Sweep::keeps_least_bad() const {
  int kept = 0;
  for (const Variable* variable : variables_)
    for (const std::string_view name : {"plausible", "not_held", "worst_effort", "score"}) kept += variable->name == name ? 1 : 0;
  return kept == 4;
}

bool Sweep::has_usual_order() const { return by_ == usual_order(scene_); }

Ranking Sweep::rank_finished(const RankRequest& request) const {
  SweepResult result(names_.result);
  result.use(scene_, plan());
  RankRequest own = request;
  if (own.best == 0) own.best = usual_length(result, scene_, plan());
  return rank_grips(result, scene_, plan(), own, parts_.open_evaluator);
}

// The note for a vessel without a holding grip.
std::string Sweep::unheld(std::size_t v) const {
  const GripCounts& counts = mark_.vessels[v].counts;
  if (!counts.none_holds() || !counts.least_bad.is_known()) return "";
  const std::shared_ptr<const Evaluator> core = parts_.open_evaluator();
  return fmt::format(
      "{}{}", unheld_line(*core, scene_, plan(), v, with_least_friction(*core, scene_, plan(), v, counts.least_bad)),
      keeps_least_bad() ? fmt::format("; `wholehand rank {} --least-bad` lists such grips", one_line(names_.result)) : "");
}

// The same for each list, if others of its vessel have grips (with several hand scales). The marks only know the nearest grip of a vessel, so this
// reads the finished result.
std::vector<std::string> Sweep::unheld_lists(const BestLists& best) const {
  bool is_any = false;
  for (std::size_t list = 0; list < best.size(); ++list) {
    const GripCounts& counts = mark_.vessels[list / plan().hand_scales()].counts;
    is_any = is_any || (best[list].empty() && counts.not_held > 0 && !counts.none_holds());
  }
  if (!is_any || is_quiet() || best_wanted_ == 0 || !keeps_least_bad() || has_shards())
    return std::vector<std::string>(best.size());
  return unheld_lines(*parts_.open_evaluator(), scene_, plan(), rank_finished({"", {}, 1, 0, 0, true}));
}

std::string Sweep::counts_text(std::size_t v) const {
  const GripCounts& counts = mark_.vessels[v].counts;
  const bool is_known = has_field(FIELD_STATUS);
  const std::string gate_line = gate_text(counts.at_gate, gate(v));
  return (options_.list.is_wide ? counts_line(counts, is_known, plan().copies())
                                : short_counts_line(counts, is_known, plan().copies(), has_effort(scene_))) +
         (gate_line.empty() ? "" : "\n  " + gate_line);
}

double Sweep::gate(std::size_t v) const { return gate_tolerance(scene_, facts_[v].empty_mass); }

void Sweep::publish(ResultFile& file, BestLists best) {
  if (has_usual_order()) describe_best(companions(), best);
  file.check_own();
  const auto write_others = [&] { return write_companions(companions(), best, has_heat_map() ? &maps_ : nullptr, info_); };
  // Renames the result last: once it exists, everything does. Lists in another order are made from the finished result.
  std::vector<std::string> files;
  if (has_usual_order()) files = write_others();
  // Syncs the values first, so that little time passes between the ending, which no earlier mark fits, and the mark that vouches for it.
  if (is_marked_) save(file);
  file.write_ending(best, wall_before_ + since(options_.started), mark_.kernel_seconds);
  const bool is_parted = has_shards();
  if (is_parted) mark_.shards->is_ended = true;
  if (is_marked_ || is_parted) save(file);  // which now vouches for the ending, too
  if (!is_parted) file.finish(std::move(checksums_));
  if (!has_usual_order()) {
    Ranking ranking = rank_finished({"", {}, 0, scene_.output.apart, 0, false, by_});
    if (!ranking.note.empty()) note(ranking.note);
    best = std::move(ranking.lists);
    files = write_others();
  }
  files.insert(files.begin(), is_parted ? names_.partial : names_.result);
  ListView view = options_.list;
  view.by = by_;
  const std::vector<std::string> failures = unheld_lists(best);
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    const std::string& name = scene_.vessels[v].name;
    const std::string failure = unheld(v), counts = counts_text(v);
    view.score_tolerance = score_tolerance(effective_weights(scene_), gate(v));
    if (is_quiet() && !failure.empty()) note(name + ": " + failure);
    print_text("\n" + (!failure.empty()    ? fmt::format("{}: {}\n  {}\n", name, failure, counts)
                       : best_wanted_ == 0 ? fmt::format("{}: {}\n", name, counts)
                                           : best_lines(scene_, plan(), v, counts, best, failures, names_.best, view)));
  }
  // kernels that ran while the file was being written cost no time of their own
  const SweepTimes times{since(options_.started), info_.compile_seconds, std::min(wait_seconds_, kernel_seconds_), file.seconds(),
                         file.bytes()};
  print_text("\n" + closing_lines(files, times));
  if (!choice_.alternative.empty()) print_text(backend_line(info_, times, choice_.alternative));
}

}  // namespace wholehand
