#include "sweeps/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <set>

#include "core/prepare.h"
#include "sweeps/best.h"
#include "sweeps/best_glb.h"
#include "sweeps/build_id.h"
#include "sweeps/candidates.h"
#include "sweeps/closing.h"
#include "sweeps/domain.h"
#include "sweeps/explain.h"
#include "sweeps/heat_map_plot.h"
#include "sweeps/interrupt.h"
#include "sweeps/mesh_vessel.h"
#include "sweeps/open_backend.h"
#include "sweeps/progress.h"
#include "sweeps/readable.h"
#include "sweeps/result_file.h"
#include "sweeps/tally.h"

#ifndef WHOLEHAND_VERSION
#define WHOLEHAND_VERSION "unknown"
#endif

namespace wholehand {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t TABLE_ROWS = 20;  // best grips shown per vessel; the file has them all
constexpr double MARK_SHARE = 0.02;     // of the time, at most, for marks

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void note(const std::string& line) { fmt::print(stderr, "wholehand: {}\n", line); }

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
      throw usage_error(
          fmt::format("--glb {0}: the best {1} of each vessel are kept; ask for --best {0} too", options_.glb, best_wanted_));
    }
    check_not_the_scene(names_.result, scene_);
    check_overwrites_result(names_.result);
    struct stat partial {};
    const double reserved = stat(names_.partial.c_str(), &partial) == 0 ? static_cast<double>(partial.st_blocks) * 512 : 0;
    const std::size_t real_size = precision() == Precision::single ? sizeof(float) : sizeof(double);
    check_sweep_size(scene_, sweep_size(scene_, bytes_per_grip(variables_, scene_, real_size)),
                     free_bytes(names_.result) + reserved);
  }

  bool is_finished() const {
    struct stat file {};
    return options_.resume && stat(names_.partial.c_str(), &file) != 0 && stat(names_.result.c_str(), &file) == 0;
  }

  ExitCode run() {
    // a file that grows past its limit is an error of the write, not the end of the process
    std::signal(SIGXFSZ, SIG_IGN);
    check();
    if (is_finished()) {
      check_finished();
      note(
          fmt::format("{} is complete: nothing to go on with; the same command without --resume computes it again", names_.result));
      return ExitCode::done;
    }
    for (const std::string& line : domain_warnings(scene_, precision())) note(line);
    const Plan plan(scene_, keeps_vectors(variables_));
    backend_ = parts_.open_backend(make_field_set(variable_fields(variables_), scene_));
    fmt::print("{}", opening_lines(scene_, plan, backend_->info()));
    std::fflush(stdout);
    if (options_.explain) {
      fmt::print("{}", explain_sweep(scene_, plan, backend_->fields(), {options_.on, precision(), options_.threads}));
      std::fflush(stdout);
    }
    const ResultContents contents{scene_,           plan,
                                  variables_,       vessel_facts(scene_, *backend_, *parts_.open_evaluator()),
                                  backend_->info(), WHOLEHAND_VERSION,
                                  best_wanted_};
    const bool resumed = begin(plan);
    ResultFile file(names_, contents, backend_->fields(), resumed);
    InterruptGuard interrupt;  // an interrupt that comes when all grips are done lets the ending finish
    if (!sweep(plan, file, interrupt)) return interrupted(plan);
    finish(plan, file);
    return ExitCode::done;
  }

 private:
  bool has_field(int field) const { return is_kept(backend_->fields(), field); }
  bool has_heat_map() const { return has_field(FIELD_SCORE) && has_field(FIELD_STATUS); }

  // The file that is whole must be of this sweep, as far as that is known without a device.
  void check_finished() const {
    std::vector<std::string> names;
    for (const Variable* variable : variables_) names.push_back(variable->name);
    const FinishedResult there = read_finished(names_.result, names);
    const auto refuse = [this](const std::string& what) {
      throw usage_error(fmt::format("--resume: {} is complete, of another {}; name another file, or start again without --resume",
                                    names_.result, what));
    };
    if (there.scene != scene_.text) refuse("scene");
    if ((there.backend == "core") != (options_.on == "core")) refuse("backend: " + there.backend);
    if (there.precision != (precision() == Precision::single ? "float" : "double")) refuse("precision: " + there.precision);
    if (!there.missing.empty()) refuse("set of variables: it lacks " + there.missing.front());
  }

  Precision precision() const { return options_.precision.value_or(options_.on == "core" ? Precision::full : Precision::single); }

  // What must be the same for a sweep to go on where another one stopped.
  std::map<std::string, std::string> identity(const Plan& plan) const {
    const BackendInfo& info = backend_->info();
    std::vector<std::string> names;
    for (const Variable* variable : variables_) names.push_back(variable->name);
    return {{"scene", scene_.text},
            {"version", WHOLEHAND_VERSION},
            {"build", build_id()},  // other code may give other bits
            {"backend", info.backend},
            // the core gives the same on any number of threads
            {"device", info.backend == "core" ? "core" : info.device},
            {"driver", info.driver},
            {"precision", info.precision == Precision::single ? "float" : "double"},
            {"number of best grips", std::to_string(best_wanted_)},
            {"number of grips", fmt::format("{} x {} x {}", scene_.vessels.size(), plan.grips(), plan.copies())},
            {"set of meshes", mesh_keys(scene_)},
            {"set of variables", fmt::format("{}", fmt::join(names, " "))}};
  }

  // Sets the progress: from the mark of an earlier sweep if there is one to resume, else nothing done. True: resumed.
  bool begin(const Plan& plan) {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) maps_.emplace_back(plan);
    SweepMark mark;
    struct stat partial {};
    const bool resumed = options_.resume && stat(names_.partial.c_str(), &partial) == 0 && load_mark(names_.mark, mark);
    if (resumed) {
      check_identity(names_.partial, mark, identity(plan));
      if (mark.vessels.size() != scene_.vessels.size()) {
        throw failure_error(names_.mark + ": not of this sweep; start again without --resume");
      }
      mark_ = mark;
      for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) maps_[v].restore(mark_.vessels[v].heat_map);
      note(fmt::format("going on with {}: {} of {} grips are there", names_.partial, readable_number(done()),
                       readable_number(total(plan))));
    } else {
      if (options_.resume) note(fmt::format("nothing of {} is complete: starting from the first grip", names_.partial));
      if (!options_.resume) say_what_is_lost();
      mark_.identity = identity(plan);
      mark_.vessels.resize(scene_.vessels.size());
    }
    wall_before_ = mark_.wall_seconds;
    return resumed;
  }

  void say_what_is_lost() const {
    struct stat partial {};
    SweepMark earlier;
    try {
      if (stat(names_.partial.c_str(), &partial) != 0 || !load_mark(names_.mark, earlier)) return;
    } catch (const Error&) {
      return;  // nothing could have gone on from there
    }
    std::uint64_t kept = 0;
    for (const VesselProgress& vessel : earlier.vessels) kept += vessel.done;
    note(fmt::format("{} held {} grips of a sweep that was interrupted: begun again without them (--resume goes on)",
                     names_.partial, readable_number(kept)));
  }

  std::uint64_t total(const Plan& plan) const { return plan.grips() * scene_.vessels.size(); }

  std::uint64_t done() const {
    std::uint64_t sum = 0;
    for (const VesselProgress& vessel : mark_.vessels) sum += vessel.done;
    return sum;
  }

  // Every vessel from where it stands to its end. False: interrupted, everything done so far is marked.
  bool sweep(const Plan& plan, ResultFile& file, InterruptGuard& interrupt) {
    Progress progress(total(plan), done());
    last_mark_ = Clock::now();
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
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
    }
    return true;
  }

  // Grips of a vessel until its end, an interrupt, or the time for a progress mark.
  void run_stretch(std::size_t v, const Plan& plan, ResultFile& file, InterruptGuard& interrupt, Progress& progress) {
    VesselProgress& vessel = mark_.vessels[v];
    const std::uint64_t before = done();
    std::uint64_t delivered = 0;
    double sink_seconds = 0;
    RunRequest request;
    request.vessel = v;
    request.first = vessel.done;
    request.last = plan.grips();
    request.best = best_wanted_;
    request.stop = &interrupt.flag();
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
    request.sink = [&](const PlaneChunk& chunk) {
      const auto start = Clock::now();
      file.write(chunk);
      count_grips(chunk, backend_->fields(), vessel.counts);
      if (has_heat_map()) maps_[v].add(plan, chunk, backend_->fields());
      delivered += chunk.count;
      progress.update(scene_.vessels[v].name, before + delivered);
      if (since(last_mark_) >= mark_interval_) interrupt.flag() = true;
      sink_seconds += since(start);
    };
    const auto start = Clock::now();
    const RunResult result = backend_->run(request);
    wait_seconds_ += since(start) - sink_seconds;
    interrupt.clear();
    // a backend that has nothing to hand over need not call the sink; one that has must hand over all of it
    if ((delivered != result.done && !(delivered == 0 && variables_.empty())) || (result.done == 0 && !interrupt.signalled())) {
      throw failure_error(fmt::format("{}: handed over {} of {} grips", backend_->info().device, delivered, result.done));
    }
    if (delivered == 0) vessel.counts.grips += result.done;
    BestCandidates best(best_wanted_);
    best.offer(vessel.best);
    best.offer(result.best);
    vessel.best = best.sorted();
    vessel.done += result.done;
    kernel_seconds_ += result.kernel_seconds;
    mark_.kernel_seconds += result.kernel_seconds;
    for (const std::string& line : result.notes) {
      if (!said_.insert(line).second) continue;
      progress.clear();
      note(line);
    }
  }

  // Everything up to here onto the disk, then the mark that says so.
  void save(ResultFile& file) {
    const auto start = Clock::now();
    file.sync();
    mark_.wall_seconds = wall_before_ + since(options_.started);
    for (std::size_t v = 0; v < maps_.size() && has_heat_map(); ++v) mark_.vessels[v].heat_map = maps_[v].scores();
    save_mark(names_.mark, mark_);
    last_mark_ = Clock::now();
    mark_interval_ = std::max(options_.mark_seconds, since(start) / MARK_SHARE);
  }

  ExitCode interrupted(const Plan& plan) const {
    note(fmt::format("interrupted at {} of {} grips; the same command with --resume goes on with {}", readable_number(done()),
                     readable_number(total(plan)), names_.partial));
    return ExitCode::interrupted;
  }

  // The best grips with what is told of them; by a backend of their own where the sweep's does not read all of it back.
  std::vector<std::vector<BestGrip>> best_grips(const Plan& plan) {
    const std::vector<int> needed = best_fields(scene_);
    const bool any =
        std::any_of(mark_.vessels.begin(), mark_.vessels.end(), [](const VesselProgress& v) { return !v.best.empty(); });
    std::unique_ptr<Backend> other;
    if (any && !std::all_of(needed.begin(), needed.end(), [&](int field) { return has_field(field); })) {
      other = parts_.open_backend(make_field_set(needed, scene_));
    }
    std::vector<std::vector<BestGrip>> best;
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      best.push_back(evaluate_best(other ? *other : *backend_, scene_, plan, v, mark_.vessels[v].best));
    }
    return best;
  }

  // Draws the heat maps; returns their files.
  std::vector<std::string> draw_maps(const Plan& plan) const {
    if (!has_heat_map()) {
      note("no heat maps: the score is not kept ([output] keep)");
      return {};
    }
    const std::vector<HeatMapPicture> pictures = sweep_pictures(scene_, plan, maps_, names_);
    const std::string failure = draw_heat_maps(pictures);
    std::vector<std::string> files;
    if (failure.empty()) {
      for (const HeatMapPicture& picture : pictures) files.push_back(picture.file);
    } else {
      note(failure);
    }
    return files;
  }

  void finish(const Plan& plan, ResultFile& file) {
    const auto best = best_grips(plan);
    std::vector<std::vector<RankedGrip>> ranked(best.size());
    for (std::size_t v = 0; v < best.size(); ++v) {
      for (const BestGrip& grip : best[v]) ranked[v].push_back({grip.candidate, grip.grip});
    }
    // the result's own name comes last: when it is there, all is
    std::vector<std::string> files = draw_maps(plan);
    if (best_wanted_ > 0) {
      write_whole_file(names_.best, best_csv(scene_, best), false);
      files.insert(files.begin(), names_.best);
    } else {
      std::remove(names_.best.c_str());  // of the result that is replaced
    }
    if (options_.glb > 0) {
      const BestGlb written = write_best_glb(scene_, parts_.open_evaluator(), best, options_.glb, names_);
      files.insert(files.end(), written.files.begin(), written.files.end());
      for (const std::string& line : written.notes) note(line);
    }
    file.write_ending(ranked, wall_before_ + since(options_.started), mark_.kernel_seconds);
    file.finish();
    files.insert(files.begin(), names_.result);
    for (std::size_t v = 0; v < best.size(); ++v) {
      fmt::print("\n{}: {}\n", scene_.vessels[v].name,
                 counts_line(mark_.vessels[v].counts, has_field(FIELD_STATUS), plan.copies()));
      if (!best[v].empty()) fmt::print("{}", best_table(scene_, plan, best[v], TABLE_ROWS));
      if (best[v].size() > TABLE_ROWS) fmt::print("  .. {} more in {}\n", best[v].size() - TABLE_ROWS, names_.best);
    }
    // kernels that ran while the file was being written cost no time of their own
    const SweepTimes times{since(options_.started), std::min(wait_seconds_, kernel_seconds_), file.seconds(), file.bytes()};
    fmt::print("\n{}", closing_lines(files, times));
  }

  const Scene& scene_;
  const SweepOptions& options_;
  const SweepParts& parts_;
  OutputNames names_;
  std::size_t best_wanted_;
  std::vector<const Variable*> variables_;
  std::unique_ptr<Backend> backend_;
  std::vector<HeatMap> maps_;  // one per vessel
  SweepMark mark_;
  double wall_before_ = 0;  // of earlier sessions, s
  double mark_interval_ = options_.mark_seconds;
  Clock::time_point last_mark_;
  double wait_seconds_ = 0;  // in the backend, less what it spent in the sink
  double kernel_seconds_ = 0;
  std::set<std::string> said_;
};

}  // namespace

std::string default_output(const Scene& scene) {
  std::string stem = scene.file.substr(scene.file.rfind('/') + 1);
  if (stem.ends_with(".toml")) stem.resize(stem.size() - 5);
  return (stem.empty() ? "sweep" : stem) + ".nc";
}

ExitCode run_sweep(const Scene& given, const SweepOptions& options) {
  Scene scene = given;
  if (has_meshes(scene)) {  // what takes longer comes after what can be refused at once
    const SweepParts none;
    const Sweep unread(scene, options, none);
    unread.check();
    if (!unread.is_finished()) load_meshes(scene, options.on);
  }
  const Precision precision = options.precision.value_or(options.on == "core" ? Precision::full : Precision::single);
  const SweepParts parts{
      [&](const FieldSet& fields) { return open_backend(scene, fields, options.on, precision, options.threads); },
      [&] { return make_core_evaluator(scene); },
  };
  return run_sweep(scene, options, parts);
}

ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts) {
  return Sweep(scene, options, parts).run();
}

}  // namespace wholehand
