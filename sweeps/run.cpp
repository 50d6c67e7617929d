// SPDX-License-Identifier: MIT
#include "sweeps/run.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <set>
#include <utility>

#include "core/prepare.h"
#include "host/open_backend.h"
#include "objects/vessel.h"
#include "sweeps/best.h"
#include "sweeps/cavity_notes.h"
#include "sweeps/closing.h"
#include "sweeps/companions.h"
#include "sweeps/explain.h"
#include "sweeps/hand_lists.h"
#include "sweeps/idle_notes.h"
#include "sweeps/list_chooser.h"
#include "sweeps/refine.h"
#include "sweeps/result_file.h"
#include "sweeps/resume.h"
#include "sweeps/robust.h"
#include "sweeps/tally.h"
#include "sweeps/write_companions.h"
#include "system/clock.h"
#include "system/interrupt.h"
#include "system/output_lock.h"
#include "system/progress.h"
#include "system/readable.h"
#include "system/version.h"

namespace wholehand {
namespace {

constexpr double MARK_SHARE = 0.02;           // of the time, at most, for marks
constexpr off_t LONG_CHECK = 1'000'000'000;   // bytes of a partial file: from here on it is said that they are read
constexpr std::uint64_t MOST_STRETCHES = 64;  // of a vessel's grips with a checksum each, and one more for each --resume

double since(double start) { return monotonic_now() - start; }

class Sweep {
 public:
  Sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts)
      : scene_(scene),
        options_(options),
        parts_(parts),
        names_(output_names(options.output.empty() ? default_output(scene) : options.output)),
        best_wanted_(static_cast<std::size_t>(std::max(0, options.best.value_or(scene.output.best)))),
        variables_(choose_variables(scene)) {}

  // What can be refused before any work, meshes unread.
  void check() const {
    check_output_path(names_.result);
    if (options_.glb > static_cast<int>(best_wanted_)) {
      throw usage_error(fmt::format("--glb {0}: the sweep keeps only the best {1} grips of each vessel; give --best {0} too",
                                    options_.glb, best_wanted_));
    }
    check_not_the_scene(names_.result, scene_);
    check_overwrites_result(names_.result);
    check_companions(scene_, names_, best_wanted_ > 0, has_score(), options_.glb);
    struct stat partial {};
    const double reserved = stat(names_.partial.c_str(), &partial) == 0 ? static_cast<double>(partial.st_blocks) * 512 : 0;
    const std::size_t real_size = precision() == Precision::single ? sizeof(float) : sizeof(double);
    check_sweep_size(scene_, sweep_size(scene_, bytes_per_grip(variables_, scene_, real_size)),
                     free_bytes(names_.target) + reserved);
  }

  bool is_finished() const {
    struct stat file {};
    return options_.resume && stat(names_.partial.c_str(), &file) != 0 && stat(names_.result.c_str(), &file) == 0 &&
           S_ISREG(file.st_mode);
  }

  ExitCode run() {
    // a file that grows past its limit is an error of the write, not the end of the process
    std::signal(SIGXFSZ, SIG_IGN);
    // first, since it needs neither room nor a place to write to
    if (is_finished()) return finished();
    check();
    const OutputLock lock(names_.lock);
    if (is_finished()) return finished();  // by who had the lock until now
    if (parts_.prepare) parts_.prepare();
    if (options_.warn) options_.warn(scene_, precision());
    say_cavity_notes(scene_);
    const Plan plan(scene_, keeps_vectors(variables_));
    for (const std::string& line : idle_notes(scene_, plan, best_wanted_)) say_note(line);
    backend_ = parts_.open_backend(make_field_set(swept_fields(plan), scene_));
    evaluator_ = parts_.open_evaluator();
    std::vector<VesselFacts> facts = vessel_facts(scene_, *backend_, *evaluator_);
    if (!is_choosy() && !refines()) evaluator_.reset();
    fmt::print("{}{}", opening_lines(scene_, plan, backend_->info()), vessel_lines(scene_, facts));
    std::fflush(stdout);
    if (options_.explain) {
      fmt::print("{}", explain_sweep(scene_, plan, backend_->fields(), {options_.on, precision(), options_.threads, best_wanted_}));
      std::fflush(stdout);
    }
    const ResultContents contents{scene_, plan, variables_, std::move(facts), backend_->info(), version(), best_wanted_};
    const bool resumed = begin(plan);
    // An interrupt that comes while the file is laid out waits for the first grips. One that comes when all are done lets the ending finish, but for
    // robust scores.
    InterruptGuard interrupt;
    ResultFile file(names_, contents, backend_->fields(), resumed);
    is_marked_ = resumed;
    if (!repair(plan, file, interrupt) || !sweep(plan, file, interrupt)) return interrupted(plan);
    return finish(plan, file, interrupt) ? ExitCode::done : interrupted(plan);
  }

 private:
  // Whether the best grips have to differ.
  bool is_choosy() const { return best_wanted_ > 0 && scene_.output.apart > 0; }
  bool refines() const { return best_wanted_ > 0 && options_.refine; }
  // Grips of a list that one pass keeps.
  std::size_t pool(const Plan& plan) const {
    return options_.pool > 0 && is_choosy() ? options_.pool : usual_pool(plan, best_wanted_, scene_.output.apart);
  }
  bool ranks_here(const Plan& plan) const { return best_wanted_ > 0 && (is_choosy() || plan.hand_scales() > 1); }
  // What is read back: a device chooses a few of the best of all hands together. Of several hand scales, and where grips have to
  // differ, the scores are chosen from here.
  std::vector<int> swept_fields(const Plan& plan) const {
    const std::vector<int> kept = variable_fields(variables_);
    std::set<int> fields(kept.begin(), kept.end());
    if (ranks_here(plan)) fields.insert({FIELD_SCORE, FIELD_STATUS});
    return {fields.begin(), fields.end()};
  }

  bool has_field(int field) const { return is_kept(backend_->fields(), field); }
  bool has_heat_map() const { return has_score() && has_field(FIELD_SCORE) && has_field(FIELD_STATUS); }

  bool has_score() const {
    return std::any_of(variables_.begin(), variables_.end(), [](const Variable* v) { return v->field == FIELD_SCORE; });
  }

  ExitCode finished() const {
    check_complete(names_.result, scene_, options_.on == "core", precision(), variables_);
    say_note(fmt::format("{} is complete, so nothing is left to do; the same command without --resume computes it again",
                         names_.result));
    return ExitCode::done;
  }

  Precision precision() const { return options_.precision.value_or(options_.on == "core" ? Precision::full : Precision::single); }

  std::map<std::string, std::string> identity(const Plan& plan) const {
    return sweep_identity(scene_, plan, backend_->info(), best_wanted_, variables_);
  }

  // What a mark of this sweep can say at most.
  MarkBounds bounds(const Plan& plan) const {
    const bool has_stretches = !variables_.empty();
    return {scene_.vessels.size(),
            plan.grips(),
            (is_choosy() ? std::max(best_wanted_, pool(plan)) : best_wanted_) * plan.hand_scales(),
            is_choosy() ? plan.hand_scales() : 0,
            best_wanted_,
            has_stretches,
            has_stretches && has_field(FIELD_STATUS)};
  }

  // Sets the progress: from the mark of an earlier sweep if there is one to resume, else nothing done. True: resumed.
  bool begin(const Plan& plan) {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) maps_.emplace_back(plan);
    SweepMark mark;
    std::string line = options_.resume ? "" : lost_line(names_);
    if (options_.resume) announce_check();
    const bool resumed = options_.resume && load_usable_mark(names_, identity(plan), bounds(plan), mark, line);
    if (!line.empty()) say_note(line);
    if (resumed) {
      mark_ = mark;
      for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) maps_[v].restore(mark_.vessels[v].heat_map);
      say_note(fmt::format("continuing {}: {} of {} grips are there", names_.partial, readable_number(done()),
                           readable_number(total(plan))));
    } else {
      if (options_.resume) say_note(fmt::format("{} holds no complete grip: starting from the first grip", names_.partial));
      mark_.identity = identity(plan);
      mark_.vessels.resize(scene_.vessels.size());
    }
    wall_before_ = mark_.wall_seconds;
    return resumed;
  }

  // Before a file is read that takes long.
  void announce_check() const {
    struct stat file {};
    if (stat(names_.mark.c_str(), &file) != 0 || stat(names_.partial.c_str(), &file) != 0 || file.st_size <= LONG_CHECK) return;
    say_note(fmt::format("checking {} of {}", readable_bytes(static_cast<double>(file.st_size)), names_.partial));
  }

  std::uint64_t total(const Plan& plan) const { return plan.grips() * scene_.vessels.size(); }

  std::uint64_t done() const {
    std::uint64_t sum = 0;
    for (const VesselProgress& vessel : mark_.vessels) sum += vessel.done;
    return sum;
  }

  // Computes again what the file no longer holds as it was written. False: interrupted; the mark still stands.
  bool repair(const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      for (const Stretch& stretch : mark_.vessels[v].stretches) {
        if (interrupt.signalled()) return false;
        if (file.holds(v, stretch)) continue;
        const std::string place = fmt::format("{}: grips {} to {} of {}", names_.partial, readable_number(stretch.first),
                                              readable_number(stretch.last - 1), scene_.vessels[v].name);
        say_note(place + " are damaged: computing them again");
        if (!compute_again(v, stretch, plan, file, interrupt)) return false;
        if (!file.holds(v, stretch))
          throw failure_error(place + " have other values when computed again; start again without --resume");
      }
    }
    return true;
  }

  bool compute_again(std::size_t v, const Stretch& stretch, const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    RunRequest request = grips_of(v, plan, interrupt);
    request.first = stretch.first;
    request.last = stretch.last;
    request.sink = [&file](const PlaneChunk& chunk) { file.write(chunk); };
    const RunResult result = backend_->run(request);
    file.end_stretch();
    return result.done == stretch.last - stretch.first;
  }

  RunRequest grips_of(std::size_t v, const Plan& plan, InterruptGuard& interrupt) const {
    RunRequest request;
    request.vessel = v;
    request.stop = &interrupt.flag();
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
    return request;
  }

  // Every vessel from where it stands to its end. False: interrupted, everything done so far is marked.
  bool sweep(const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    Progress progress(total(plan), done());
    last_mark_ = monotonic_now();
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      forget(plan);
      while (mark_.vessels[v].done < plan.grips()) {
        run_stretch(v, plan, file, interrupt, progress);
        if (interrupt.signalled() && done() < total(plan)) {
          progress.clear();
          save(file);
          return false;
        }
        if (since(last_mark_) >= mark_interval_ && done() < total(plan)) save(file);
      }
      file.start_sync();
      progress.clear();
      if (is_choosy() && !choose(v, plan, file, interrupt)) return false;
    }
    return true;
  }

  // Grips of a vessel until its end, an interrupt, or the time for a progress mark.
  void run_stretch(std::size_t v, const Plan& plan, ResultFile& file, InterruptGuard& interrupt, Progress& progress) {
    VesselProgress& vessel = mark_.vessels[v];
    const std::uint64_t before = done();
    std::uint64_t delivered = 0;
    double sink_seconds = 0;
    RunRequest request = grips_of(v, plan, interrupt);
    request.first = vessel.done;
    request.last = plan.grips();
    HandLists best(plan, is_choosy() ? pool(plan) : best_wanted_, vessel.best);
    request.best = ranks_here(plan) ? 0 : best_wanted_;
    std::vector<Candidate> eligible;
    request.sink = [&](const PlaneChunk& chunk) {
      const double start = monotonic_now();
      file.write(chunk);
      count_grips(chunk, backend_->fields(), vessel.counts);
      if (ranks_here(plan)) best.offer(chunk, backend_->fields());
      if (!remembered_.empty()) {
        eligible.clear();
        add_eligible(chunk, backend_->fields(), eligible);
        remember(eligible, chunk.count);
      }
      if (has_heat_map()) maps_[v].add(plan, chunk, backend_->fields());
      delivered += chunk.count;
      progress.update(scene_.vessels[v].name, before + delivered);
      if (since(last_mark_) >= mark_interval_) interrupt.flag() = true;
      sink_seconds += since(start);
    };
    const double start = monotonic_now();
    const RunResult result = backend_->run(request);
    wait_seconds_ += since(start) - sink_seconds;
    interrupt.clear();
    // a backend that has nothing to hand over need not call the sink; one that has must hand over all of it
    if ((delivered != result.done && !(delivered == 0 && variables_.empty())) || (result.done == 0 && !interrupt.signalled())) {
      throw failure_error(fmt::format("{}: handed over {} of {} grips", backend_->info().device, delivered, result.done));
    }
    if (delivered == 0) vessel.counts.grips += result.done;
    best.offer(result.best);  // none where they were chosen here
    vessel.best = best.all();
    vessel.done += result.done;
    if (file.has_grips() && result.done > 0) {  // an interrupt may come before the first chunk
      const Stretch stretch = file.stretch();
      keep_stretch(vessel.stretches, stretch);
      if (stretch.last - stretch.first >= plan.grips() / MOST_STRETCHES) file.end_stretch();
    }
    kernel_seconds_ += result.kernel_seconds;
    mark_.kernel_seconds += result.kernel_seconds;
    say_once(result.notes, progress);
  }

  void say_once(const std::vector<std::string>& notes, Progress& progress) {
    for (const std::string& line : notes) {
      if (!said_.insert(line).second) continue;
      progress.clear();
      say_note(line);
    }
  }

  // The lists of a vessel whose grips were all computed, out of the best of them and in further passes over all where it takes
  // these. False: interrupted; the mark has what is decided.
  bool choose(std::size_t v, const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    VesselProgress& vessel = mark_.vessels[v];
    const bool is_first = vessel.lists.empty();
    ListChooser chooser(plan, evaluator_.get(), v, {best_wanted_, scene_.output.apart, pool(plan), options_.threads}, vessel.lists);
    if (is_first) {
      chooser.offer(vessel.best);
      end_pass(chooser, vessel);
    }
    while (!chooser.is_complete()) {
      const bool is_known = remembered_count_ == plan.grips();
      if (interrupt.signalled() || (!is_known && !pass_again(v, plan, chooser, interrupt))) {
        save(file);
        return false;
      }
      if (is_known) pass_remembered(chooser);
      end_pass(chooser, vessel);
      if (since(last_mark_) >= mark_interval_) save(file);
    }
    return true;
  }

  static void end_pass(ListChooser& chooser, VesselProgress& vessel) {
    chooser.end_pass();
    vessel.lists = chooser.progress();
    vessel.best = chooser.chosen();
  }

  // Room for the scores of the next vessel, if there are not too many.
  void forget(const Plan& plan) {
    const bool has_room = is_choosy() && plan.grips() <= options_.remembered;
    remembered_.assign(has_room ? static_cast<std::size_t>(plan.grips()) : 0, std::numeric_limits<double>::quiet_NaN());
    remembered_count_ = 0;
  }

  // Chunks come in ascending order; those from before an interrupt do not come again, and then a further pass does.
  void remember(const std::vector<Candidate>& eligible, std::size_t of_grips) {
    if (remembered_.empty()) return;
    for (const Candidate& grip : eligible) remembered_[static_cast<std::size_t>(grip.index)] = grip.score;
    remembered_count_ += of_grips;
  }

  // A further pass over scores that are known. An interrupt is looked at before the next one.
  void pass_remembered(ListChooser& chooser) const {
    constexpr std::size_t AT_ONCE = 1 << 16;
    std::vector<Candidate> eligible;
    for (std::size_t first = 0; first < remembered_.size(); first += AT_ONCE) {
      eligible.clear();
      for (std::size_t i = first; i < std::min(remembered_.size(), first + AT_ONCE); ++i)
        if (!std::isnan(remembered_[i])) eligible.push_back({remembered_[i], i});
      chooser.offer(eligible);
    }
  }

  // All grips of a vessel once more, for the chooser alone. False: interrupted.
  bool pass_again(std::size_t v, const Plan& plan, ListChooser& chooser, InterruptGuard& interrupt) {
    Progress progress(plan.grips(), 0);
    std::uint64_t delivered = 0;
    RunRequest request = grips_of(v, plan, interrupt);
    request.last = plan.grips();
    std::vector<Candidate> eligible;
    forget(plan);
    request.sink = [&](const PlaneChunk& chunk) {
      const double start = monotonic_now();
      eligible.clear();
      add_eligible(chunk, backend_->fields(), eligible);
      chooser.offer(eligible);
      remember(eligible, chunk.count);
      delivered += chunk.count;
      progress.update(scene_.vessels[v].name + ", again for different best grips", delivered);
      wait_seconds_ -= since(start);
    };
    const double start = monotonic_now();
    const RunResult result = backend_->run(request);
    wait_seconds_ += since(start);
    kernel_seconds_ += result.kernel_seconds;
    mark_.kernel_seconds += result.kernel_seconds;
    say_once(result.notes, progress);
    return result.done == plan.grips();
  }

  // Everything up to here onto the disk, then the mark that says so.
  void save(ResultFile& file) {
    const double start = monotonic_now();
    file.sync();
    file.vouch_for_structure(mark_);
    mark_.wall_seconds = wall_before_ + since(options_.started);
    for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) mark_.vessels[v].heat_map = maps_[v].scores();
    save_mark(names_.mark, mark_);
    is_marked_ = true;
    last_mark_ = monotonic_now();
    mark_interval_ = std::max(options_.mark_seconds, since(start) / MARK_SHARE);
  }

  ExitCode interrupted(const Plan& plan) const {
    say_note(fmt::format("interrupted at {} of {} grips; the same command with --resume goes on with {}", readable_number(done()),
                         readable_number(total(plan)), names_.partial));
    return ExitCode::interrupted;
  }

  // False: interrupted while the robust scores were computed, which may take as long as the sweep; the grips are marked.
  bool finish(const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    const CompanionRequest request{scene_, plan, names_, parts_, best_wanted_, options_.glb};
    auto best = best_grips(request, mark_.vessels, *backend_);
    if (refines()) refine_lists(*evaluator_, scene_, plan, options_.threads, best);
    if (!add_robust_scores(parts_.open_other, scene_, plan, &interrupt.flag(), best)) {
      save(file);
      return false;
    }
    std::vector<std::vector<RankedGrip>> ranked(best.size());
    for (std::size_t list = 0; list < best.size(); ++list) {
      for (const BestGrip& grip : best[list])
        ranked[list].push_back({grip.candidate, grip.grip, grip.refined, grip.refined_score, grip.robust_mean, grip.robust_low});
    }
    // the result's own name comes last: when it is there, all is
    std::vector<std::string> files = write_companions(request, best, has_heat_map() ? &maps_ : nullptr, backend_->info());
    // The values are synced first. Then little time passes between the ending, which no earlier mark fits, and the mark that vouches for it.
    if (is_marked_) save(file);
    file.write_ending(ranked, wall_before_ + since(options_.started), mark_.kernel_seconds);
    if (is_marked_) save(file);  // which now vouches for the ending, too
    file.finish();
    files.insert(files.begin(), names_.result);
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      const std::string counts = counts_line(mark_.vessels[v].counts, has_field(FIELD_STATUS), plan.copies());
      fmt::print("\n{}: {}\n{}", scene_.vessels[v].name, counts, best_lines(scene_, plan, v, best, names_.best));
    }
    // kernels that ran while the file was being written cost no time of their own
    const SweepTimes times{since(options_.started), std::min(wait_seconds_, kernel_seconds_), file.seconds(), file.bytes()};
    fmt::print("\n{}", closing_lines(files, times));
    return true;
  }

  const Scene& scene_;
  const SweepOptions& options_;
  const SweepParts& parts_;
  OutputNames names_;
  std::size_t best_wanted_;
  std::vector<const Variable*> variables_;
  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Evaluator> evaluator_;  // that poses and refines the best grips; null where neither is asked for
  std::vector<HeatMap> maps_;             // one per vessel
  SweepMark mark_;
  bool is_marked_ = false;  // there is a mark of this sweep
  double wall_before_ = 0;  // of earlier sessions, s
  double mark_interval_ = options_.mark_seconds;
  double last_mark_ = 0;     // s of the clock
  double wait_seconds_ = 0;  // in the backend, less what it spent in the sink
  double kernel_seconds_ = 0;
  std::set<std::string> said_;
  std::vector<double> remembered_;      // scores of the vessel under way; NaN: not eligible. Empty: not kept
  std::uint64_t remembered_count_ = 0;  // grips whose outcome is in there
};

}  // namespace

std::string default_output(const Scene& scene) {
  std::string stem = scene.file.substr(scene.file.rfind('/') + 1);
  if (stem.ends_with(".toml")) stem.resize(stem.size() - 5);
  return (stem.empty() ? "sweep" : stem) + ".nc";
}

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  const Precision precision = options.precision.value_or(options.on == "core" ? Precision::full : Precision::single);
  const SweepParts parts{
      [&](const FieldSet& fields) { return open_backend(scene, fields, options.on, precision, options.threads); },
      [&] { return make_core_evaluator(scene); },
      [&] { load_meshes(scene, [&] { return largest_buffer(options.on); }); },
      [&](const Scene& other, const FieldSet& fields) {
        return open_backend(other, fields, options.on, precision, options.threads);
      },
  };
  return run_sweep(scene, options, parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return Sweep(scene, options, parts).run();
}

}  // namespace wholehand
