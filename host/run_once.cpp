// SPDX-License-Identifier: MIT
#include "host/run_once.h"

#include "host/step_recorder.h"
#include "system/clock.h"

namespace wholehand::host {

double run_once(const Device& device, const Commands& commands) {
  DeviceState& on = device.state();
  return checked("running a kernel", [&] {
    StepRecorder recorder(on, on.compute.family);
    recorder.begin();
    recorder.steps(commands);
    recorder.end();
    const double start = monotonic_now();
    submit_and_wait(on, recorder);
    const double waited = monotonic_now() - start;
    return recorder.seconds() >= 0 ? recorder.seconds() : waited;
  });
}

}  // namespace wholehand::host
