// SPDX-License-Identifier: MIT
// The process behind a GuardedFile: reads the file with the NetCDF library and answers over a socket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace wholehand::sweeps::guarded {

constexpr std::size_t MOST_DIMENSIONS = 32;  // of a variable

// A block of a variable. The answer begins with NetCDF's status (int32); its values (double) follow unless the status is an error.
struct Request {
  std::int32_t variable = -1;
  std::uint64_t dimensions = 0;
  std::array<std::uint64_t, MOST_DIMENSIONS> start{}, count{};
};

// Whether `status` leaves the values usable: numbers out of a double's range are delivered all the same.
bool is_usable(int status);

// Send and receive everything; false: the other end is gone, or was silent for `seconds` (0: no limit).
bool send_all(int socket, const void* data, std::size_t size);
bool take_all(int socket, void* data, std::size_t size, int seconds);

// Opens the file and sends the resulting status; if it is good, also the catalogue: its size (uint64) and that many bytes. Then answers requests
// until the other end closes. Only for a child process: takes over its streams, limits and signals, and does not return.
[[noreturn]] void serve(int socket, const std::string& name);

// The catalogue: a sequence of entries, each a kind and the values that CatalogueReader reads after it.
enum class Entry : std::uint32_t { variable, text, number };

// Parses a catalogue. Throws std::runtime_error if it ends too early.
class CatalogueReader {
 public:
  explicit CatalogueReader(const std::string& bytes) : bytes_(bytes) {}
  bool is_at_end() const { return place_ == bytes_.size(); }
  template <class T>
  T value() {
    T result{};
    copy(&result, sizeof result);
    return result;
  }
  std::string text();

 private:
  void copy(void* to, std::size_t size);
  const std::string& bytes_;
  std::size_t place_ = 0;
};

}  // namespace wholehand::sweeps::guarded
