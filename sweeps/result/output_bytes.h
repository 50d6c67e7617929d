// SPDX-License-Identifier: MIT
// Writes the values of a result to their places in the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace wholehand::sweeps {

class OutputBytes {
 public:
  virtual ~OutputBytes() = default;
  // Both return 0, or the system's error number (errno).
  virtual int write(const void* data, std::size_t size, std::uint64_t offset) = 0;
  virtual int sync() = 0;  // returns when everything written is on the disk
};

// Opens an existing file. Throws Error (failure).
using OpenOutput = std::function<std::unique_ptr<OutputBytes>(const std::string& path)>;

}  // namespace wholehand::sweeps
