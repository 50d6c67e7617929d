// SPDX-License-Identifier: MIT
#include "tests/scale/simulated_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/numbers/random_bits.h"
#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "tests/scale/machine.h"

namespace wholehand::scale {
namespace {

constexpr double SURE = 1.1;  // so many times the grips that get into a list on average

// Time passes as the chunks of a real backend are computed and written: the next chunk is computed while this one is written, and a chunk is
// handed over when it is written. The sink gets chunks of no grips. So it looks for reports and marks as it does in a real sweep, and
// there is nothing for it to keep.
class SimulatedBackend final : public Backend {
 public:
  explicit SimulatedBackend(const FieldSet& fields) : fields_(fields) {
    info_ = {"core", "simulated", "SimGrid", Precision::full, true};
  }
  const BackendInfo& info() const override { return info_; }
  const FieldSet& fields() const override { return fields_; }
  std::vector<LiquidResult> liquid(std::size_t) override { return {}; }

  RunResult run(const RunRequest& request) override {
    charge_mark();
    RunResult result;
    if (request.best == 0) {  // the grips that are listed: the ending, which costs next to nothing
      result.done = request.last - request.first;
      return result;
    }
    const Machine& machine = simulation().job.machine;
    Outcome& outcome = simulation().outcome;
    const int rank = own_rank();
    const double rate = machine.rate * (rank == machine.straggler ? machine.straggler_speed : 1);
    const double seconds = rank == 0 ? machine.leader_chunk : machine.chunk_seconds;
    const auto chunk = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(rate * seconds));
    double computed = now();
    std::array<double, 2> written{computed, computed};  // the last chunk but one, and the last
    for (std::uint64_t first = request.first; first < request.last; first += chunk) {
      const std::uint64_t count = std::min(chunk, request.last - first);
      computed = std::max(computed, written[0]) + static_cast<double>(count) / rate;
      sleep_until(std::max(computed, written[1]));
      const double start = now();
      written = {written[1], write(rank, static_cast<double>(count) * machine.bytes_per_grip)};
      sleep_until(written[1]);
      outcome.write_wait += now() - start;
      result.done += count;
      ++result.chunks;
      if (std::exchange(is_first_, false)) outcome.first_chunk = std::max(outcome.first_chunk, now());
      if (request.sink) {
        PlaneChunk nothing;
        nothing.vessel = request.vessel;
        nothing.first = first;
        request.sink(nothing);
      }
      // at once: the flag is one for all ranks of this process, and no other rank runs between the sink and here
      if (request.stop && request.stop->load()) break;
    }
    outcome.last_chunk = std::max(outcome.last_chunk, now());
    outcome.grips += result.done;
    ++simulation().pieces;
    result.best = best_of(request.first, result.done, request.best);
    return result;
  }

 private:
  static double write(int rank, double bytes) {
    if (bytes <= 0) return now();
    Simulation& all = simulation();
    all.outcome.written += bytes;
    const double by_node = all.nodes[static_cast<std::size_t>(node_of(rank))].serve(now(), bytes / all.job.machine.node_bandwidth);
    return std::max(by_node, all.files.serve(now(), bytes / all.job.machine.write_bandwidth));
  }

  // Scores are uniform in (0, 1); these are the best that may get into a list of `size` after all that this rank has had.
  std::vector<Candidate> best_of(std::uint64_t first, std::uint64_t done, std::size_t size) {
    std::vector<Candidate> best;
    const double count = static_cast<double>(done) / ENTRY_WEIGHT;
    seen_ += count;
    const double least = 1 - std::min(1.0, SURE * static_cast<double>(size) / seen_);
    double score = 1;
    for (std::uint64_t k = 0; k < size && static_cast<double>(k) < count; ++k) {
      score += std::log(random_unit(first, k)) / count;  // the gaps between the best of many are exponential
      if (score < least) break;
      best.push_back({score, first + k});
    }
    return best;
  }

  static double random_unit(std::uint64_t first, std::uint64_t k) {
    std::uint64_t bits = first * 0x9E3779B97F4A7C15ULL + k + 1;  // splitmix64
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBULL;
    return (static_cast<double>((bits ^ (bits >> 31)) >> 11) + 0.5) * 0x1p-53;
  }

  FieldSet fields_;
  BackendInfo info_;
  double seen_ = 0;  // grips that may get into a list
  bool is_first_ = true;
};

// One evaluator for all ranks of the process.
class SharedEvaluator final : public Evaluator {
 public:
  explicit SharedEvaluator(std::shared_ptr<const Evaluator> all) : all_(std::move(all)) {}
  void grip(std::size_t vessel, const GripInput& grip, GripResult& result) const override { all_->grip(vessel, grip, result); }
  LiquidResult liquid(std::size_t vessel, double fill, double tilt) const override { return all_->liquid(vessel, fill, tilt); }
  StateResult state(std::size_t vessel, const GripInput& grip, const GripResult& result, const LiquidResult& liquid, double tilt,
                    double opening) const override {
    return all_->state(vessel, grip, result, liquid, tilt, opening);
  }
  GripScore score(std::size_t vessel, const GripInput& grip, const GripResult& result) const override {
    return all_->score(vessel, grip, result);
  }
  void planes(std::size_t vessel, const GripInput* grips, std::size_t count, const FieldSet& fields, std::size_t stride,
              double* reals, std::uint32_t* uints, double least_score) const override {
    all_->planes(vessel, grips, count, fields, stride, reals, uints, least_score);
  }
  double distance(std::size_t vessel, const Triple& point) const override { return all_->distance(vessel, point); }
  Triple gradient(std::size_t vessel, const Triple& point) const override { return all_->gradient(vessel, point); }
  VesselConstants constants(std::size_t vessel) const override { return all_->constants(vessel); }
  double pouring_tilt(std::size_t vessel, double fill) const override { return all_->pouring_tilt(vessel, fill); }
  double gap_at(double closure) const override { return all_->gap_at(closure); }

 private:
  std::shared_ptr<const Evaluator> all_;
};

// The file of one rank. Its values are written by the backend.
class SimulatedFile final : public sweeps::OutputBytes {
 public:
  SimulatedFile() { sleep_until(simulation().opens.serve(now(), 1 / simulation().job.machine.opens)); }
  int write(const void*, std::size_t, std::uint64_t) override { return 0; }
  int sync() override {
    charge_mark();
    sleep_until(now() + simulation().job.machine.sync_seconds);
    return 0;
  }
};

}  // namespace

Scene simulated_scene(std::uint64_t grips, int entries) {
  std::array<std::uint64_t, 4> counts{1, 1, 1, 1};
  std::uint64_t left = grips;
  for (std::uint64_t& count : counts) {
    for (count = std::min<std::uint64_t>(left, 1000); left % count != 0;) --count;
    left /= count;
  }
  if (left != 1) throw std::runtime_error(fmt::format("{} grips are no product of four numbers up to 1000", grips));
  const auto axis = [](double from, double to, std::uint64_t count) {
    return count == 1 ? fmt::format("{}", from) : fmt::format("{{ from = {}, to = {}, count = {} }}", from, to, count);
  };
  return parse_scene(
      fmt::format(R"(
[[vessel]]
name = "cup"
shape = "cylinder"
diameter_mm = 70
height_mm = 110
wall_mm = 1.5
[output]
keep = []
best = {}
apart_mm = 0
[grips]
height_fraction = {}
roll_deg = {}
obliquity_deg = {}
offset_mm = {}
)",
                  entries, axis(0.1, 0.9, counts[0]), axis(-90, 30, counts[1]), axis(-15, 20, counts[2]), axis(-5, 5, counts[3])),
      "simulated.toml");
}

sweeps::SweepParts simulated_parts(const Scene& scene) {
  static const std::shared_ptr<const Evaluator> evaluator = make_core_evaluator(scene);
  sweeps::SweepParts parts;
  parts.prepare = [](const sweeps::BackendChoice& choice) {
    sleep_until(simulation().opens.serve(now(), 1 / simulation().job.machine.opens));  // the scene file
    sleep_until(now() + simulation().job.machine.open_seconds);
    return choice;
  };
  parts.open_backend = [](const sweeps::BackendChoice&, const FieldSet& fields) {
    return std::make_unique<SimulatedBackend>(fields);
  };
  parts.open_evaluator = [] { return std::make_unique<SharedEvaluator>(evaluator); };
  parts.open_core = [](const Scene&, const FieldSet& fields) { return std::make_unique<SimulatedBackend>(fields); };
  parts.open_output = [](const std::string&) { return std::make_unique<SimulatedFile>(); };
  return parts;
}

}  // namespace wholehand::scale
