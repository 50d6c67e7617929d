// SPDX-License-Identifier: MIT
// The request and the result of a stream (host/stream.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/commands.h"

namespace wholehand::host {

// What runs on one device: the device (declared first, so destroyed last), its kernels, and buffers that all chunks share.
class Program {
 public:
  virtual ~Program() = default;
  virtual Device& device() = 0;
};
using ProgramFactory = std::function<std::unique_ptr<Program>()>;

// Items [first, first + count). Field f of item i is element f * stride + i - first of a buffer: planes of `stride` elements, so that one copy keeps
// the first planes. The stride is the count rounded up to StreamOptions::item_multiple.
struct Chunk {
  std::uint64_t first = 0;
  std::size_t count = 0;
  std::size_t stride = 0;
};

// A buffer of each chunk, of bytes_per_item * stride (+ fixed_bytes) bytes.
struct StreamInput {
  std::uint32_t binding = 0;
  std::size_t bytes_per_item = 0;
  bool operator==(const StreamInput&) const = default;
};
struct StreamOutput {
  std::uint32_t binding = 0;
  std::size_t bytes_per_item = 0;
  std::size_t kept_per_item = 0;  // the sink sees the first kept_per_item * stride + kept_fixed_bytes bytes; with 0 the buffer is
  std::size_t fixed_bytes = 0;    // scratch and stays on the device
  std::size_t kept_fixed_bytes = 0;
  bool operator==(const StreamOutput&) const = default;
};

using ChunkInputs = std::span<const std::span<std::byte>>;         // one each of StreamRequest::inputs
using ChunkOutputs = std::span<const std::span<const std::byte>>;  // one for each of StreamRequest::outputs; the kept part
template <class T, class Byte>
std::span<T> elements(std::span<Byte> bytes) {
  return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

enum class SubmitFault { none, out_of_memory, device_lost, timeout };

struct StreamOptions {
  double target_seconds = 0.05;    // device time per chunk: desktop drivers kill submits that last seconds
  std::size_t first_items = 1024;  // in the first chunk; then at most 4 times the last, towards target_seconds
  std::size_t item_multiple = 64;
  std::size_t slot_bytes = std::size_t(64) << 20;  // all buffers of one chunk in flight
  std::size_t slots = 0;        // chunks in flight; 0: 2 with unified memory, else 3 (one in each direction, one computing)
  double timeout_seconds = 10;  // added to a chunk's expected time; then the device counts as hung
  std::function<SubmitFault(std::size_t submit)> inject;  // tests: what happens to the stream's n-th submit
};

struct StreamRequest {
  std::uint64_t first = 0, last = 0;  // items [first, last)
  std::vector<StreamInput> inputs;
  std::vector<StreamOutput> outputs;
  // Writes the chunk's inputs directly into memory that the device reads or copies: write only.
  std::function<void(const Chunk&, const ChunkInputs&)> fill;
  // Dispatches the kernels that compute the chunk; its own buffers are already bound.
  std::function<void(Program&, const Chunk&, Commands&)> record;
  // Takes the results, in ascending order, on the calling thread; they are valid during the call.
  std::function<void(const Chunk&, const ChunkOutputs&)> sink;
  // Computes a chunk without the device, and writes what would be kept. If empty, the stream throws Error instead.
  std::function<void(const Chunk&, std::span<const std::span<std::byte>>)> fallback;
  const std::atomic<bool>* stop = nullptr;  // set: finish the chunks in flight, deliver them, return
};

struct StreamResult {
  std::uint64_t items = 0;  // delivered, including those of the fallback
  std::uint64_t items_by_fallback = 0;
  std::uint64_t chunks = 0;
  std::size_t largest_chunk = 0;              // items
  std::size_t slot_bytes = 0;                 // largest allocation for chunks in flight
  double kernel_seconds = 0;                  // device time in kernels, including compilation if the driver compiles at first use
  std::uint64_t bytes_in = 0, bytes_out = 0;  // filled and read back
  std::vector<std::string> notes;             // faults that were repaired, a line each
};

}  // namespace wholehand::host
