// Is the device's answer the core's answer? What `wholehand check` does.
#pragma once

#include <string>

#include "core/error.h"
#include "core/scene.h"
#include "host/device.h"

namespace wholehand {

struct CheckOptions {
  std::string on = "vulkan";  // see open_backend
  host::DeviceOptions device;
  const Scene* device_scene = nullptr;  // tests: what the device evaluates instead of the scene
};

// Compares the device with the core in float and in double, per kernel and whole, and prints a table with the worst case of every
// quantity. Returns `done` where all hold, `no` where one does not. Throws Error.
ExitCode run_check(const Scene& scene, const CheckOptions& options);

}  // namespace wholehand
