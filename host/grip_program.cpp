// SPDX-License-Identifier: MIT
#include "host/grip_program.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <set>

#include "base/system/clock.h"
#include "core/touch.h"
#include "host/compile.h"
#include "host/turns.h"

namespace wholehand::host {
namespace {

template <class Real>
Buffer upload_reals(const Device& device, const std::vector<double>& values) {
  // a binding that the shader names must exist even if nothing is read from it
  std::vector<Real> converted(values.begin(), values.end());
  converted.resize(std::max<std::size_t>(converted.size(), 4));
  return Buffer::of(device, converted);
}

Buffer upload(const Device& device, Precision precision, const std::vector<double>& values) {
  return precision == Precision::single ? upload_reals<float>(device, values) : upload_reals<double>(device, values);
}

Buffer upload(const Device& device, Precision precision, const Parameters<double>& parameters) {
  if (precision == Precision::single) return Buffer::of(device, std::vector<Parameters<float>>{convert<float>(parameters)});
  return Buffer::of(device, std::vector<Parameters<double>>{parameters});
}

std::vector<Constant> common_constants() { return {{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}}; }

void add_planes(std::vector<Constant>& constants, const FieldSet& fields) {
  for (int f = 0; f < FIELDS; ++f) constants.push_back({std::uint32_t(CONST_PLANE + f), std::int32_t(fields.plane[f])});
}

void add_real(std::vector<Constant>& constants, std::uint32_t id, double value, Precision precision) {
  if (precision == Precision::single) {
    constants.push_back({id, static_cast<float>(value)});
  } else {
    constants.push_back({id, value});
  }
}

// Step limit of a grip on a device; lower than the core's if its turns would exceed the budget.
struct DeviceSteps {
  GripSteps most;
  bool are_few = false;
};

DeviceSteps device_steps(const DeviceInfo& device, const EvaluatorOptions& asked, const GripLoops& loops) {
  DeviceSteps steps;
  if (asked.trace_steps > 0) steps.most.trace = asked.trace_steps;
  if (asked.advance_steps > 0) steps.most.advance = asked.advance_steps;
  steps.are_few = is_llvmpipe(device) && !are_granted(steps.most, loops);
  if (steps.are_few) {
    steps.most.trace = std::min(steps.most.trace, most_steps(loops));
    steps.most.advance = std::min(steps.most.advance, most_steps(loops));
  }
  return steps;
}

// Only what differs from the shaders' own named values.
void add_limits(std::vector<Constant>& constants, const DeviceSteps& steps, const GripBackendOptions& options) {
  const EvaluatorOptions& asked = options.evaluator;
  if (asked.stop_tolerance > 0) add_real(constants, CONST_STOP_TOLERANCE, asked.stop_tolerance, options.precision);
  if (steps.most.trace != TRACE_STEPS) constants.push_back({CONST_TRACE_STEPS, std::int32_t(steps.most.trace)});
  if (steps.most.advance != ADVANCE_STEPS) constants.push_back({CONST_ADVANCE_STEPS, std::int32_t(steps.most.advance)});
  if (steps.are_few) constants.push_back({CONST_FEW_STEPS, std::int32_t(1)});
  if (asked.gap_table > 0) {
    constants.push_back({CONST_GAP_STEPS, std::int32_t(0)});
    constants.push_back({CONST_GAP_TABLE_SIZE, std::int32_t(asked.gap_table)});
  }
}

// See force.comp. Eight grips are as fast as four, and two take 1.06 times as long for the whole of grips and forces (docs/results).
constexpr std::uint32_t FORCES_TOGETHER_ON_CPU = 4;

bool is_off_axis(const VesselArrays& vessel) { return vessel.parameters.center_x != 0 || vessel.parameters.center_z != 0; }

std::size_t real_size(Precision precision) { return precision == Precision::single ? sizeof(float) : sizeof(double); }

// A score as kernels read it.
std::array<std::uint32_t, 2> bits_of(double score, Precision precision) {
  if (precision == Precision::single) return {std::bit_cast<std::uint32_t>(static_cast<float>(score)), 0};
  return std::bit_cast<std::array<std::uint32_t, 2>>(score);
}

// Includes planes that nobody requested but that the kernels of a grip pass on.
FieldSet with_handed_on(FieldSet fields, const Scene& scene) {
  const auto add = [&](int field, int planes) {
    if (fields.has(field)) return;
    fields.plane[field] = fields.real_planes;
    fields.real_planes += planes;
  };
  add(FIELD_POSED, 3 * JOINTS);
  if (scene.table) add(FIELD_TABLE_DEPTH, 1);
  return fields;
}

}  // namespace

struct GripProgram::GripKernel {
  std::shared_ptr<Kernel> VesselOnDevice::*place;
  const char* name;
  OutlineSource outline;
  std::vector<Constant> constants;
  bool operator==(const GripKernel&) const = default;
};

GripProgram::GripProgram(const Scene& scene, const SceneArrays& arrays, const FieldSet& asked, const std::string& selector,
                         const GripBackendOptions& options)
    : on(selector, options.device),
      vessels(scene.vessels.size()),
      fields(with_handed_on(asked, scene)),
      precision_(options.precision),
      build_(options.build            ? *options.build
             : is_llvmpipe(on.info()) ? BUILD_WIDE
                                      : BUILD_SMALL) {
  if (options.precision == Precision::full && !on.info().float64) {
    throw usage_error("device " + on.info().name + " has no double precision (shaderFloat64); use another device",
                      Remedy::or_float_precision);
  }
  const std::size_t shared = GROUP_SIZE * (SOLVE_REALS * real_size(precision_) + sizeof(std::uint32_t)) + sizeof(std::uint32_t);
  if (build_ == BUILD_SMALL && fields.has(FIELD_WORST_EFFORT) && on.info().shared_memory < shared) {
    throw usage_error("device " + on.info().name + " has " + std::to_string(on.info().shared_memory) +
                          " bytes of memory for a group, and efforts take " + std::to_string(shared) + "; use another device",
                      Remedy::or_float_precision);
  }
  fill_count = static_cast<std::uint32_t>(scene_fills(scene));
  tilt_count = static_cast<std::uint32_t>(scene.tilts.size());
  hand = upload(on, options.precision, arrays.hand);

  std::vector<Constant> constants = common_constants();
  add_planes(constants, fields);
  constants.push_back({CONST_TORQUE, std::int32_t(scene.force.torque == Torque::exact ? TORQUE_EXACT : TORQUE_PAPER)});
  constants.push_back({CONST_REFERENCE, std::int32_t(scene.force.reference == TorqueReference::per_grip ? REFERENCE_PER_GRIP
                                                                                                        : REFERENCE_PER_OBJECT)});
  if (scene.until_poured) constants.push_back({CONST_UNTIL_POURED, std::int32_t(1)});
  constants.push_back({CONST_OFF_AXIS, std::int32_t(std::any_of(arrays.vessels.begin(), arrays.vessels.end(), is_off_axis))});
  constants.push_back({CONST_BARE, std::int32_t(!(scene.force.torsion > 0))});
  forces_together = options.forces_together > 0         ? options.forces_together
                    : on.info().kind == DeviceKind::cpu ? FORCES_TOGETHER_ON_CPU
                                                        : 1;
  constants.push_back({CONST_TOGETHER, std::int32_t(forces_together)});

  struct EffortKernel {
    std::optional<Kernel>* kernel;
    const char* name;
    int task;
  };
  has_efforts_ = fields.has(FIELD_WORST_EFFORT);
  const int contacts = fields.real_planes + PLACED_STRIDE;  // first plane
  real_planes = contacts + (has_efforts_ ? CONTACT_STRIDE * JOINTS : 0);
  std::vector<EffortKernel> efforts{{&worst_effort, "effort", EFFORT_WORST}};
  if (fields.has(FIELD_TIPS_WORST_EFFORT)) efforts.push_back({&tips_effort, "effort", EFFORT_TIPS});
  if (fields.has(FIELD_PUSH)) efforts.push_back({&push_reserve, "reserve", EFFORT_PUSH});
  if (fields.has(FIELD_FRICTION_NEEDED)) efforts.push_back({&friction_reserve, "reserve", EFFORT_FRICTION});

  std::vector<KernelRequest> requests;
  std::vector<std::function<void(Kernel &&)>> places;
  const auto request = [&](const char* name, OutlineSource outline, std::vector<Constant> values, std::size_t texel_bytes,
                           std::function<void(Kernel &&)> place) {
    requests.push_back(
        {name, find_shader(name, options.precision, build_, outline, options.shaders), std::move(values), texel_bytes});
    places.push_back(std::move(place));
  };
  for (const VesselArrays& vessel : arrays.vessels) {
    if (vessel.lattice || vessel.outline_count > MAX_OUTLINE) continue;
    copied_count_ = std::max(copied_count_, vessel.outline_count);
    for (int i = 0; i < vessel.outline_count; ++i)
      copied_arcs_ |= SIDE_OF(static_cast<int>(vessel.outline[OUTLINE_STRIDE * i + OUTLINE_STRIDE - 1])) != 0 ? 1u << i : 0u;
  }
  std::vector<std::vector<GripKernel>> grips;
  for (std::size_t v = 0; v < vessels.size(); ++v) {
    upload_vessel(v, scene, arrays, options);  // through the one queue: not in parallel
    grips.push_back(grip_kernels(v, scene, arrays, options));
  }
  for (std::size_t v = 0; v < vessels.size(); ++v)
    for (const GripKernel& kernel : grips[v]) {
      const auto owner =
          std::ranges::find_if(grips, [&](const auto& kernels) { return std::ranges::find(kernels, kernel) != kernels.end(); });
      if (owner == grips.begin() + static_cast<std::ptrdiff_t>(v))
        request(kernel.name, kernel.outline, kernel.constants, vessels[v].lattice.size(),
                [&place = vessels[v].*kernel.place](Kernel&& made) { place = std::make_shared<Kernel>(std::move(made)); });
    }
  const auto make = [&](std::optional<Kernel>& kernel, const char* name, const std::vector<Constant>& values) {
    request(name, OUTLINE_NONE, values, 0, [&kernel](Kernel&& made) { kernel.emplace(std::move(made)); });
  };
  if (has_efforts_) {
    for (auto& [kernel, name, task] : efforts) {
      std::vector<Constant> values = constants;
      values.push_back({CONST_CONTACTS, std::int32_t(contacts)});
      values.push_back({CONST_EFFORT_TASK, std::int32_t(task)});
      const double tolerance = options.evaluator.effort_tolerance;
      if (tolerance > 0) add_real(values, CONST_EFFORT_TOLERANCE, tolerance, options.precision);
      make(*kernel, name, values);
    }
  }
  if (tilt_count > 0 && fields.has(FIELD_PEAK_FORCE)) make(force, "force", constants);
  make(score, "score", constants);
  make(select, "select", constants);
  const double start = monotonic_now();
  std::vector<Kernel> made = compile(on, options.device, std::move(requests), options.compile_watch);
  for (std::size_t k = 0; k < made.size(); ++k) places[k](std::move(made[k]));
  compile_seconds = monotonic_now() - start;
  for (std::size_t v = 0; v < vessels.size(); ++v)
    for (const GripKernel& kernel : grips[v])
      for (std::size_t other = 0; !(vessels[v].*kernel.place); ++other)
        if (std::ranges::find(grips[other], kernel) != grips[other].end()) vessels[v].*kernel.place = vessels[other].*kernel.place;
}

std::vector<const Kernel*> GripProgram::kernels() const {
  std::set<const Kernel*> made;
  for (const VesselOnDevice& vessel : vessels)
    for (const auto& kernel : {vessel.closure, vessel.rest, vessel.contact, vessel.overlap}) made.insert(kernel.get());
  for (const auto* kernel : {&force, &score, &select, &worst_effort, &tips_effort, &push_reserve, &friction_reserve})
    made.insert(*kernel ? &**kernel : nullptr);
  made.erase(nullptr);
  return {made.begin(), made.end()};
}

void GripProgram::upload_vessel(std::size_t v, const Scene& scene, const SceneArrays& arrays, const GripBackendOptions& options) {
  const VesselArrays& from = arrays.vessels[v];
  VesselOnDevice& vessel = vessels[v];
  // with a lattice the outline is not read: one pipeline for all vessels, which a driver compiles once
  const bool may_choose = build_ == BUILD_WIDE && !from.lattice && from.outline_count <= MAX_OUTLINE;
  vessel.outline_source = may_choose ? options.outline : OUTLINE_BUFFER;
  std::vector<double> outline = from.outline;
  // as many as the longest fitting outline has, so that vessels share a pipeline; no point comes near the added ones
  for (int i = from.outline_count; i < copied_count_; ++i)
    outline.insert(outline.end(), {FAR_AWAY, FAR_AWAY, FAR_AWAY, FAR_AWAY, 1, 0, 0, ELEMENT_CODE(0, 0)});
  vessel.parameters = upload(on, options.precision, from.parameters);
  vessel.outline = upload(on, options.precision, outline);
  vessel.lattice = Buffer::of(on, from.lattice ? *from.lattice : std::vector<std::uint32_t>(4));
  upload_states(v, scene, arrays);
}

void GripProgram::write_parameters(const SceneArrays& arrays) {
  for (std::size_t v = 0; v < vessels.size(); ++v) {
    const Parameters<double>& parameters = arrays.vessels[v].parameters;
    if (precision_ == Precision::single) {
      vessels[v].parameters.write(std::vector<Parameters<float>>{convert<float>(parameters)});
    } else {
      vessels[v].parameters.write(std::vector<Parameters<double>>{parameters});
    }
  }
}

void GripProgram::write_fills(const Scene& scene, const SceneArrays& arrays) {
  write_parameters(arrays);
  for (std::size_t v = 0; v < vessels.size() && scene.liquid; ++v) upload_states(v, scene, arrays);
}

std::vector<Buffer> GripProgram::upload_blocks(const std::vector<double>& states) {
  constexpr std::size_t BLOCK = std::size_t{STATE_STRIDE} * STATES_IN_BLOCK;
  std::vector<Buffer> blocks;
  for (std::size_t first = 0; first < states.size(); first += BLOCK) {
    std::vector<double> block(BLOCK);
    std::copy_n(states.begin() + static_cast<std::ptrdiff_t>(first), std::min(BLOCK, states.size() - first), block.begin());
    blocks.push_back(upload(on, precision_, block));
  }
  return blocks;
}

void GripProgram::upload_states(std::size_t v, const Scene& scene, const SceneArrays& arrays) {
  const std::vector<double>& loads = arrays.vessels[v].loads;
  const std::vector<double>& tilts = arrays.tilts;
  const std::vector<std::size_t>& counted = arrays.vessels[v].counted_tilts;
  std::vector<double> states(loads.size() / LOAD_STRIDE * STATE_STRIDE);
  for (std::size_t state = 0; state < loads.size() / LOAD_STRIDE; ++state) {
    double* out = states.data() + STATE_STRIDE * state;
    const std::size_t tilt = state % tilt_count;
    const double* load = loads.data() + LOAD_STRIDE * state;
    const double own_share = 1 - load[1];
    out[0] = load[0] * scene.gravity;
    out[1] = own_share;
    out[2] = load[2];
    out[3] = own_share * arrays.vessels[v].parameters.center_y + load[3];
    std::copy_n(tilts.data() + 3 * tilt, 3, out + LOAD_STRIDE);
    if (tilt >= counted[state / tilt_count]) out[6] = -1;
    out[7] = tilt > 0 ? tilts[3 * tilt - 1] : -1;
  }
  vessels[v].states = upload_blocks(states);
  if (!has_efforts_ || loads.empty()) return;
  const EffortStates efforts = effort_states(scene, v, arrays.vessels[v]);
  vessels[v].worst_count = static_cast<std::uint32_t>(efforts.worst.size() / STATE_STRIDE);
  vessels[v].safe_count = static_cast<std::uint32_t>(efforts.safe.size() / STATE_STRIDE);
  vessels[v].worst_states = upload_blocks(efforts.worst);
  vessels[v].safe_states = upload_blocks(efforts.safe);
}

// None where the vessel is the core's.
std::vector<GripProgram::GripKernel> GripProgram::grip_kernels(std::size_t v, const Scene& scene, const SceneArrays& arrays,
                                                               const GripBackendOptions& options) {
  const VesselArrays& from = arrays.vessels[v];
  const OutlineSource source = vessels[v].outline_source;
  const bool is_looped = !from.lattice && source == OUTLINE_BUFFER;
  const bool has_proxies = fields.has(FIELD_PROXIES) || fields.has(FIELD_BONE_STRETCH);
  const int azimuths = arm_azimuths(scene, scene.vessels[v]);
  const GripLoops loops{is_looped ? from.outline_count : 0, scene.hand.between, has_proxies, azimuths};
  const DeviceSteps steps = device_steps(on.info(), options.evaluator, loops);
  if (steps.are_few && (from.outline_count > MAX_OUTLINE || most_steps(loops) < 1 || !are_granted(steps.most, loops))) return {};
  std::vector<Constant> constants = common_constants();
  add_planes(constants, fields);
  constants.push_back({CONST_PLACED, std::int32_t(fields.real_planes)});
  if (has_efforts_) constants.push_back({CONST_CONTACTS, std::int32_t(fields.real_planes + PLACED_STRIDE)});
  constants.push_back({CONST_POSE, std::int32_t(scene.pose == Pose::articulated ? POSE_ARTICULATED
                                                : scene.pose == Pose::paper     ? POSE_PAPER
                                                                                : POSE_RIGGED)});
  if (scene.table) constants.push_back({CONST_TABLE, std::int32_t(1)});
  if (scene.hand.between > 0) constants.push_back({CONST_BETWEEN, std::int32_t(scene.hand.between)});
  std::vector<Constant> overlap = constants;
  if (azimuths > 0) overlap.push_back({CONST_ARM, std::int32_t(azimuths)});
  constants.push_back({CONST_SDF_KIND, std::int32_t(from.lattice ? SDF_LATTICE : SDF_OUTLINE)});
  if (source == OUTLINE_COPIED) {
    constants.push_back({CONST_OUTLINE_COUNT, std::int32_t(copied_count_)});
    constants.push_back({CONST_ARCS, copied_arcs_});
  }
  if (from.halves) constants.push_back({CONST_LATTICE_BITS, std::int32_t(16)});
  add_limits(constants, steps, options);
  std::vector<GripKernel> kernels{{&VesselOnDevice::closure, "closure", source, constants},
                                  {&VesselOnDevice::contact, "contact", source, constants}};
  if (scene.pose != Pose::rigged) kernels.push_back({&VesselOnDevice::rest, "rest", source, constants});
  if (scene.hand.between > 0 || azimuths > 0) kernels.push_back({&VesselOnDevice::overlap, "overlap", OUTLINE_NONE, overlap});
  return kernels;
}

// After the forces: lowers a safe tilt at which the hand no longer holds.
void GripProgram::record_efforts(std::size_t v, std::uint32_t count, std::uint32_t stride, double least_score,
                                 Commands& commands) const {
  const auto floor_bits = bits_of(least_score, precision_);
  const auto go_through = [&](const Kernel& kernel, const std::vector<Buffer>& blocks, std::uint32_t states, bool is_safe = false) {
    for (std::uint32_t first = 0; first < states; first += STATES_IN_BLOCK) {
      commands.bind(BINDING_STATES, blocks[first / STATES_IN_BLOCK]);
      commands.dispatch(kernel, groups_for(on, kernel, count),
                        Push{count, stride, first, std::min<std::uint32_t>(STATES_IN_BLOCK, states - first), floor_bits[0],
                             floor_bits[1], is_safe});
    }
  };
  const VesselOnDevice& vessel = vessels[v];
  if (least_score > 0) commands.dispatch(*score, groups_for(on, *score, count), Push{count, stride, 0, 0, 0, 0, 1});
  go_through(*worst_effort, vessel.worst_states, vessel.worst_count);
  if (tips_effort) go_through(*tips_effort, vessel.worst_states, vessel.worst_count);
  if (push_reserve) go_through(*push_reserve, vessel.worst_states, 1);
  if (friction_reserve) go_through(*friction_reserve, vessel.worst_states, vessel.worst_count);
  if (fields.has(FIELD_SAFE_TILT)) go_through(*worst_effort, vessel.safe_states, vessel.safe_count, true);
}

void GripProgram::record(std::size_t v, const Chunk& chunk, std::size_t best, double floor_score, double least_score,
                         Commands& commands) {
  const VesselOnDevice& vessel = vessels[v];
  const auto count = static_cast<std::uint32_t>(chunk.count), stride = static_cast<std::uint32_t>(chunk.stride);
  commands.bind(BINDING_PARAMETERS, vessel.parameters);
  commands.bind(BINDING_HAND, hand);
  commands.bind(BINDING_OUTLINE, vessel.outline);
  commands.bind(BINDING_LATTICE, vessel.lattice);
  for (const auto& kernel : {vessel.closure, vessel.rest, vessel.contact, vessel.overlap})
    if (kernel) commands.dispatch(*kernel, groups_for(on, *kernel, count), Push{count, stride, 0, 0});
  if (force) {
    const std::uint32_t states = fill_count * tilt_count, invocations = (count + forces_together - 1) / forces_together;
    for (std::uint32_t first = 0; first < states; first += STATES_IN_BLOCK) {
      commands.bind(BINDING_STATES, vessel.states[first / STATES_IN_BLOCK]);
      commands.dispatch(*force, groups_for(on, *force, invocations),
                        Push{count, stride, first, std::min<std::uint32_t>(STATES_IN_BLOCK, states - first)});
    }
  }
  if (has_efforts_) record_efforts(v, count, stride, least_score, commands);
  commands.dispatch(*score, groups_for(on, *score, count), Push{count, stride, 0, 0});
  if (best == 0) return;
  const auto wanted = static_cast<std::uint32_t>(best);
  std::vector<std::uint32_t> passes;  // entries of each
  for (std::uint32_t entries = count;; entries = (entries + SELECT_ENTRIES - 1) / SELECT_ENTRIES * wanted) {
    passes.push_back(entries);
    if (entries <= SELECT_ENTRIES) break;
  }
  const auto floor_bits = bits_of(floor_score, precision_);
  // the halves alternate so that the last pass ends in the first
  std::uint32_t from = 0;
  bool into_first = passes.size() % 2 == 1;
  for (const std::uint32_t entries : passes) {
    const std::uint32_t groups = (entries + SELECT_ENTRIES - 1) / SELECT_ENTRIES;
    const std::uint32_t step = from == 0 ? (into_first ? SELECT_SCORES_TO_FIRST : SELECT_SCORES_TO_SECOND)
                                         : (into_first ? SELECT_SECOND_TO_FIRST : SELECT_FIRST_TO_SECOND);
    commands.dispatch(*select, groups_for(on, *select, groups), Push{entries, stride, step, wanted, floor_bits[0], floor_bits[1]});
    from = 1;
    into_first = !into_first;
  }
}

}  // namespace wholehand::host
