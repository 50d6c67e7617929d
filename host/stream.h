// SPDX-License-Identifier: MIT
// Many items through a device in chunks, so that memory is bounded whatever their number and no submit is long: the host fills one
// chunk and takes another's results while the device computes. Results come in ascending order and none is dropped: a chunk whose
// device fails is evaluated again on a fresh one, then by the caller's fallback.
//
// Example: y = 2 x for ten million x.
//
//   struct Doubling : Program {
//     Device on{"vulkan"};
//     Kernel kernel{on, words, {}, "doubling"};   // push constants: uint n
//     Device& device() override { return on; }
//   };
//   Stream stream([] { return std::make_unique<Doubling>(); });
//   StreamRequest request;
//   request.last = x.size();
//   request.inputs = {{.binding = 0, .bytes_per_item = 4}};
//   request.outputs = {{.binding = 1, .bytes_per_item = 4, .kept_per_item = 4}};
//   request.fill = [&](const Chunk& chunk, const ChunkInputs& inputs) {
//     std::copy_n(x.begin() + chunk.first, chunk.count, elements<float>(inputs[0]).begin());
//   };
//   request.record = [](Program& program, const Chunk& chunk, Commands& commands) {
//     auto& [on, kernel] = static_cast<Doubling&>(program);
//     commands.dispatch(kernel, groups_for(on, kernel, chunk.count), static_cast<std::uint32_t>(chunk.count));
//   };
//   request.sink = [&](const Chunk& chunk, const ChunkOutputs& outputs) {
//     std::copy_n(elements<const float>(outputs[0]).begin(), chunk.count, y.begin() + chunk.first);
//   };
//   const StreamResult result = stream.run(request);
#pragma once

#include <memory>

#include "host/stream_request.h"

namespace wholehand::host {

class Stream {
 public:
  // Makes the program at once, and again after a device failure. Errors of this first call go to the caller.
  explicit Stream(ProgramFactory factory, StreamOptions options = {});
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  Program& program();  // the current program, for what runs once; a fault replaces it

  // Keeps memory and chunk size between runs. An exception from a callback ends the run after the chunks in flight.
  StreamResult run(const StreamRequest& request);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace wholehand::host
