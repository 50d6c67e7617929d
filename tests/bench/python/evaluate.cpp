// SPDX-License-Identifier: MIT
// What the C++ call costs that wh.evaluate makes: the same grips, variables and device, into memory of its own.
//   wholehand_evaluate SCENE VESSEL VARIABLE,.. GRIPS.f64
// GRIPS.f64: rows of six doubles. Each line on standard input starts a run, which prints its seconds of wall and of CPU, and the sum
// of all numbers that are finite.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/system/clock.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/open_backend.h"
#include "sweeps/plan/variables.h"
#include "tests/bench/cost.h"

namespace wholehand {
namespace {

std::vector<double> read_doubles(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<double> numbers(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  return numbers;
}

// Reals of every variable, grip by grip.
void run(Backend& backend, const std::vector<const sweeps::Variable*>& variables, const Scene& scene, std::size_t vessel,
         const std::vector<double>& grips) {
  const std::size_t count = grips.size() / 6;
  const double wall = monotonic_now(), cpu = bench::processor_seconds();
  std::vector<std::vector<double>> values;
  for (const sweeps::Variable* variable : variables) values.emplace_back(count * variable_planes(*variable, scene));
  RunRequest request;
  request.vessel = vessel;
  request.last = count;
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t size, GripInput* out) {
    const double* row = grips.data() + 6 * first;
    for (std::size_t i = 0; i < size; ++i, row += 6) out[i] = {row[0], row[1], row[2], row[3], row[4], row[5]};
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t k = 0; k < variables.size(); ++k) {
      const std::size_t planes = values[k].size() / count;
      const int first = backend.fields().plane[static_cast<std::size_t>(variables[k]->field)] + variables[k]->plane;
      for (std::size_t p = 0; p < planes; ++p)
        for (std::size_t i = 0; i < chunk.count; ++i)
          values[k][(chunk.first + i) * planes + p] = chunk.real(first + static_cast<int>(p), i);
    }
  };
  backend.run(request);
  const double wall_taken = monotonic_now() - wall, cpu_taken = bench::processor_seconds() - cpu;
  double sum = 0;
  for (const auto& of : values)
    for (const double value : of) sum += std::isfinite(value) ? value : 0;
  std::printf("%.6f %.6f %.17g\n", wall_taken, cpu_taken, sum);
  std::fflush(stdout);
}

}  // namespace
}  // namespace wholehand

int main(int, char** argv) {
  using namespace wholehand;
  Scene scene = read_scene_file(find_scene(argv[1]));
  std::size_t vessel = 0;
  while (scene.vessels[vessel].name != argv[2]) ++vessel;
  scene.output.keep.emplace();
  std::istringstream names(argv[3]);
  for (std::string name; std::getline(names, name, ',');) scene.output.keep->push_back(name);
  const std::vector<const sweeps::Variable*> variables = sweeps::choose_variables(scene);
  const auto backend = open_backend(scene, make_field_set(sweeps::variable_fields(variables), scene), "core", Precision::full, 0);
  const std::vector<double> grips = read_doubles(argv[4]);
  // each run when a line comes in, so that both sides take turns
  for (int c = std::getchar(); c != EOF; c = std::getchar())
    if (c == '\n') run(*backend, variables, scene, vessel, grips);
}
