// SPDX-License-Identifier: MIT
#include "sweeps/run/sweep.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "base/files/files.h"
#include "base/system/clock.h"
#include "base/system/output.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "core/tolerances.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/cavity_notes.h"
#include "sweeps/plan/idle_notes.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/companions.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/closing.h"
#include "sweeps/run/explain.h"
#include "sweeps/run/resume.h"

namespace wholehand::sweeps {

Sweep::Sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts,
             std::string rank_prefix)
    : scene_(scene),
      options_(options),
      choice_(choice),
      parts_(parts),
      rank_prefix_(std::move(rank_prefix)),
      names_(output_names(options.output.empty() ? default_output(scene) : options.output)),
      best_wanted_(static_cast<std::size_t>(std::max(0, options.best.value_or(scene.output.best)))),
      by_(read_rank_by(options.rank_by, scene)),
      variables_(choose_variables(scene)) {}

bool Sweep::is_already_complete() const {
  struct stat file {};
  return options_.resume && stat(names_.partial.c_str(), &file) != 0 && stat(names_.result.c_str(), &file) == 0 &&
         S_ISREG(file.st_mode);
}

ExitCode Sweep::report_already_complete() const {
  check_complete(names_.result, scene_, choice_.on == "core", choice_.precision, variables_);
  note(fmt::format("{} is complete, so nothing is left to do; the same command without --resume computes it again{}", names_.result,
                   has_usual_order() ? ""
                                     : fmt::format(", and `wholehand rank {} --rank-by {}` lists its grips",
                                                   one_line(names_.result), options_.rank_by)));
  return ExitCode::done;
}

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

void Sweep::open() {
  const Precision asked = choice_.precision;
  if (parts_.prepare) choice_ = parts_.prepare(choice_);
  plan_.emplace(scene_, keeps_vectors(variables_));
  const FieldSet fields = make_field_set(swept_fields(), scene_);
  choice_ = with_core_fallback(choice_, options_.hooks,
                               [&](const BackendChoice& choice) { backend_ = parts_.open_backend(choice, fields); });
  if (choice_.precision != asked) check_room();  // on the core instead of the device: doubles
  info_ = identified_ = backend_->info();
  evaluator_ = parts_.open_evaluator();
  facts_ = vessel_facts(scene_, *backend_, *evaluator_);
  if (!needs_distinct_grips() && !refines()) evaluator_.reset();
}

void Sweep::name_devices(const std::string& devices, const std::string& kinds, const std::string& drivers) {
  info_.device = devices;
  identified_.device = kinds;
  info_.driver = identified_.driver = drivers;
}

void Sweep::print_header() const {
  if (options_.hooks.warn) options_.hooks.warn(scene_, choice_.precision);
  for (const std::string& line : cavity_notes(scene_)) note(line);
  for (const std::string& line : idle_notes(scene_, plan(), best_wanted_)) note(line);
  print_text(opening_lines(scene_, plan(), info_) + vessel_lines(scene_, facts_) + unjudged_note(scene_, plan()));
  if (!options_.explain) return;
  print_text(explain_sweep(scene_, plan(), fields(), {choice_.on, choice_.precision, options_.threads, best_wanted_}));
}

void Sweep::note(const std::string& line) const { is_quiet() ? options_.hooks.note(line) : print_note(line); }

void Sweep::print_text(const std::string& text) const {
  if (!is_quiet()) print(text);
}

bool Sweep::has_usual_order() const { return by_ == usual_order(scene_); }
bool Sweep::needs_distinct_grips() const { return best_wanted_ > 0 && scene_.output.apart > 0; }
bool Sweep::refines() const { return best_wanted_ > 0 && options_.refine; }
std::size_t Sweep::candidates() const { return robust_candidates(scene_, best_wanted_); }
bool Sweep::is_asked_to_end(InterruptGuard& interrupt) const { return interrupt.signalled() || is_time_up(); }
bool Sweep::is_time_up() const { return options_.time_limit > 0 && monotonic_now() - options_.started >= options_.time_limit; }

std::uint64_t Sweep::total() const { return plan().grips() * scene_.vessels.size(); }
bool Sweep::has_field(int field) const { return is_kept(fields(), field); }
bool Sweep::has_heat_map() const { return has_score() && has_field(FIELD_SCORE) && has_field(FIELD_STATUS); }
bool Sweep::ranks_here() const { return best_wanted_ > 0 && (needs_distinct_grips() || plan().hand_scales() > 1); }
double Sweep::gate(std::size_t v) const { return gate_tolerance(scene_, facts_[v].empty_mass); }
std::size_t Sweep::pool() const {
  const std::size_t asked = options_.tuning.pool;
  return asked > 0 && needs_distinct_grips() ? asked : usual_pool(plan(), candidates(), scene_.output.apart);
}
std::size_t Sweep::kept_best() const { return needs_distinct_grips() ? pool() : candidates(); }
ListRequest Sweep::list_request() const { return {candidates(), scene_.output.apart, pool(), options_.threads}; }
ResultContents Sweep::contents() const { return {scene_, plan(), variables_, facts_, info_, version(), best_wanted_}; }

std::map<std::string, std::string> Sweep::identity() const {
  auto identity = sweep_identity(scene_, plan(), identified_, best_wanted_, variables_);
  identity["set of files"] = options_.shards ? "shards" : "one file";
  return identity;
}

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

bool Sweep::has_score() const {
  return std::any_of(variables_.begin(), variables_.end(), [](const Variable* v) { return v->field == FIELD_SCORE; });
}

RunRequest Sweep::grips_of(std::size_t v, std::uint64_t first, std::uint64_t last, InterruptGuard& interrupt) const {
  RunRequest request;
  request.vessel = v;
  request.first = first;
  request.last = last;
  request.stop = &interrupt.flag();
  request.grips = [&plan = plan()](std::size_t w, std::uint64_t from, std::size_t count, GripInput* out) {
    plan.fill(w, from, count, out);
  };
  return request;
}

void Sweep::check_delivered(const RunResult& result, std::uint64_t delivered, bool may_end) const {
  const bool is_all = delivered == result.done || (delivered == 0 && variables_.empty());
  if (is_all && (result.done > 0 || may_end)) return;
  throw failure_error(fmt::format("{}: handed over {} of {} grips", backend_->info().device, readable_number(delivered),
                                  readable_number(result.done)));
}

bool Sweep::repair_stretch(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) const {
  if (is_asked_to_end(interrupt)) return false;
  if (file.holds(v, stretch)) return true;
  note(fmt::format("{}{}: {} are damaged: computing them again", rank_prefix_, file.path(), readable_stretch(stretch, v)));
  return restore_stretch(v, stretch, file, interrupt);
}

bool Sweep::restore_stretch(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) const {
  if (is_asked_to_end(interrupt)) return false;
  RunRequest request = grips_of(v, stretch.first, stretch.last, interrupt);
  request.sink = [&](const PlaneChunk& chunk) {
    file.write(chunk);
    if (is_time_up()) interrupt.flag() = true;
  };
  const RunResult result = backend_->run(request);
  file.end_stretch();
  if (result.done != stretch.last - stretch.first) return false;
  if (file.holds(v, stretch)) return true;
  throw failure_error(fmt::format("{}: {} have other values when computed again; start again without --resume", file.path(),
                                  readable_stretch(stretch, v)));
}

std::string Sweep::readable_stretch(const Stretch& stretch, std::size_t v) const {
  return fmt::format("grips {} to {} of {}", readable_number(stretch.first), readable_number(stretch.last - 1),
                     scene_.vessels[v].name);
}

}  // namespace wholehand::sweeps
