// SPDX-License-Identifier: MIT
// One chunk in flight: its buffers, command buffers and synchronization; for host/ alone.
#pragma once

#include "host/step_recorder.h"
#include "host/stream_request.h"

namespace wholehand::host {

class Slot {
 public:
  // Room for chunks of up to `capacity` items (a stride). Throws OutOfMemory.
  Slot(DeviceState& device, const StreamRequest& request, std::size_t capacity);
  ~Slot();

  // Bytes of a slot per item, and independent of items, staging included.
  static std::pair<std::size_t, std::size_t> bytes(const DeviceState& device, const StreamRequest& request);
  // Largest capacity within the device's buffer limits.
  static std::size_t largest_capacity(const DeviceInfo& device, const StreamRequest& request);

  void submit(const Chunk& chunk, const StreamRequest& request, Program& program);
  bool wait(double seconds);  // false: not finished within that time
  double seconds() const;     // device time in kernels, valid after wait; negative if the device has no timestamps
  void deliver(const StreamRequest& request) const;

  Chunk chunk;
  SubmitFault fault = SubmitFault::none;  // fault to simulate at the wait
  double submitted = 0;                   // when, s of the clock
  std::uint64_t bytes_in = 0, bytes_out = 0;

 private:
  // If a device buffer is not mapped (or is slow to read), the host has a second buffer, and the device copies.
  struct Pair {
    Buffer on_device, on_host;
    std::size_t bytes = 0;  // to copy
  };

  Commands fill_and_record(const StreamRequest& request, Program& program);
  void submit_upload();
  void record_download();
  void submit_compute();

  DeviceState& device_;
  std::vector<Pair> inputs_, outputs_;
  StepRecorder compute_;
  std::optional<CommandRecorder> upload_, download_;
  vk::raii::Semaphore uploaded_, computed_;
  vk::raii::Fence done_;
};

}  // namespace wholehand::host
