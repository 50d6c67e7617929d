// SPDX-License-Identifier: MIT
// Chooses core or device for `--on auto`, by the rule of docs/method.md, "Core or device".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/text/error.h"
#include "core/backend.h"
#include "host/device_info.h"
#include "sweeps/plan/variables.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand {

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

struct BackendChoice {
  std::string on = "core";  // or "vulkan"
  std::string alternative;  // the other's time or what it lacks; completes the sentence of backend_line
};

// Chooses the core or the best of `devices`. `threads` is for the core; 0 means all. `precision` is absent if the user names none.
BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision,
                             const std::vector<host::DeviceInfo>& devices);

// Chooses among the devices of this machine, which are listed only if one may be chosen. Falls back to the core if there is none. Does not throw.
BackendChoice choose_backend(const Workload& work, int threads, const std::optional<Precision>& precision);

// Decides on construction, before meshes are read; `options.on` then names core or a device, and `options.alternative` gives the other's time. Does
// nothing unless `options.on` is ON_AUTO. A resumed sweep keeps the backend and precision with which it began.
class AutoBackend {
 public:
  // `options` must outlive the object. The sweep itself later refuses invalid scenes.
  AutoBackend(const Scene& scene, SweepOptions& options);

  // Returns what `work` makes of options.on. If the program itself chose a device and that fails, options.on becomes the core, `work` runs again, and
  // a note says so. If the core fails too, the device was not the cause, and only the core's error is reported.
  template <class Work>
  auto with_core_fallback(Work&& work) {
    if (!may_change_) return work();
    std::string why;
    try {
      return work();
    } catch (const Error& error) {
      why = error.what();
    }
    switch_to_core();
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      note_fallback(why);
    } else {
      auto made = work();
      note_fallback(why);
      return made;
    }
  }

 private:
  bool resume(const Scene& scene);
  void switch_to_core();
  void note_fallback(const std::string& why) const;

  SweepOptions& options_;
  bool may_change_ = false;
};

}  // namespace wholehand
