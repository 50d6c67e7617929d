// SPDX-License-Identifier: MIT
// Runs the kernels on a Vulkan device: a scene's tables, its kernels, and a stream of grips.
#pragma once

#include <functional>
#include <memory>

#include "core/backend.h"
#include "core/evaluator.h"
#include "host/device.h"
#include "host/grip_options.h"

namespace wholehand::host {

// What the backend omitted because the scene does not need it, and how it reads the outline; for `--explain`.
struct GripPipelines {
  OutlineSource outline = OUTLINE_COPIED;
  bool force = false;
  int real_planes = 0, uint_planes = 0;  // per grip, kept and scratch
};

class GripBackend final : public Backend {
 public:
  // `core` evaluates the same scene (with the same EvaluatorOptions). It provides the vessels' constants, and computes chunks that no device can.
  // `selector`: see choose_device. Throws Error: no such device, or no double precision on it.
  GripBackend(const Scene& scene, std::shared_ptr<const Evaluator> core, const FieldSet& fields, const std::string& selector,
              const GripBackendOptions& options = {});
  ~GripBackend() override;

  const BackendInfo& info() const override;
  const FieldSet& fields() const override;
  RunResult run(const RunRequest& request) override;
  std::vector<LiquidResult> liquid(std::size_t vessel) override;
  // Computes the vessels' liquid again, on the core; the device and its pipelines stay. Not during a run.
  bool use_fills_of(const Scene& other) override;

  GripPipelines pipelines(std::size_t vessel) const;
  const DeviceInfo& device() const;
  // Bytes of a chunk's buffers per grip: inputs and planes.
  std::size_t bytes_per_grip() const;
  // Bytes on the device that all grips share: outlines or lattices, hand, states.
  std::size_t table_bytes() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace wholehand::host
