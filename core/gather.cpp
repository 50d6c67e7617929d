// SPDX-License-Identifier: MIT
#include "core/gather.h"

#include <algorithm>
#include <numeric>

#include "base/numbers/parallel.h"
#include "core/scene.h"

namespace wholehand {

FieldSet all_fields(const Scene& scene) {
  std::vector<int> every(FIELDS);
  std::iota(every.begin(), every.end(), 0);
  return make_field_set(every, scene);
}

GatheredPlanes gather(Backend& backend, std::size_t vessel, const std::vector<GripInput>& grips) {
  GatheredPlanes planes;
  planes.fields = backend.fields();
  planes.count = grips.size();
  planes.reals.resize(planes.fields.real_kept * grips.size());
  planes.uints.resize(planes.fields.uint_kept * grips.size());
  RunRequest request;
  request.vessel = vessel;
  request.last = grips.size();
  request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (int p = 0; p < planes.fields.real_kept; ++p)
      for (std::size_t i = 0; i < chunk.count; ++i) planes.reals[p * planes.count + chunk.first + i] = chunk.real(p, i);
    for (int p = 0; p < planes.fields.uint_kept; ++p)
      for (std::size_t i = 0; i < chunk.count; ++i) planes.uints[p * planes.count + chunk.first + i] = chunk.uint(p, i);
  };
  backend.run(request);
  return planes;
}

GatheredPlanes gather(const Evaluator& core, const FieldSet& fields, std::size_t vessel, const std::vector<GripInput>& grips) {
  GatheredPlanes planes;
  planes.fields = fields;
  planes.count = grips.size();
  planes.reals.resize(fields.real_planes * grips.size());
  planes.uints.resize(fields.uint_planes * grips.size());
  constexpr std::size_t TOGETHER = 64;  // by one thread, before it takes the next
  in_parallel((planes.count + TOGETHER - 1) / TOGETHER, 0, [&](std::size_t part) {
    const std::size_t first = part * TOGETHER, count = std::min(TOGETHER, planes.count - first);
    core.planes(vessel, grips.data() + first, count, fields, planes.count, planes.reals.data() + first,
                planes.uints.data() + first);
  });
  return planes;
}

std::vector<LiquidResult> core_liquid(const Scene& scene, const Evaluator& core, std::size_t vessel) {
  if (!scene.liquid) return {};
  const std::vector<double>& fills = vessel_fills(scene, scene.vessels[vessel]);
  const std::size_t tilts = scene.tilts.size();
  std::vector<LiquidResult> states(fills.size() * tilts);
  in_parallel(states.size(), thread_count(),
              [&](std::size_t state) { states[state] = core.liquid(vessel, fills[state / tilts], scene.tilts[state % tilts]); });
  return states;
}

}  // namespace wholehand
