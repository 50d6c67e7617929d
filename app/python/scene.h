// SPDX-License-Identifier: MIT
// A scene as Python holds it: its parsed text, and what was computed from it, kept for the next call.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"
#include "core/scene.h"
#include "sweeps/plan/variables.h"

namespace wholehand {

// Evaluates some variables of many grips of a scene. One request at a time.
struct Batch {
  std::vector<const sweeps::Variable*> variables;  // in the order asked
  std::unique_ptr<Backend> backend;
  std::timed_mutex in_use;
};

// What a batch computes, and where. `variables` absent: a sweep's default ones.
struct BatchSpec {
  std::optional<std::vector<std::string>> variables;
  std::string on = "core";
  Precision precision = Precision::full;
  int threads = 0;
  bool operator==(const BatchSpec&) const = default;
};

// Any thread may call every method, without the interpreter's lock.
class SceneHandle {
 public:
  explicit SceneHandle(Scene scene) : described_(std::move(scene)) {}

  // As parsed, with meshes unread.
  const Scene& described() const { return described_; }
  // With its meshes, which the first call for this device reads. The reference lives as long as the object. Throws Error.
  const Scene& whole(const std::string& on = "core");
  // The reference evaluator of the whole scene.
  std::shared_ptr<const Evaluator> core();
  // Keeps the backends of the last few specs.
  std::shared_ptr<Batch> batch(const BatchSpec& spec);
  // The program's standard-error notes about the scene, one line each.
  std::vector<std::string> notes();
  // The same for float's domain, with the remedy; empty in double.
  std::vector<std::string> float_notes(Precision precision);

 private:
  static constexpr std::size_t KEPT_BATCHES = 4;  // a device holds buffers for each

  const Scene& whole_locked(const std::string& on);

  const Scene described_;
  std::mutex mutex_;                                          // guards all below
  std::map<std::string, std::unique_ptr<const Scene>> read_;  // of a scene with meshes, by device
  std::vector<std::string> mesh_notes_;
  std::shared_ptr<const Evaluator> core_;
  std::optional<std::vector<std::string>> float_notes_;
  std::list<std::pair<BatchSpec, std::shared_ptr<Batch>>> batches_;  // the latest first
};

// The variables of these names, in order. Throws Error (usage) that begins with `place` if one is unknown or the scene lacks what it needs.
std::vector<const sweeps::Variable*> named_variables(const Scene& scene, const std::vector<std::string>& names,
                                                     const std::string& place);

// Call before opening or using a device: sets the variables that its driver reads from the environment. Hold the interpreter's lock, which guards the
// environment. Throws Error (failure) in a process that was forked from one with a device.
void prepare_device(const std::string& on);

// Whether an ancestor of this forked process has called prepare_device for a device.
bool is_forked_from_device();

// Like the program's option --precision: "float" or "double"; absent: double on the core, float on a device.
Precision precision_of(const std::optional<std::string>& text, const std::string& on);

// Like the program's option --threads; 0: all.
int checked_threads(int threads);

}  // namespace wholehand
