// SPDX-License-Identifier: MIT
// A scene on one device: buffers that all grips share, the kernels, and the liquid's tables; for host/ alone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host/grip_options.h"
#include "host/kernel.h"
#include "host/scene_arrays.h"

namespace wholehand::host {

// What a vessel needs on the device.
struct VesselOnDevice {
  OutlineSource outline_source = OUTLINE_COPIED;
  Buffer parameters, outline, lattice, fills;
  std::vector<Buffer> states;                     // blocks of STATES_IN_BLOCK; empty without tilts
  std::vector<Buffer> worst_states, safe_states;  // likewise, of the efforts; empty without them
  std::uint32_t worst_count = 0, safe_count = 0;  // states in them
  // None where a CPU driver would loop over a long outline: the turns have no bound that it grants. Vessels share those that are the same.
  std::shared_ptr<Kernel> closure, rest, contact, overlap;
  bool is_on_core() const { return !closure; }
  std::vector<LiquidResult> liquid;  // fill-major; empty without
};

struct LiquidWork {
  Buffer cavity, capacity, liquids, loads;  // LIQUID_STRIDE and LOAD_STRIDE a state, fill-major
  Commands commands;
};

// Made by the stream, again on a fresh device where one fails.
struct GripProgram final : Program {
  GripProgram(const Scene& scene, const SceneArrays& arrays, const Evaluator& core, const FieldSet& fields,
              const std::string& selector, const GripBackendOptions& options);
  Device& device() override { return on; }

  // Dispatches the kernels of a chunk whose buffers are bound; `best`: how many candidates the selection leaves, of those with a score
  // above `floor_score`. Efforts are computed of grips whose score may reach `least_score`.
  void record(std::size_t vessel, const Chunk& chunk, std::size_t best, double floor_score, double least_score, Commands& commands);

  // The liquid of a vessel with a cavity over all fills and tilts, in a scene with liquid and tilts: buffers, and the dispatches that fill them.
  std::unique_ptr<LiquidWork> liquid_work(std::size_t vessel, const SceneArrays& arrays) const;

  std::vector<const Kernel*> kernels() const;  // each once

  // The vessels' parameter blocks alone, into the buffers that are there. With no chunk in flight.
  void write_parameters(const SceneArrays& arrays);
  // The fills of all vessels, and what follows from them: parameters, liquid and states. As many fills as there were. With no chunk
  // in flight.
  void write_fills(const Scene& scene, const SceneArrays& arrays, const Evaluator& core, const GripBackendOptions& options);

  Device on;  // first: destroyed last
  Buffer hand, tilts, quadrature;
  std::vector<VesselOnDevice> vessels;
  std::optional<Kernel> force, score, select;
  std::optional<Kernel> lip, liquid;                                                // in a scene with liquid and tilts
  std::optional<Kernel> worst_effort, tips_effort, push_reserve, friction_reserve;  // in a scene with efforts
  double compile_seconds = 0;
  std::uint32_t forces_together = 1;  // grips of an invocation of `force`
  std::uint32_t fill_count = 0, tilt_count = 0;
  FieldSet fields;      // those asked for, and what the kernels of a grip hand on to each other
  int real_planes = 0;  // of a chunk: of the fields, and scratch

 private:
  Precision precision_;
  KernelBuild build_;
  bool has_efforts_ = false;
  int copied_count_ = 0;           // elements of every outline that is copied,
  std::uint32_t copied_arcs_ = 0;  // and which of them are an arc in any vessel, a bit each
  void upload_vessel(std::size_t v, const Scene& scene, const SceneArrays& arrays, const GripBackendOptions& options);
  struct GripKernel;
  std::vector<GripKernel> grip_kernels(std::size_t v, const Scene& scene, const SceneArrays& arrays,
                                       const GripBackendOptions& options);
  void make_liquid(std::size_t v, const Scene& scene, const SceneArrays& arrays, const Evaluator& core,
                   const GripBackendOptions& options);
  void upload_states(std::size_t v, const Scene& scene, const SceneArrays& arrays, const std::vector<double>& loads);
  std::vector<Buffer> upload_blocks(const std::vector<double>& states);
  void record_efforts(std::size_t v, std::uint32_t count, std::uint32_t stride, double least_score, Commands& commands) const;
};

}  // namespace wholehand::host
