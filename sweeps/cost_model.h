// SPDX-License-Identifier: MIT
// Which of core and device ends a sweep sooner, by what earlier sweeps took. Formulas and reasons: docs/method.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// Properties of a sweep that change the cost of a grip. For meshes, only whether there is one.
struct SweepTask {
  std::uint64_t grips = 0;  // evaluated, of all vessels
  bool has_efforts = false, has_mesh = false, is_robust = false;
  bool has_reserves = false;  // tips_worst_effort, push or friction_needed of every grip
  int between = 0;            // spheres on each bone
  std::size_t states = 0;
  int threads = 1;
  std::string precision;  // "float", "double", or "" for what is usual where it runs
};

SweepTask sweep_task(const Scene& scene, std::uint64_t grips, int threads, const std::string& precision);

// All but the grips, in a line: runs with the same text are compared. States count by powers of two.
std::string kind_of(const SweepTask& task);

// A sweep that ended.
struct RunTime {
  std::string machine, kind;  // see kind_of
  std::string device;         // its name; "core"
  std::uint64_t number = 0;   // of the runs of this kind on this machine
  std::uint64_t grips = 0;
  double fixed = 0;    // s, all but what follows
  double growing = 0;  // s, kernels and writing, which grow with the grips
};

// What a sweep is expected to take: fixed, and for each grip, s.
struct CostEstimate {
  double fixed = 0, per_grip = 0;
  int runs = 0;           // it rests on; 0: a first guess
  std::uint64_t age = 0;  // runs of this kind since the last of them, or all there were
  std::string device;     // where they ran; "" where that is not known
  double seconds(std::uint64_t grips) const { return fixed + per_grip * static_cast<double>(grips); }
};

constexpr int COUNTED_RUNS = 4;            // the newest, of each kind and place
constexpr std::uint64_t RUNS_TO_OLD = 20;  // of the kind, after which an estimate is tried again
constexpr double WORTH_A_TRY = 2;          // times the better estimate, at most
constexpr double QUICK_CORE = 0.25;        // s: less than a device takes to open

// From the runs of this kind on this machine, on the core or on a device. The least of the last COUNTED_RUNS counts, for so many
// grips: what took longer compiled kernels, or shared its processors with other work. Runs of an eighth of the grips or more count before
// shorter ones, of which a grip is never expected to take more than by `guess`. `guess` where there is none.
CostEstimate estimate(std::span<const RunTime> history, const std::string& machine, const SweepTask& task, bool on_core,
                      const CostEstimate& guess);

// What is expected of a machine like the one of docs/results, where nothing was run yet.
CostEstimate guess_core(const SweepTask& task);
CostEstimate guess_device(const SweepTask& task, bool is_cpu);

// Where one of the two is a guess and the other took longer than guessed, this machine is slower than that of the guesses, or has other
// work: the guess grows by as much.
void scale_guess(const SweepTask& task, CostEstimate& core, CostEstimate& device);

struct BackendChoice {
  bool on_device = false;
  bool is_trial = false;  // not what is expected to end sooner, but what was not tried for long
};

BackendChoice choose_backend(const SweepTask& task, const CostEstimate& core, const CostEstimate& device);

// "core: 0.3 s expected, 0.6 s on llvmpipe", with what the user should know of the numbers.
std::string choice_line(const SweepTask& task, const BackendChoice& choice, const CostEstimate& core, const CostEstimate& device);

// Adds a run, numbers it, and forgets those that no estimate counts. Runs of another device on the same machine are forgotten, too.
void add_run(std::vector<RunTime>& history, RunTime run);

}  // namespace wholehand
