// SPDX-License-Identifier: MIT
// What a stream (host/stream.h) is asked for, and what it answers.
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

// What runs on one device: the device (declared first, so that it is destroyed last), its kernels, and buffers that all chunks
// share.
class Program {
 public:
  virtual ~Program() = default;
  virtual Device& device() = 0;
};
using ProgramFactory = std::function<std::unique_ptr<Program>()>;

// Items [first, first + count). Field f of item i is element f * stride + i - first of a buffer: planes of `stride` elements, so
// that keeping the first planes is one copy. The stride is the count rounded up to StreamOptions::item_multiple.
struct Chunk {
  std::uint64_t first = 0;
  std::size_t count = 0;
  std::size_t stride = 0;
};

// A buffer that each chunk has of its own, of bytes_per_item * stride (+ fixed_bytes) bytes.
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
using ChunkOutputs = std::span<const std::span<const std::byte>>;  // one each of StreamRequest::outputs; what is kept
template <class T, class Byte>
std::span<T> elements(std::span<Byte> bytes) {
  return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

enum class SubmitFault { none, out_of_memory, device_lost, timeout };

struct StreamOptions {
  double target_seconds = 0.05;    // of device time a chunk: desktop drivers kill submits of seconds
  std::size_t first_items = 1024;  // in the first chunk; then at most 4 times the last, towards target_seconds
  std::size_t item_multiple = 64;
  std::size_t slot_bytes = std::size_t(64) << 20;  // of all buffers of one chunk in flight
  std::size_t slots = 0;        // chunks in flight; 0: 2 with unified memory, else 3 (one in each direction, one computing)
  double timeout_seconds = 10;  // beyond the expected time of a chunk: the device counts as hung
  std::function<SubmitFault(std::size_t submit)> inject;  // tests: what becomes of the n-th submit of the stream
};

struct StreamRequest {
  std::uint64_t first = 0, last = 0;  // items [first, last)
  std::vector<StreamInput> inputs;
  std::vector<StreamOutput> outputs;
  // Writes the chunk's inputs, right into memory that the device reads or copies: write only.
  std::function<void(const Chunk&, const ChunkInputs&)> fill;
  // Dispatches what computes the chunk; its own buffers are bound already.
  std::function<void(Program&, const Chunk&, Commands&)> record;
  // Takes the results, in ascending order, on the calling thread; they are valid during the call.
  std::function<void(const Chunk&, const ChunkOutputs&)> sink;
  // Computes a chunk without the device; empty: the stream throws Error instead. Writes what would be kept.
  std::function<void(const Chunk&, std::span<const std::span<std::byte>>)> fallback;
  const std::atomic<bool>* stop = nullptr;  // set: finish the chunks in flight, deliver them, return
};

struct StreamResult {
  std::uint64_t items = 0;  // delivered; those of fallback included
  std::uint64_t items_by_fallback = 0;
  std::uint64_t chunks = 0;
  std::size_t largest_chunk = 0;  // items
  std::size_t slot_bytes = 0;     // allocated for chunks in flight, at most
  double kernel_seconds = 0;      // device time in kernels, with their compilation where the driver does it at first use
  std::uint64_t bytes_in = 0, bytes_out = 0;  // filled and read back
  std::vector<std::string> notes;             // what went wrong and was mended, a line each
};

}  // namespace wholehand::host
