// SPDX-License-Identifier: MIT
// Computes many rendered walls at once on a device.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/wall_case.h"
#include "host/device.h"

namespace wholehand::host {

class WallMap {
 public:
  // Throws Error: no such device (as choose_device), no double precision on it.
  explicit WallMap(const std::string& selector, Precision precision = Precision::single, const DeviceOptions& options = {});
  ~WallMap();

  const DeviceInfo& device() const;
  // Equals core's late_energy for each case. Submits stay short and memory bounded for any number of samples and cases.
  std::vector<double> late_energies(std::span<const WallCase> cases, int samples, int late);
  double kernel_seconds() const;  // device time so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wholehand::host
