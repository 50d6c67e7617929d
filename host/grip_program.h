// SPDX-License-Identifier: MIT
// A scene on one device: buffers that all grips share, and the kernels; for host/ alone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host/grip_options.h"
#include "host/kernel.h"
#include "host/scene_arrays.h"

namespace wholehand::host {

// A vessel's data on the device.
struct VesselOnDevice {
  OutlineSource outline_source = OUTLINE_COPIED;
  Buffer parameters, outline, lattice;
  std::vector<Buffer> states;                     // blocks of STATES_IN_BLOCK; empty without tilts
  std::vector<Buffer> worst_states, safe_states;  // the same for efforts; empty without them
  std::uint32_t worst_count = 0, safe_count = 0;  // states in them
  // Absent if a CPU driver would loop over a long outline, because the turns cannot be bounded within its budget. Equal tables are shared between
  // vessels.
  std::shared_ptr<Kernel> closure, rest, contact, overlap;
  bool is_on_core() const { return !closure; }
};

// The stream makes it, and makes it again on a fresh device after a failure.
struct GripProgram final : Program {
  GripProgram(const Scene& scene, const SceneArrays& arrays, const FieldSet& fields, const std::string& selector,
              const GripBackendOptions& options);
  Device& device() override { return on; }

  // Dispatches the kernels of a chunk whose buffers are bound. `best`: how many candidates to select among grips with a score above `floor_score`.
  // Efforts are computed only for grips whose score may reach `least_score`.
  void record(std::size_t vessel, const Chunk& chunk, std::size_t best, double floor_score, double least_score, Commands& commands);

  std::vector<const Kernel*> kernels() const;  // each once

  // Updates only the vessels' parameter blocks, in place. Requires that no chunk is in flight.
  void write_parameters(const SceneArrays& arrays);
  // Updates what depends on the vessels' fills: parameters and states. The number of fills must stay the same. Requires that no chunk is in flight.
  void write_fills(const Scene& scene, const SceneArrays& arrays);

  Device on;  // first: destroyed last
  Buffer hand;
  std::vector<VesselOnDevice> vessels;
  std::optional<Kernel> force, score, select;
  std::optional<Kernel> worst_effort, tips_effort, push_reserve, friction_reserve;  // in a scene with efforts
  double compile_seconds = 0;
  std::uint32_t forces_together = 1;  // grips per invocation of `force`
  std::uint32_t fill_count = 0, tilt_count = 0;
  FieldSet fields;      // the requested fields, and those that the kernels of a grip pass on
  int real_planes = 0;  // of a chunk: of the fields, and scratch

 private:
  Precision precision_;
  KernelBuild build_;
  bool has_efforts_ = false;
  int copied_count_ = 0;           // elements of every copied outline,
  std::uint32_t copied_arcs_ = 0;  // and a bit for each that is an arc in any vessel
  void upload_vessel(std::size_t v, const Scene& scene, const SceneArrays& arrays, const GripBackendOptions& options);
  struct GripKernel;
  std::vector<GripKernel> grip_kernels(std::size_t v, const Scene& scene, const SceneArrays& arrays,
                                       const GripBackendOptions& options);
  void upload_states(std::size_t v, const Scene& scene, const SceneArrays& arrays);
  std::vector<Buffer> upload_blocks(const std::vector<double>& states);
  void record_efforts(std::size_t v, std::uint32_t count, std::uint32_t stride, double least_score, Commands& commands) const;
};

}  // namespace wholehand::host
