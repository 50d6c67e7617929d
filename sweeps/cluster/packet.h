// SPDX-License-Identifier: MIT
// Values as bytes, for messages between ranks of the same program.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace wholehand::sweeps {

class PacketWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void put(const std::string& text) {
    put(text.size());
    bytes_ += text;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Takes values in the order in which they were put. Throws std::runtime_error if the packet ends too early.
class PacketReader {
 public:
  explicit PacketReader(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    copy(&value, sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> take_all() {
    std::vector<T> values(count(sizeof(T)));
    copy(values.data(), values.size() * sizeof(T));
    return values;
  }
  std::string take_text() {
    std::string text(count(1), '\0');
    copy(text.data(), text.size());
    return text;
  }

 private:
  std::size_t count(std::size_t size) {
    const auto wanted = take<std::size_t>();
    if (wanted > (bytes_.size() - place_) / size) throw std::runtime_error("a message between ranks ends too early");
    return wanted;
  }
  void copy(void* to, std::size_t size) {
    if (size > bytes_.size() - place_) throw std::runtime_error("a message between ranks ends too early");
    bytes_.copy(static_cast<char*>(to), size, place_);
    place_ += size;
  }

  std::string bytes_;
  std::size_t place_ = 0;
};

}  // namespace wholehand::sweeps
