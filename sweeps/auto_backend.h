// SPDX-License-Identifier: MIT
// Where a sweep runs that leaves this to the program (`--on auto`).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/backend.h"
#include "core/error.h"
#include "host/device_info.h"
#include "sweeps/closing.h"
#include "sweeps/cost_model.h"
#include "sweeps/sweep_options.h"

namespace wholehand {

inline constexpr const char* ON_AUTO = "auto";

// Why the device cannot compute in the precision that is asked for, half a sentence; "" where it can.
std::string precision_trouble(const host::DeviceInfo& device, const std::optional<Precision>& precision);

// Decides when it is made, before meshes are read; `options.on` then says core or a device, and `options.choice` why. Where `options.on`
// is not ON_AUTO it only keeps the times. A sweep that is resumed goes on where it began, with the precision that it began with.
class AutoBackend {
 public:
  // Both must outlive the object. Throws Error (usage) where cache_limit() does. A scene that no sweep takes is refused later, by the sweep.
  AutoBackend(const Scene& scene, SweepOptions& options);

  // What `work` makes of options.on. Where the program chose the device itself and that fails, options.on becomes the core, and `work` is
  // done again; then a note says so. Where the core fails too, it was not the device, and only the core's error is reported.
  template <class Work>
  auto or_on_core(Work&& work) {
    if (!may_change_) return work();
    std::string why;
    try {
      return work();
    } catch (const Error& error) {
      why = error.what();
    }
    take_core();
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      say_on_core(why);
    } else {
      auto made = work();
      say_on_core(why);
      return made;
    }
  }

  // Keeps what the sweep took, for later choices. Without a cache nothing is kept.
  void remember(const SweepTimes& times, std::uint64_t grips, const BackendInfo& info);

  // How it decided, for --explain.
  std::string explanation() const;

 private:
  bool resume(const Scene& scene);
  void decide();
  CostEstimate device_cost();
  void take_core();
  void say_on_core(const std::string& why) const;

  SweepOptions& options_;
  SweepTask task_;
  std::string file_, file_trouble_, no_device_;
  std::vector<RunTime> history_;
  CostEstimate core_, device_;
  bool is_auto_ = false, may_change_ = false, keeps_times_ = false;
};

}  // namespace wholehand
