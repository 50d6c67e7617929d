// SPDX-License-Identifier: MIT
// Chooses core or device for `--on auto`, by the rule of docs/method.md, "Core or device".
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.h"
#include "host/device_info.h"
#include "sweeps/plan/variables.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand::sweeps {

inline constexpr const char* ON_AUTO = "auto";

// What determines how long a sweep takes.
struct Workload {
  std::uint64_t grips = 0;  // of all vessels
  std::size_t states = 0;   // of each grip
  bool has_efforts = false;
  bool is_robust = false;
  bool has_reserves = false;  // tips_worst_effort, push or friction_needed of each grip
};

Workload workload_of(const Scene& scene, const std::vector<const Variable*>& variables, std::uint64_t grips);

// Expected seconds on the core, and on llvmpipe once its kernels are compiled.
double core_seconds(const Workload& work, int threads);
double cpu_driver_seconds(const Workload& work, int threads, Precision precision);

// Whether the core needs a second or more, about the time that opening a device takes.
bool pays_for_device(const Workload& work, int threads);

// `on` as the user names it. An absent precision is double on the core, float elsewhere.
BackendChoice named_backend(const std::string& on, const std::optional<Precision>& precision);

// Chooses the core or the best of `devices`. `threads` is for the core; 0 means all. `precision` is absent if the user names none.
BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision,
                             const std::vector<host::DeviceInfo>& devices);

// Chooses among the devices of this machine, which are listed only if one may be chosen. Falls back to the core if there is none. Does not throw.
BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision);

// The choice for a sweep, meshes unread. With ON_AUTO, a resumed sweep keeps the backend and precision with which it began. The sweep itself later
// refuses invalid scenes.
BackendChoice choose_backend(const Scene& scene, const SweepOptions& options);

// Does `work` where the choice says, and returns the choice. If the program itself chose a device and that fails, does it on the core, and a
// note says so. If the core fails too, the device was not the cause, and only the core's error is reported.
BackendChoice with_core_fallback(const BackendChoice& choice, const SweepHooks& hooks,
                                 const std::function<void(const BackendChoice&)>& work);

}  // namespace wholehand::sweeps
