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
  OutlineSource outline = OUTLINE_COPIED;  // the small build, and outlines of more than MAX_OUTLINE elements, take OUTLINE_BUFFER
  std::optional<KernelBuild> build{};      // in place of what suits the device, to compare
  EvaluatorOptions evaluator;              // as the core's: lattice instead of outline, tolerances, ..
  DeviceOptions device;
  CompileWatch compile_watch{};  // called while kernels are compiled
  StreamOptions stream;
  // Grips of an invocation of the kernel of forces; 0: what suits the device. The bits are the same.
  std::uint32_t forces_together = 0;
  std::span<const EmbeddedShader>
      shaders{};  // in place of those of the same name that the program has, to compare; they outlive the backend
};

}  // namespace wholehand::host
