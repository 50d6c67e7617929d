// SPDX-License-Identifier: MIT
// Evaluates many grips: the core on threads, or a Vulkan device. Both give the same planes in the same order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/planes.h"
#include "core/result.h"

namespace wholehand {

enum class Precision { single, full };  // float, double

struct BackendInfo {
  std::string backend;  // "core" or "vulkan"
  std::string device;   // e.g. "llvmpipe (LLVM 15.0.6, 256 bits)", or "core, 2 threads"
  std::string driver;   // driver name and version; compiler for the core
  Precision precision = Precision::full;
  bool is_cpu = true;
  double compile_seconds = 0;  // time that opening it spent on kernels
};

// Writes the grips first .. first + count - 1 of a vessel's plan to `out`. Called from any thread.
using GripSource = std::function<void(std::size_t vessel, std::uint64_t first, std::size_t count, GripInput* out)>;

// Receives finished chunks in ascending order, on the thread that called run; the planes are valid during the call.
// Only the kept planes may be read.
using ChunkSink = std::function<void(const PlaneChunk&)>;

struct Candidate {
  double score = 0;
  std::uint64_t index = 0;  // of the grip within its vessel's plan
};

constexpr double NO_LEAST_SCORE = -1;  // below every score

struct RunRequest {
  std::size_t vessel = 0;
  std::uint64_t first = 0, last = 0;  // grips [first, last)
  GripSource grips;
  ChunkSink sink;        // may be empty when nothing is kept
  std::size_t best = 0;  // candidates wanted, by score descending, then index ascending; only eligible ones (shaders/status.h)
  // The lowest score that the caller wants, which may rise during the run. A grip whose score stays below it at any effort gets no efforts: its
  // status has STATUS_UNJUDGED, its score is 0, and its efforts are NaN. Null: every plausible grip gets efforts.
  const std::atomic<double>* least_score = nullptr;
  const std::atomic<bool>* stop = nullptr;  // set: finish the chunks under way, deliver them, return
};

struct RunResult {
  std::vector<Candidate> best;
  std::uint64_t done = 0;  // grips delivered
  std::uint64_t chunks = 0;
  double kernel_seconds = 0;       // time of the device (or the core's threads) in kernels
  std::vector<std::string> notes;  // "out of memory: chunks of 4096", "device lost: ..."; each once
};

class Backend {
 public:
  virtual ~Backend() = default;
  virtual const BackendInfo& info() const = 0;
  virtual const FieldSet& fields() const = 0;
  virtual RunResult run(const RunRequest& request) = 0;
  // Liquid of a vessel over the scene's fills and tilts, fill-major; empty if the scene has none.
  virtual std::vector<LiquidResult> liquid(std::size_t vessel) = 0;
  // Continues as if opened with `other`, which may differ only in the values, not the number, of the vessels' fills. The results have the same bits,
  // and this costs much less than opening a device. Returns false, and changes nothing, if `other` does not qualify.
  virtual bool use_fills_of(const Scene& /*other*/) { return false; }
};

}  // namespace wholehand
