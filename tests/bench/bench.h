// SPDX-License-Identifier: MIT
// What the benchmarks share. One executable, `./wholehand bench`, made of a file a topic; each figure is a ratio within one run.
#pragma once

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"
#include "core/scene.h"
#include "sweeps/plan/plan.h"

namespace wholehand::bench {

// What the command line says.
struct Options {
  std::string device = "vulkan";  // --on
  std::string roofline;           // --roofline: where its table is written; empty: nowhere
};

struct Figure {
  double microseconds = 0;  // a grip, step or other item; this and the ratio as the median where there are repetitions
  double ratio = 0;         // over what it was measured in turns with; 0: nothing
  double hash = 0;          // of the results, 52 bits; 0: none
};

// Prints the table of Google Benchmark and keeps every figure for the ratios after it.
class Figures : public benchmark::ConsoleReporter {
 public:
  Figures() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_ColorTabular : OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override;
  std::map<std::string, Figure> figures;
};

// Each file registers what it measures; `options` must outlive the run.
void add_grip_benchmarks(const Options& options);
void print_grip_ratios(const Figures& figures);
void add_effort_benchmarks(const Options& options);
void add_lattice_benchmarks(const Options& options);
void add_mesh_benchmarks();
void add_image_benchmarks(const Options& options);
void add_library_benchmarks();
inline constexpr const char* ROOFLINE = "roofline";  // a benchmark that is no figure: it has a table of its own
void add_roofline(const Options& options);
void finish_roofline(const Options& options);  // prints and writes its table, where it ran

// ---- grips ----

// The default scene's grips alone (closure, projection and contact), or with its fills and tilts, at so many heights.
Scene grips_scene(int heights);
Scene whole_scene(int heights);

std::unique_ptr<Evaluator> core_of(const Scene& scene, Precision precision);

// Planes of which a sweep keeps all but the hand's shapes.
extern const std::vector<int> KEPT;

// All grips of a vessel; `plan` must outlive it.
RunRequest request_of(const sweeps::Plan& plan, std::size_t vessel);
// All grips of the plan through a backend; returns their number.
std::uint64_t run_all(Backend& backend, const Scene& scene, const sweeps::Plan& plan);
// Over the masks of a full run, whatever its chunks: two lines with one hash found the same contacts. 52 bits.
double hash_all(Backend& backend, const Scene& scene, const sweeps::Plan& plan);

}  // namespace wholehand::bench
