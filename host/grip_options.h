// SPDX-License-Identifier: MIT
// How grips are computed on a device.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/backend.h"
#include "core/evaluator.h"
#include "host/compile.h"
#include "host/device.h"
#include "host/shaders.h"
#include "host/stream_request.h"

namespace wholehand::host {

struct GripBackendOptions {
  Precision precision = Precision::single;
  OutlineSource outline = OUTLINE_COPIED;  // the small build, and outlines of more than MAX_OUTLINE elements, use OUTLINE_BUFFER
  std::optional<KernelBuild> build{};      // overrides what suits the device, to compare
  EvaluatorOptions evaluator;              // as for the core: lattice instead of outline, tolerances, ..
  DeviceOptions device;
  CompileWatch compile_watch{};  // called while kernels are compiled
  StreamOptions stream;
  // Grips per invocation of the force kernel; 0: what suits the device. The bits are the same.
  std::uint32_t forces_together = 0;
  std::span<const EmbeddedShader>
      shaders{};  // replace the program's shaders of the same name, to compare; they outlive the backend
};

}  // namespace wholehand::host
