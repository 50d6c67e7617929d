// SPDX-License-Identifier: MIT
#include "host/grip_backend.h"

#include <algorithm>
#include <array>

#include "base/numbers/parallel.h"
#include "base/system/clock.h"
#include "core/candidates.h"
#include "core/core_backend.h"
#include "core/fields.h"
#include "core/fills.h"
#include "core/mirror.h"
#include "core/prepare.h"
#include "host/grip_program.h"
#include "host/stream.h"
#include "host/turns.h"
#include "shaders/status.h"

namespace wholehand::host {
namespace {

constexpr std::uint32_t NO_GRIP = 0xffffffffu;

// Planes whose sign changes when a left hand's result is mirrored back.
std::vector<int> mirrored_planes(const Scene& scene, const FieldSet& fields) {
  std::vector<int> planes;
  if (scene.hand.handedness == Handedness::right) return planes;
  for (const Field& field : real_fields()) {
    if (!field.is_vector() || !fields.has(field.number)) continue;
    const int first = fields.plane[field.number], count = field_planes(field.number, scene_fills(scene), scene.tilts.size());
    for (int plane = first; plane < first + count && plane < fields.real_kept; plane += 3)
      planes.push_back(plane);  // the x of each
  }
  return planes;
}

// Kept planes that no kernel of the device writes; the core adds them. Empty if there are none.
FieldSet fields_of_core(const Scene& scene, const FieldSet& fields) {
  FieldSet lacking;
  lacking.plane.fill(-1);
  std::vector<int> by_core{FIELD_EFFORT, FIELD_EFFORT_LOW, FIELD_TIPS_EFFORT};
  if (has_effort(scene)) by_core.insert(by_core.end(), {FIELD_HOLD_FORCE, FIELD_LARGEST_HOLD});
  for (const int field : by_core) {
    if (!fields.has(field) || fields.plane[field] >= fields.real_kept) continue;
    lacking.plane[field] = fields.plane[field];
    lacking.real_planes = lacking.real_kept = fields.real_kept;
  }
  return lacking;
}

// A copy of the planes of a chunk that were read back.
template <class Real>
struct ReadBack {
  std::vector<Real> reals;
  std::vector<std::uint32_t> uints;
};

}  // namespace

struct GripBackend::Impl {
  Impl(const Scene& scene_in, std::shared_ptr<const Evaluator> core_in, const FieldSet& fields_in, const std::string& selector,
       const GripBackendOptions& options_in)
      : scene(scene_in),
        core(std::move(core_in)),
        fields(fields_in),
        options(options_in),
        arrays(make_scene_arrays(scene, *core, options.evaluator)),
        mirrored(mirrored_planes(scene, fields)),
        of_core(fields_of_core(scene, fields)),
        stream([this, selector] { return std::make_unique<GripProgram>(scene, arrays, fields, selector, options); },
               with_select_multiple(options.stream)) {
    info.backend = "vulkan";
    info.device = program().on.info().name;
    info.driver = program().on.info().driver;
    info.precision = options.precision;
    info.is_cpu = program().on.info().kind == DeviceKind::cpu;
    info.compile_seconds = program().compile_seconds;
  }

  static StreamOptions with_select_multiple(StreamOptions stream_options) {
    stream_options.item_multiple = std::max<std::size_t>(stream_options.item_multiple, GROUP_SIZE);
    return stream_options;
  }

  GripProgram& program() { return static_cast<GripProgram&>(stream.program()); }

  std::size_t real_size() const { return options.precision == Precision::single ? sizeof(float) : sizeof(double); }

  template <class Real>
  void fill(const RunRequest& request, const Chunk& chunk, const ChunkInputs& inputs) {
    grips.resize(chunk.count);
    request.grips(request.vessel, chunk.first, chunk.count, grips.data());
    const std::span<Real> out = elements<Real>(inputs[0]);
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const GripInput grip = wholehand::mirrored(grips[i], scene.hand.handedness);
      out[AXIS_HEIGHT * chunk.stride + i] = static_cast<Real>(grip.height);
      out[AXIS_AZIMUTH * chunk.stride + i] = static_cast<Real>(grip.azimuth);
      out[AXIS_OBLIQUITY * chunk.stride + i] = static_cast<Real>(grip.obliquity);
      out[AXIS_ROLL * chunk.stride + i] = static_cast<Real>(grip.roll);
      out[AXIS_OFFSET * chunk.stride + i] = static_cast<Real>(grip.offset);
      out[AXIS_HAND_SCALE * chunk.stride + i] = static_cast<Real>(grip.hand_scale);
    }
  }

  // Kept planes of a chunk by the core, in the device's form.
  template <class Real>
  void evaluate_on_core(const RunRequest& request, const Chunk& chunk, std::span<const std::span<std::byte>> outputs,
                        std::size_t best) {
    std::vector<GripInput> inputs(chunk.count);
    request.grips(request.vessel, chunk.first, chunk.count, inputs.data());
    std::vector<double> reals(fields.real_planes * chunk.stride);
    std::vector<std::uint32_t> uints(fields.uint_planes * chunk.stride);
    core->planes(request.vessel, inputs.data(), chunk.count, fields, chunk.stride, reals.data(), uints.data());
    for (const int plane : mirrored)
      for (std::size_t i = 0; i < chunk.count; ++i) reals[plane * chunk.stride + i] = -reals[plane * chunk.stride + i];
    const std::span<Real> real_out = elements<Real>(outputs[0]);
    for (std::size_t i = 0; i < real_out.size(); ++i) real_out[i] = static_cast<Real>(reals[i]);
    const std::span<std::uint32_t> uint_out = elements<std::uint32_t>(outputs[1]);
    std::copy_n(uints.begin(), uint_out.size(), uint_out.begin());
    if (best == 0) return;
    const PlaneChunk planes{request.vessel, chunk.first, chunk.count, chunk.stride, nullptr, reals.data(), uints.data()};
    const auto chosen = best_of(planes, best);
    const std::span<Real> scores = elements<Real>(outputs[2]);
    const std::span<std::uint32_t> indices = elements<std::uint32_t>(outputs[3]);
    for (std::size_t i = 0; i < best; ++i) {
      scores[i] = i < chosen.size() ? static_cast<Real>(chosen[i].score) : Real(-1);
      indices[i] = i < chosen.size() ? static_cast<std::uint32_t>(chosen[i].index - chunk.first) : NO_GRIP;
    }
  }

  // Best grips of planes that have score and status.
  std::vector<Candidate> best_of(const PlaneChunk& planes, std::size_t best) const {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < planes.count; ++i) {
      const std::uint32_t status = planes.uint(fields.plane[FIELD_STATUS], i);
      if (!is_eligible(status)) continue;
      candidates.push_back({planes.real(fields.plane[FIELD_SCORE], i), planes.first + i});
    }
    keep_best(candidates, best);
    return candidates;
  }

  static void keep_best(std::vector<Candidate>& candidates, std::size_t best) {
    const std::size_t kept = std::min(best, candidates.size());
    std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(kept), candidates.end(), is_better);
    candidates.resize(kept);
  }

  // A whole run by the core, on all threads, if the device cannot be trusted with the vessel.
  template <class Real>
  RunResult run_on_core(const RunRequest& request) {
    FieldSet all = fields;  // all kept: the best are chosen here, from planes that the caller may not want
    all.real_kept = all.real_planes;
    all.uint_kept = all.uint_planes;
    std::vector<Candidate> best;
    std::vector<float> converted;
    RunRequest asked = request;
    asked.best = 0;  // of what is handed over: two scores may be one in float
    asked.sink = [&](const PlaneChunk& chunk) {
      PlaneChunk planes = chunk;
      if constexpr (sizeof(Real) == sizeof(float)) {
        converted.resize(all.real_planes * chunk.stride);
        std::transform(chunk.doubles, chunk.doubles + converted.size(), converted.begin(),
                       [](double value) { return static_cast<float>(value); });
        planes.doubles = nullptr;
        planes.floats = converted.data();
      }
      if (request.best > 0) {
        const auto chosen = best_of(planes, request.best);
        best.insert(best.end(), chosen.begin(), chosen.end());
        keep_best(best, request.best);
      }
      if (request.sink) request.sink(planes);
    };
    RunResult result = CoreBackend(core, scene, all, Precision::full, 0).run(asked);
    result.best = std::move(best);
    result.notes.push_back(scene.vessels[request.vessel].name + ": an outline of " +
                           std::to_string(arrays.vessels[request.vessel].outline_count) +
                           " elements is evaluated on the core: its loops may be longer than " + info.device + " runs them");
    return result;
  }

  // Where the best grips of a run are chosen.
  struct Selection {
    bool on_host = false;  // more than the device can select: every score is read back
    std::size_t best = 0;  // by the device
  };

  template <class Real>
  StreamRequest buffers_for(const Selection& selection) {
    const int real_kept = selection.on_host ? std::max(fields.real_kept, fields.plane[FIELD_SCORE] + 1) : fields.real_kept;
    const int uint_kept = std::max(fields.uint_kept, fields.plane[FIELD_STATUS] + 1);  // which grips are unfinished
    const std::size_t best = selection.best;
    StreamRequest work;
    work.inputs = {{BINDING_GRIPS, GRIP_AXES * sizeof(Real)}};
    work.outputs = {{BINDING_REAL_OUT, program().real_planes * sizeof(Real), real_kept * sizeof(Real)},
                    {BINDING_UINT_OUT, fields.uint_planes * sizeof(std::uint32_t), uint_kept * sizeof(std::uint32_t)}};
    if (best > 0) {
      // two halves for the passes of the selection, each of groups * best entries
      work.outputs.push_back({BINDING_CANDIDATES, sizeof(Real), 0, 2 * best * sizeof(Real), best * sizeof(Real)});
      work.outputs.push_back(
          {BINDING_INDICES, sizeof(std::uint32_t), 0, 2 * best * sizeof(std::uint32_t), best * sizeof(std::uint32_t)});
    }
    return work;
  }

  // Planes that the device does not compute, by the core on all threads.
  template <class Real>
  void add_planes_of_core(const RunRequest& request, const Chunk& chunk, std::vector<Real>& reals) const {
    constexpr std::size_t PIECE = 64;
    std::vector<GripInput> inputs(chunk.count);
    request.grips(request.vessel, chunk.first, chunk.count, inputs.data());
    in_parallel((chunk.count + PIECE - 1) / PIECE, 0, [&](std::size_t piece) {
      const std::size_t first = piece * PIECE, count = std::min(PIECE, chunk.count - first);
      std::vector<double> values(of_core.real_planes * count);
      std::vector<std::uint32_t> no_values(count);
      core->planes(request.vessel, inputs.data() + first, count, of_core, count, values.data(), no_values.data());
      for (const Field& field : real_fields()) {
        if (!of_core.has(field.number)) continue;
        const int from = of_core.plane[field.number], planes = field_planes(field.number, scene);
        for (int plane = from; plane < from + planes; ++plane)
          for (std::size_t i = 0; i < count; ++i)
            reals[plane * chunk.stride + first + i] = static_cast<Real>(values[plane * count + i]);
      }
    });
  }

  // Grips whose turns ran out on the device.
  std::vector<std::size_t> unfinished_grips(const Chunk& chunk, std::span<const std::uint32_t> uints) const {
    std::vector<std::size_t> unfinished;
    const std::span<const std::uint32_t> statuses = uints.subspan(fields.plane[FIELD_STATUS] * chunk.stride, chunk.count);
    for (std::size_t i = 0; i < chunk.count; ++i)
      if ((statuses[i] & STATUS_OUT_OF_TURNS) != 0) unfinished.push_back(i);
    return unfinished;
  }

  // Replaces some grips of a chunk by evaluate_on_core's results, on all threads; also each one's candidate, if `has_best`.
  template <class Real>
  void finish_on_core(const RunRequest& request, const Chunk& chunk, const std::vector<std::size_t>& unfinished,
                      ReadBack<Real>& read, bool has_best, std::vector<Candidate>& candidates) {
    std::vector<Real> scores(unfinished.size());
    std::vector<std::uint32_t> indices(unfinished.size(), NO_GRIP);
    in_parallel(unfinished.size(), 0, [&](std::size_t k) {
      std::vector<Real> reals(read.reals.size() / chunk.stride);
      std::vector<std::uint32_t> uints(read.uints.size() / chunk.stride);
      const std::array<std::span<std::byte>, 4> outputs{
          std::as_writable_bytes(std::span(reals)), std::as_writable_bytes(std::span(uints)),
          std::as_writable_bytes(std::span(scores).subspan(k, 1)), std::as_writable_bytes(std::span(indices).subspan(k, 1))};
      evaluate_on_core<Real>(request, Chunk{chunk.first + unfinished[k], 1, 1}, outputs, has_best ? 1 : 0);
      for (std::size_t plane = 0; plane < reals.size(); ++plane) read.reals[plane * chunk.stride + unfinished[k]] = reals[plane];
      for (std::size_t plane = 0; plane < uints.size(); ++plane) read.uints[plane * chunk.stride + unfinished[k]] = uints[plane];
    });
    for (std::size_t k = 0; k < unfinished.size(); ++k)
      if (indices[k] != NO_GRIP) candidates.push_back({static_cast<double>(scores[k]), chunk.first + unfinished[k]});
  }

  // Mirrored planes turned back where there are some, and those of the core, in `turned`.
  template <class Real>
  PlaneChunk planes_of(const RunRequest& request, const Chunk& chunk, std::span<const Real> reals,
                       std::span<const std::uint32_t> uints, std::vector<Real>& turned) const {
    PlaneChunk planes{request.vessel, chunk.first, chunk.count, chunk.stride, nullptr, nullptr, uints.data()};
    if (!mirrored.empty() || of_core.real_planes > 0) {
      turned.assign(reals.begin(), reals.end());
      if (of_core.real_planes > 0) add_planes_of_core(request, chunk, turned);
      for (const int plane : mirrored)
        for (std::size_t i = 0; i < chunk.count; ++i) turned[plane * chunk.stride + i] = -turned[plane * chunk.stride + i];
      reals = turned;
    }
    if constexpr (sizeof(Real) == sizeof(float)) {
      planes.floats = reals.data();
    } else {
      planes.doubles = reals.data();
    }
    return planes;
  }

  template <class Real>
  void take_selected(const Chunk& chunk, const ChunkOutputs& outputs, std::size_t best, std::vector<Candidate>& candidates) const {
    const std::span<const Real> scores = elements<const Real>(outputs[2]);
    const std::span<const std::uint32_t> indices = elements<const std::uint32_t>(outputs[3]);
    for (std::size_t i = 0; i < best && indices[i] != NO_GRIP; ++i)
      candidates.push_back({static_cast<double>(scores[i]), chunk.first + indices[i]});
  }

  template <class Real>
  RunResult run(const RunRequest& request) {
    if (program().vessels[request.vessel].is_on_core()) return run_on_core<Real>(request);
    const bool on_host = request.best > SELECT_LARGEST;
    const Selection selection{on_host, on_host ? 0 : request.best};
    RunResult result;
    StreamRequest work = buffers_for<Real>(selection);
    work.first = request.first;
    work.last = request.last;
    work.stop = request.stop;
    work.fill = [&](const Chunk& chunk, const ChunkInputs& inputs) { fill<Real>(request, chunk, inputs); };
    work.record = [&](Program& made, const Chunk& chunk, Commands& commands) {
      // grips come in ascending order, so among equal scores those already found stay first
      const bool is_full = selection.best > 0 && result.best.size() == selection.best;
      const double floor_score = is_full ? result.best.back().score : -1;
      const double least_score = request.least_score ? std::max(request.least_score->load(), floor_score) : NO_LEAST_SCORE;
      static_cast<GripProgram&>(made).record(request.vessel, chunk, selection.best, floor_score, least_score, commands);
    };
    work.fallback = [&](const Chunk& chunk, std::span<const std::span<std::byte>> outputs) {
      evaluate_on_core<Real>(request, chunk, outputs, selection.best);
    };
    std::vector<Real> turned;
    ReadBack<Real> read;
    std::size_t unfinished_count = 0;
    work.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
      std::span<const Real> reals = elements<const Real>(outputs[0]);
      std::span<const std::uint32_t> uints = elements<const std::uint32_t>(outputs[1]);
      const std::vector<std::size_t> unfinished = unfinished_grips(chunk, uints);
      if (!unfinished.empty()) {
        read.reals.assign(reals.begin(), reals.end());
        read.uints.assign(uints.begin(), uints.end());
        finish_on_core(request, chunk, unfinished, read, selection.best > 0, result.best);
        reals = read.reals;
        uints = read.uints;
        unfinished_count += unfinished.size();
      }
      const PlaneChunk planes = planes_of(request, chunk, reals, uints, turned);
      if (selection.on_host) {
        const auto chosen = best_of(planes, request.best);
        result.best.insert(result.best.end(), chosen.begin(), chosen.end());
      } else if (selection.best > 0) {
        take_selected<Real>(chunk, outputs, selection.best, result.best);
      }
      keep_best(result.best, request.best);
      if (request.sink) request.sink(planes);
    };
    const StreamResult streamed = stream.run(work);
    result.done = streamed.items;
    result.chunks = streamed.chunks;
    result.kernel_seconds = streamed.kernel_seconds;
    result.notes = streamed.notes;
    if (unfinished_count > 0) {
      result.notes.push_back(scene.vessels[request.vessel].name + ": " + std::to_string(unfinished_count) +
                             (unfinished_count == 1 ? " grip is" : " grips are") +
                             " evaluated on the core: more turns of loops than every driver grants");
    }
    return result;
  }

  Scene scene;
  std::shared_ptr<const Evaluator> core;
  FieldSet fields;
  GripBackendOptions options;
  SceneArrays arrays;
  std::vector<int> mirrored;
  FieldSet of_core;
  std::vector<GripInput> grips;
  Stream stream;
  BackendInfo info;
};

GripBackend::GripBackend(const Scene& scene, std::shared_ptr<const Evaluator> core, const FieldSet& fields,
                         const std::string& selector, const GripBackendOptions& options)
    : impl_(std::make_unique<Impl>(scene, std::move(core), fields, selector, options)) {}

GripBackend::~GripBackend() = default;

const BackendInfo& GripBackend::info() const { return impl_->info; }
const FieldSet& GripBackend::fields() const { return impl_->fields; }

RunResult GripBackend::run(const RunRequest& request) {
  return impl_->options.precision == Precision::single ? impl_->run<float>(request) : impl_->run<double>(request);
}

std::vector<LiquidResult> GripBackend::liquid(std::size_t vessel) { return impl_->arrays.vessels[vessel].liquid; }

bool GripBackend::use_fills_of(const Scene& other) {
  if (!have_like_fills(impl_->scene, other)) return false;
  take_fills(impl_->scene, other);
  impl_->core = make_core_evaluator(impl_->scene, impl_->options.evaluator);
  impl_->arrays = make_scene_arrays(impl_->scene, *impl_->core, impl_->options.evaluator);
  impl_->program().write_fills(impl_->scene, impl_->arrays);
  return true;
}

GripPipelines GripBackend::pipelines(std::size_t vessel) const {
  const GripProgram& program = impl_->program();
  GripPipelines made;
  made.outline = program.vessels[vessel].outline_source;
  made.force = program.force.has_value();
  made.real_planes = impl_->fields.real_planes;
  made.uint_planes = impl_->fields.uint_planes;
  return made;
}

const DeviceInfo& GripBackend::device() const { return impl_->program().on.info(); }

std::size_t GripBackend::bytes_per_grip() const {
  const GripProgram& program = impl_->program();
  return (GRIP_AXES + program.real_planes) * impl_->real_size() + program.fields.uint_planes * sizeof(std::uint32_t);
}

std::size_t GripBackend::table_bytes() const {
  const GripProgram& program = impl_->program();
  std::size_t bytes = program.hand.size();
  for (const VesselOnDevice& vessel : program.vessels) {
    bytes += vessel.parameters.size() + vessel.outline.size() + vessel.lattice.size();
    for (const auto* blocks : {&vessel.states, &vessel.worst_states, &vessel.safe_states})
      for (const Buffer& states : *blocks) bytes += states.size();
  }
  return bytes;
}

}  // namespace wholehand::host
