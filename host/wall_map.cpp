// SPDX-License-Identifier: MIT
#include "host/wall_map.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "host/buffer.h"
#include "host/run_once.h"
#include "host/shaders.h"
#include "host/turns.h"
#include "shaders/layout.h"

namespace wholehand::host {
namespace {

constexpr std::size_t CASES_AT_ONCE = std::size_t(1) << 17;
constexpr double SUBMIT_SECONDS = 0.05;

std::array<double, CASE_PLANES> numbers(const WallCase& c) {
  std::array<double, CASE_PLANES> of{};
  of[CASE_MASS] = c.mass;
  of[CASE_DAMPING] = c.damping;
  of[CASE_SPRING] = c.spring;
  of[CASE_WALL_STIFFNESS] = c.wall_stiffness;
  of[CASE_WALL_DAMPING] = c.wall_damping;
  of[CASE_PERIOD] = c.period;
  of[CASE_ENCODER] = c.encoder_step;
  of[CASE_FORCE_LIMIT] = c.force_limit;
  of[CASE_DELAY] = c.delay;
  of[CASE_BILATERAL] = c.is_bilateral ? 1 : 0;
  of[CASE_PRESS] = c.press;
  of[CASE_FRICTION] = c.friction;
  of[CASE_PLACE] = c.place;
  of[CASE_INTEGRATOR] = c.integrator;
  of[CASE_SUBSTEPS] = c.substeps;
  return of;
}

template <class Real>
std::vector<Real> planes_of(std::span<const WallCase> cases) {
  std::vector<Real> planes(CASE_PLANES * cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto values = numbers(cases[i]);
    for (int plane = 0; plane < CASE_PLANES; ++plane) planes[plane * cases.size() + i] = static_cast<Real>(values[plane]);
  }
  return planes;
}

}  // namespace

struct WallMap::Impl {
  Impl(const std::string& selector, Precision wanted, const DeviceOptions& options) : on(selector, options), precision(wanted) {
    if (precision == Precision::full && !on.info().float64) {
      throw usage_error("device " + on.info().name + " has no double precision", Remedy::float_precision);
    }
  }

  // A CPU driver executes branches that no case takes, so without friction its code is left out.
  const Kernel& kernel_for(bool rubs) {
    std::optional<Kernel>& kernel = rubs ? with_friction : without_friction;
    if (!kernel) {
      const std::array<Constant, 2> constants{Constant{CONST_GROUP_SIZE, std::uint32_t{GROUP_SIZE}},
                                              Constant{CONST_FRICTION, std::uint32_t{rubs ? 1u : 0u}}};
      kernel.emplace(on, find_shader("loop", precision), constants, "loop");
    }
    return *kernel;
  }

  template <class Real>
  void run(std::span<const WallCase> cases, int samples, int late, double* out) {
    const std::uint32_t count = static_cast<std::uint32_t>(cases.size());
    const Buffer given = Buffer::of(on, planes_of<Real>(cases));
    const Buffer state(on, CASE_STATE_PLANES * cases.size() * sizeof(Real));
    const bool rubs = std::any_of(cases.begin(), cases.end(), [](const WallCase& c) { return c.friction > 0; });
    const Kernel& kernel = kernel_for(rubs);
    const int substeps = std::ranges::max_element(cases, {}, &WallCase::substeps)->substeps;
    const int most = most_samples(rubs, substeps);
    if (most < 1) throw failure_error("internal: " + std::to_string(substeps) + " sub-steps of a sample", Remedy::core);
    int at_once = std::min(32, most);
    for (int done = 0; done < samples;) {
      const bool is_late = done >= samples - late;
      const int number = std::min(at_once, (is_late ? samples : samples - late) - done);
      Commands commands;
      commands.bind(BINDING_GRIPS, given);
      commands.bind(BINDING_REAL_OUT, state);
      const Push push{count, count, done == 0 ? 1u : 0u, static_cast<std::uint32_t>(number), 0, 0, is_late ? 1u : 0u};
      commands.dispatch(kernel, groups_for(on, kernel, count), push);
      const double taken = run_once(on, commands);
      seconds += taken;
      done += number;
      // at most four times the last, as chunks grow
      const double wanted = taken > 0 ? number * SUBMIT_SECONDS / taken : 4.0 * number;
      at_once = std::clamp(static_cast<int>(std::min(wanted, 4.0 * number)), 1, most);
    }
    // the place of the energy among the planes is the fourth
    const std::vector<Real> planes = state.read_as<Real>(CASE_STATE_PLANES * cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) out[i] = static_cast<double>(planes[3 * cases.size() + i]);
  }

  Device on;  // first: destroyed last
  Precision precision;
  std::optional<Kernel> with_friction, without_friction;
  double seconds = 0;
};

WallMap::WallMap(const std::string& selector, Precision precision, const DeviceOptions& options)
    : impl_(std::make_unique<Impl>(selector, precision, options)) {}
WallMap::~WallMap() = default;

const DeviceInfo& WallMap::device() const { return impl_->on.info(); }
double WallMap::kernel_seconds() const { return impl_->seconds; }

std::vector<double> WallMap::late_energies(std::span<const WallCase> cases, int samples, int late) {
  std::vector<double> energies(cases.size());
  for (std::size_t first = 0; first < cases.size(); first += CASES_AT_ONCE) {
    const auto part = cases.subspan(first, std::min(CASES_AT_ONCE, cases.size() - first));
    if (impl_->precision == Precision::full) {
      impl_->run<double>(part, samples, late, energies.data() + first);
    } else {
      impl_->run<float>(part, samples, late, energies.data() + first);
    }
  }
  return energies;
}

}  // namespace wholehand::host
