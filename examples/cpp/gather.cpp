// SPDX-License-Identifier: MIT
// core/gather.h: every number of some grips in one place, from any backend.
#include <cstdio>
#include <vector>

#include "core/gather.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"

int main() {
  using namespace wholehand;
  const Scene scene = read_scene_file(find_scene("small"));
  const auto evaluator = make_core_evaluator(scene);
  std::vector<GripInput> grips(3);
  for (std::size_t i = 0; i < grips.size(); ++i) grips[i].height = 30e-3 + 15e-3 * static_cast<double>(i);

  const GatheredPlanes all = gather(*evaluator, all_fields(scene), 0, grips);
  bool are_same = true;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    GripResult result;
    evaluator->grip(0, grips[i], result);
    const double closure = all.real(all.fields.plane[FIELD_CLOSURE], i);
    std::printf("height %.0f mm: closure %.4f\n", grips[i].height * 1e3, closure);
    are_same = are_same && closure == result.closure;
  }
  return are_same ? 0 : 1;
}
