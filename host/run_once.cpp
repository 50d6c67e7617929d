// SPDX-License-Identifier: MIT
#include "host/run_once.h"

#include <chrono>

#include "host/step_recorder.h"

namespace wholehand::host {

double run_once(const Device& device, const Commands& commands) {
  DeviceState& on = device.state();
  return checked("running a kernel", [&] {
    StepRecorder recorder(on, on.compute.family);
    recorder.begin();
    recorder.steps(commands);
    recorder.end();
    const auto start = std::chrono::steady_clock::now();
    submit_and_wait(on, recorder);
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    return recorder.seconds() >= 0 ? recorder.seconds() : waited.count();
  });
}

}  // namespace wholehand::host
