// SPDX-License-Identifier: MIT
#include "sweeps/run/sweep_state.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "base/system/clock.h"
#include "base/text/readable.h"
#include "shaders/layout.h"
#include "sweeps/run/resume.h"

namespace wholehand::sweeps {
namespace {

constexpr off_t LONG_CHECK = 1'000'000'000;  // bytes of a partial file: from here on a note says that they are read

}  // namespace

bool SweepState::begin() {
  const OutputNames& names = sweep_.names();
  const std::size_t vessels = sweep_.scene().vessels.size();
  for (std::size_t v = 0; v < vessels; ++v) maps_.emplace_back(sweep_.plan());
  const bool resume = sweep_.options().resume;
  std::string line = resume ? "" : lost_line(names);
  if (resume) announce_check();
  is_saved_ = resume && load_usable_mark(names, sweep_.identity(), bounds(), mark_, line);
  if (!line.empty()) sweep_.note(line);
  if (is_saved_) {
    for (std::size_t v = 0; v < vessels && sweep_.has_heat_map(); ++v) maps_[v].restore(mark_.vessels[v].heat_map);
    sweep_.note(fmt::format("continuing {}: {} of {}", names.partial, readable_number(done()),
                            counted(sweep_.total(), "grip is there", "grips are there")));
  } else {
    if (resume) sweep_.note(fmt::format("{} holds no complete grip: starting from the first grip", names.partial));
    mark_ = {};
    mark_.identity = sweep_.identity();
    mark_.vessels.resize(vessels);
  }
  wall_before_ = mark_.wall_seconds;
  return is_saved_;
}

// Before a file is read that takes long.
void SweepState::announce_check() const {
  const OutputNames& names = sweep_.names();
  struct stat file {};
  if (stat(names.mark.c_str(), &file) != 0 || stat(names.partial.c_str(), &file) != 0 || file.st_size <= LONG_CHECK) return;
  sweep_.note(fmt::format("checking {} of {}", readable_bytes(static_cast<double>(file.st_size)), names.partial));
}

// What a mark of this sweep can say at most.
MarkBounds SweepState::bounds() const {
  const std::size_t scales = sweep_.plan().hand_scales();
  const bool has_stretches = !sweep_.variables().empty();
  return {sweep_.scene().vessels.size(),
          sweep_.plan().grips(),
          std::max(sweep_.candidates(), sweep_.kept_best()) * scales,
          sweep_.needs_distinct_grips() ? scales : 0,
          sweep_.candidates(),
          has_stretches,
          has_stretches && sweep_.has_field(FIELD_STATUS)};
}

std::uint64_t SweepState::done() const {
  std::uint64_t sum = 0;
  for (const VesselProgress& vessel : mark_.vessels) sum += vessel.done;
  return sum;
}

bool SweepState::has_shards() const {
  for (const VesselProgress& vessel : mark_.vessels)
    for (const Stretch& stretch : vessel.stretches)
      if (!stretch.shard.empty()) return true;
  return false;
}

void SweepState::end_pass(std::size_t v, ListChooser& chooser, const ListChooser::PoseHands& pose) {
  chooser.end_pass(pose);
  mark_.vessels[v].lists = chooser.progress();
  mark_.vessels[v].best = chooser.chosen();
}

void SweepState::save(ResultFile& file) {
  file.sync();
  file.check_own();
  file.vouch_for_structure(mark_);
  mark_.wall_seconds = wall_seconds();
  for (std::size_t v = 0; v < maps_.size() && sweep_.has_heat_map(); ++v) mark_.vessels[v].heat_map = maps_[v].scores();
  save_mark(sweep_.names().mark, mark_);
  is_saved_ = true;
}

void SweepState::run_and_save_on_failure(ResultFile& file, const std::function<void()>& ending) {
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

ExitCode SweepState::interrupted() const {
  sweep_.note(fmt::format("interrupted at {} of {}; the same command with --resume goes on with {}", readable_number(done()),
                          counted(sweep_.total(), "grip"), sweep_.names().partial));
  return ExitCode::interrupted;
}

RunResult SweepState::run(RunRequest request) {
  double sink_seconds = 0;
  request.sink = [&, sink = std::move(request.sink)](const PlaneChunk& chunk) {
    const double start = monotonic_now();
    sink(chunk);
    sink_seconds += monotonic_now() - start;
  };
  const double start = monotonic_now();
  RunResult result = sweep_.backend().run(request);
  wait_seconds_ += monotonic_now() - start - sink_seconds;
  kernel_seconds_ += result.kernel_seconds;
  mark_.kernel_seconds += result.kernel_seconds;
  return result;
}

double SweepState::wall_seconds() const { return wall_before_ + (monotonic_now() - sweep_.options().started); }
double SweepState::awaited_kernels() const { return std::min(wait_seconds_, kernel_seconds_); }

void SweepState::note_once(const std::vector<std::string>& notes, Progress* progress) {
  for (const std::string& line : notes) {
    if (!noted_.insert(line).second) continue;
    if (progress) progress->clear();
    sweep_.note(line);
  }
}

}  // namespace wholehand::sweeps
