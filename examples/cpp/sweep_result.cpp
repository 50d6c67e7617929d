// SPDX-License-Identifier: MIT
// sweeps/result/sweep_result.h: a result file, read back. Run the example run first, which writes swept.nc.
#include <cstdio>
#include <vector>

#include "core/reader/reader.h"
#include "sweeps/result/sweep_result.h"

int main() {
  using namespace wholehand;
  sweeps::SweepResult result("swept.nc");
  const Scene scene = parse_scene(result.origin().scene, "swept.nc");  // the file has the scene's text
  const sweeps::Plan plan(scene, false);
  result.use(scene, plan);
  std::vector<double> scores(plan.stored_grips());
  result.read(*result.find("score"), 0, 0, 0, scores.size(), scores.data());
  const std::vector<Candidate> best = result.best(0);
  for (const Candidate& grip : best)
    std::printf("grip %llu: score %.3f\n", static_cast<unsigned long long>(grip.index), grip.score);
  // grips are stored with every azimuth, the slowest axis, and evaluated with the first: their numbers agree there
  return !best.empty() && scores.at(best[0].index) == best[0].score ? 0 : 1;
}
