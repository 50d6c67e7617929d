// SPDX-License-Identifier: MIT
// Memory that kernels read and write.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "host/device.h"

namespace wholehand::host {

struct BufferState;  // vulkan.h

enum class Memory {
  device,    // fast for kernels; the host accesses it directly only in unified memory
  upload,    // the host writes, the device copies from it
  readback,  // the device copies to it, the host reads
};

// A buffer that a kernel may bind as storage or as uniform. Its contents are undefined until written. Throws OutOfMemory if the memory is refused or
// exceeds the device's limit for one allocation.
class Buffer {
 public:
  Buffer();
  Buffer(const Device& device, std::size_t bytes, Memory memory = Memory::device);
  Buffer(DeviceState& device, std::size_t bytes, Memory memory);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  // A device buffer with a copy of `values`.
  template <class T>
  static Buffer of(const Device& device, const std::vector<T>& values) {
    Buffer buffer(device, values.size() * sizeof(T));
    buffer.write(values);
    return buffer;
  }

  std::size_t size() const;             // bytes asked for
  bool reads_fast() const;              // mapped, and reading the mapping is fast
  std::span<std::byte> mapped() const;  // empty if the host cannot access it

  // Copy to and from the start of any kind of buffer, and return when done. For small or rare data; stream.h handles chunks.
  void write(std::span<const std::byte> bytes);
  void read(std::span<std::byte> bytes) const;

  template <class T>
  void write(const std::vector<T>& values) {
    write(std::as_bytes(std::span(values)));
  }
  // The first `count` elements.
  template <class T>
  std::vector<T> read_as(std::size_t count) const {
    std::vector<T> values(count);
    read(std::as_writable_bytes(std::span(values)));
    return values;
  }

  BufferState& state() const { return *state_; }  // for host/ alone

 private:
  std::unique_ptr<BufferState> state_;
};

}  // namespace wholehand::host
