// SPDX-License-Identifier: MIT
// What the mocks of both transports need of umockdev; nobody else includes it.
#pragma once

#include <fmt/format.h>
#include <umockdev-1.0/umockdev.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "device/grippers/protocol.h"

namespace wholehand::umockdev {

template <class T>
struct Unref {
  void operator()(T* object) const { g_object_unref(object); }
};
using Data = std::unique_ptr<UMockdevIoctlData, Unref<UMockdevIoctlData>>;

// Thrown where a client ended in the midst of an exchange: nobody waits for its answer.
struct ClientGone {};

// What the pointer at `offset` of that memory points to, as memory of this process.
inline Data resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t size) {
  Data resolved(umockdev_ioctl_data_resolve(data, offset, size, nullptr));
  if (!resolved) throw ClientGone{};
  return resolved;
}

inline void complete(UMockdevIoctlClient* client, long result, int error = 0) {
  umockdev_ioctl_client_complete(client, error ? -1 : result, error);
}

inline std::string hex(device::protocol::Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

inline void add(UMockdevTestbed* testbed, const std::string& description) {
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(testbed, description.c_str(), &error)) return;
  std::fprintf(stderr, "umockdev: %s\n", error->message);
  std::abort();
}

}  // namespace wholehand::umockdev
