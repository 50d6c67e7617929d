// SPDX-License-Identifier: MIT
// Checks whether the device's answers are the core's: what `wholehand check` does.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "core/scene.h"
#include "evidence/check/compare.h"
#include "host/device.h"

namespace wholehand {

struct CheckOptions {
  std::string on = "vulkan";  // see open_backend
  host::DeviceOptions device;
  bool is_quiet = false;                // no progress on stderr
  const Scene* device_scene = nullptr;  // tests: evaluated by the device instead of the scene
};

// One quantity, and the place of its largest difference: a grip or, for the liquid, a fill and tilt (rad); nowhere if nothing differs.
struct CheckedQuantity {
  Comparison row;
  std::string vessel;
  std::optional<GripInput> grip;
  std::optional<std::array<double, 2>> state;
};

// Two sides over all grips.
struct CheckedPair {
  std::string name;      // "device_float_core_float"
  std::string question;  // what it answers
  std::vector<CheckedQuantity> quantities;
  std::uint64_t grips = 0, feasible = 0;
  std::uint64_t grazing = 0;   // left out
  std::uint64_t excluded = 0;  // a discrete outcome differs within the margin
  std::uint64_t allowed = 0;   // how many of these are no evidence
  bool holds = false;
};

struct CheckedVessel {
  std::string name;
  std::size_t own = 0, between = 0;  // the scene's grips, and added ones between and around them
};

struct CheckReport {
  std::string scene, device, driver;
  bool is_cpu = false, has_double = false;
  std::vector<std::string> contracted;  // precisions in which the driver contracts what a kernel declares `precise`
  std::vector<std::string> warnings;    // check_warnings
  std::vector<CheckedVessel> vessels;
  CheckedPair translation;           // device in float, core in float
  CheckedPair cost;                  // core in float, core in double
  bool is_of_precision = false;      // the first fails because of single precision, not because of the device
  std::optional<CheckedPair> exact;  // device in double, core in double; absent on a device without double
};

// The overall result of the comparisons.
struct CheckVerdict {
  bool holds = false;
  std::string text;
  std::string
      advice;  // what gives right numbers here, as the comparisons have shown; empty if the check holds or nothing was compared
};

// Lines on what exceeds float's domain in the scene, with the remedy.
std::vector<std::string> check_warnings(const Scene& scene);

// The error of a device, for a command that the core cannot help: the remedy is a sweep's.
Error check_error(const Error& error);

// Compares the device with the core in float and in double, per kernel and as a whole, on check_sample of every vessel. Throws Error: (usage) the
// core as a device, or what cannot be prepared; (failure) a device that does not answer; both as check_error.
CheckReport check_scene(const Scene& scene, const CheckOptions& options);

CheckVerdict verdict_of(const CheckReport& report);

// For people: the verdict in the first line, then a table of every comparison with the worst case of every quantity.
std::string check_text(const CheckReport& report);
// The same as one JSON object, "holds" first; docs/evidence.md has its keys.
std::string check_json(const CheckReport& report);

}  // namespace wholehand
