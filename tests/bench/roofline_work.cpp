// SPDX-License-Identifier: MIT
// What the kernels have to do: workloads, operations and bytes.
#include <algorithm>
#include <cmath>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "core/fields.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/variables.h"
#include "tests/bench/roofline.h"
#include "tests/support/counted_core.h"

namespace wholehand::bench {
namespace {

constexpr double GOLDEN = 0.6180339887498949;  // whose multiples, modulo 1, spread evenly

Workload workload_of(Scene scene, bool with_reserves = false) {
  std::vector<int> kept = sweeps::variable_fields(sweeps::choose_variables(scene));
  if (with_reserves) kept.insert(kept.end(), {FIELD_PUSH, FIELD_FRICTION_NEEDED});  // as [output] also asks for them
  Workload workload{std::move(scene), {}};
  workload.fields = make_field_set(kept, workload.scene);
  return workload;
}

OperationCounts counts_of(const Workload& workload) {
  const auto core = core_counted::make_evaluator(workload.scene, {});
  std::vector<double> reals(workload.fields.real_planes * SAMPLE);
  std::vector<std::uint32_t> uints(workload.fields.uint_planes * SAMPLE);
  OperationCounts sum;
  for (std::size_t v = 0; v < workload.scene.vessels.size(); ++v) {
    const auto grips = sample_of(workload, v);
    const OperationCounts before = operations_so_far;
    core->planes(v, grips.data(), SAMPLE, workload.fields, SAMPLE, reals.data(), uints.data());
    sum += operations_so_far - before;
  }
  return sum;
}

}  // namespace

const char* step_name(int step) {
  constexpr const char* NAMES[STEPS] = {"grips", "bodies", "forces", "efforts", "reserves"};
  return NAMES[step];
}

std::vector<Workload> roofline_workloads() {
  const Scene whole = read_scene_file(find_scene(DEFAULT_SCENE));
  if (!whole.strength || !whole.table || whole.hand.between == 0 || whole.tilts.empty())
    throw failure_error("the default scene has no [strength], no [table], no tilts or no spheres between the joints");
  Scene forces = whole;
  forces.strength.reset();
  Scene bodies = forces;
  bodies.liquid.reset();
  bodies.tilts.clear();
  Scene grips = bodies;
  grips.table.reset();
  grips.hand.between = 0;
  return {workload_of(grips), workload_of(bodies), workload_of(forces), workload_of(whole), workload_of(whole, true)};
}

std::vector<GripInput> sample_of(const Workload& workload, std::size_t vessel) {
  const sweeps::Plan plan(workload.scene, false);
  const double blocks = std::floor(static_cast<double>(plan.grips()) / GROUP_SIZE);
  std::vector<GripInput> grips;
  for (std::size_t i = 0; i < SAMPLE; ++i) {
    const double turns = GOLDEN * static_cast<double>(i / GROUP_SIZE);
    const auto block = static_cast<std::uint64_t>((turns - std::floor(turns)) * blocks);
    grips.push_back(plan.grip(vessel, block * GROUP_SIZE + i % GROUP_SIZE));
  }
  return grips;
}

Demand demand_of(const OperationCounts& counts, double items) {
  const auto each = [items](std::uint64_t count) { return static_cast<double>(count) / items; };
  return {each(counts.additions), each(counts.multiplications), each(counts.divisions),
          each(counts.roots),     each(counts.transcendentals), each(counts.comparisons)};
}

Demand operator+(const Demand& a, const Demand& b) {
  return {a.additions + b.additions, a.multiplications + b.multiplications, a.divisions + b.divisions,
          a.roots + b.roots,         a.transcendentals + b.transcendentals, a.comparisons + b.comparisons};
}

std::vector<Demand> demands(const std::vector<Workload>& workloads) {
  std::vector<Demand> found;
  OperationCounts before;
  for (int step = 0; step < STEPS; ++step) {
    const OperationCounts counts = counts_of(workloads[static_cast<std::size_t>(step)]);
    const double grips = static_cast<double>(SAMPLE * workloads[0].scene.vessels.size());
    found.push_back(demand_of(replaces(step) ? counts : counts - before, grips));
    before = counts;
  }
  return found;
}

namespace {

// Planes that a workload computes and the one before it does not; of all of them where `before` is null.
std::size_t new_planes(const Workload& workload, const Workload* before) {
  std::size_t planes = 0;
  for (const Field& field : real_fields())
    if (workload.fields.has(field.number) && !(before && before->fields.has(field.number)))
      planes += static_cast<std::size_t>(field_planes(field.number, workload.scene));
  return planes;
}

}  // namespace

// Every plane is written once, by its step. On a device forces read two angles of the grip, its midpoint and its status; each task of the
// efforts reads these two angles, status and the contacts, and those of the reserves also the worst state.
std::vector<double> bytes_of(const std::vector<Workload>& workloads, std::size_t real, bool on_device) {
  constexpr std::size_t WORD = sizeof(std::uint32_t);
  const std::size_t contacts = CONTACT_STRIDE * JOINTS * real;
  const std::size_t task = contacts + 2 * real + WORD;
  std::vector<double> bytes;
  for (int step = 0; step < STEPS; ++step) {
    const Workload& workload = workloads[static_cast<std::size_t>(step)];
    const bool is_grip = replaces(step);
    std::size_t moved = new_planes(workload, is_grip ? nullptr : &workload - 1) * real;
    if (is_grip) moved += GRIP_AXES * real + workload.fields.uint_planes * WORD;
    if (on_device && step == FORCES) moved += 5 * real + WORD;
    if (on_device && step == EFFORTS) moved += contacts + 3 * task;
    if (on_device && step == RESERVES) moved += 2 * (task + 3 * real);
    bytes.push_back(static_cast<double>(moved));
  }
  return bytes;
}

std::vector<RooflineRow> whole_rows(const std::vector<RooflineRow>& rows) {
  std::vector<RooflineRow> whole;
  for (const RooflineRow& row : rows) {
    if (row.kernel == step_name(GRIPS)) continue;
    const auto same = [&](const RooflineRow& other) { return other.backend == row.backend; };
    auto sum = std::find_if(whole.begin(), whole.end(), same);
    if (sum == whole.end()) {
      sum = whole.insert(sum, {"whole", row.backend, row.item, {}, 0, row.items, {}, row.roof, {}});
    }
    sum->demand = sum->demand + row.demand;
    sum->bytes += row.bytes;
    sum->cost = {sum->cost.wall + row.cost.wall, sum->cost.processor + row.cost.processor};
  }
  return whole;
}

}  // namespace wholehand::bench
