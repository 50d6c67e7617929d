// SPDX-License-Identifier: MIT
#include "host/run_once.h"

#include <cmath>
#include <limits>

#include "base/system/clock.h"
#include "host/step_recorder.h"
#include "shaders/layout.h"

namespace wholehand::host {
namespace {

// (1 + 2d) (1 + d) = 1 + 3d + 2 d^2. The last term is less than half of the last digit, so the rounded product is 1 + 3d, and the sum with -(1 + 3d)
// shows how often it was rounded.
template <class Real>
bool rounds(const Device& device, const Kernel& kernel) {
  const Real d = std::numeric_limits<Real>::digits == 24 ? std::ldexp(Real(1), -13) : std::ldexp(Real(1), -28);
  const Buffer numbers = Buffer::of(device, std::vector<Real>{1 + 2 * d, 1 + d, -(1 + 3 * d), 1});
  Commands commands;
  commands.bind(BINDING_REAL_OUT, numbers);
  commands.dispatch(kernel, {1, 1, 1});
  run_once(device, commands);
  return numbers.read_as<Real>(4)[3] == 0;
}

}  // namespace

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

std::vector<Precision> contracted_precisions(const Device& device, std::span<const EmbeddedShader> among) {
  std::vector<Precision> contracted;
  const std::vector<Constant> constants{{CONST_GROUP_SIZE, std::uint32_t(1)}};
  for (const Precision precision : {Precision::single, Precision::full}) {
    if (precision == Precision::full && !device.info().float64) continue;
    const Kernel kernel(device, find_shader("rounding", precision, BUILD_WIDE, OUTLINE_NONE, among), constants, "rounding");
    const bool is_rounded = precision == Precision::single ? rounds<float>(device, kernel) : rounds<double>(device, kernel);
    if (!is_rounded) contracted.push_back(precision);
  }
  return contracted;
}

}  // namespace wholehand::host
