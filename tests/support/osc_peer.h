// SPDX-License-Identifier: MIT
// A hand over the network, as liblo reads what it hears.
#pragma once

#include <gtest/gtest.h>
#include <lo/lo.h>

#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/system/udp.h"
#include "core/scene.h"
#include "device/grippers/osc_gripper.h"
#include "device/loop/gripper.h"
#include "tests/support/osc_words.h"

namespace wholehand {

// What a hand hears.
struct HeardForce {
  std::int32_t number = -1, heard = -1, state = -2;
  std::array<float, 4> force{};  // arm, grip, N
  std::string bytes;             // of the datagram
  bool is_zero() const { return force == std::array<float, 4>{}; }
};

class OscPeer {
 public:
  OscPeer() : socket_(AF_INET, "peer") { EXPECT_EQ(socket_.bind(find_udp_address({"127.0.0.1", 0}, "peer")), 0); }

  int port() const { return socket_.address().port(); }
  void send(const std::string& bytes, int to) const {
    EXPECT_TRUE(socket_.send({bytes.data(), bytes.size()}, find_udp_address({"127.0.0.1", to}, "peer")));
  }

  // The next message, waiting for it so long, s. Nothing: none comes.
  std::optional<HeardForce> hear(double patience = 10) const {
    std::string room(2000, 0);
    UdpAddress from;
    if (!socket_.wait(patience)) return std::nullopt;
    const std::int64_t size = socket_.receive({room.data(), room.size()}, from);
    if (size < 0) return std::nullopt;
    int result = 0;
    const lo_message message = lo_message_deserialise(room.data(), static_cast<std::size_t>(size), &result);
    if (!message) {
      ADD_FAILURE() << "liblo reads no message: " << result;
      return std::nullopt;
    }
    HeardForce heard;
    heard.bytes = room.substr(0, static_cast<std::size_t>(size));
    EXPECT_STREQ(room.data(), "/wholehand/gripper/force");
    const std::string types = lo_message_get_types(message);
    EXPECT_EQ(types, "iiffffi");
    if (types == "iiffffi") {
      lo_arg** values = lo_message_get_argv(message);
      std::memcpy(&heard.number, values[0], 4);
      std::memcpy(&heard.heard, values[1], 4);
      for (std::size_t k = 0; k < 4; ++k) std::memcpy(&heard.force[k], values[2 + k], 4);
      std::memcpy(&heard.state, values[6], 4);
    }
    lo_message_free(message);
    return heard;
  }
  // All that are there, the last of them `wanted` (waiting for it).
  HeardForce hear_until(const std::function<bool(const HeardForce&)>& wanted) const {
    while (const auto heard = hear())
      if (wanted(*heard)) return *heard;
    ADD_FAILURE() << "what was waited for did not come";
    return {};
  }

 private:
  UdpSocket socket_;
};

inline int port_of(const std::string& address) { return std::stoi(address.substr(address.rfind(':') + 1)); }

// An open gripper to which a peer has sent `words`, at a port of its own.
inline std::unique_ptr<device::Gripper> open_said(const Scene& scene, const OscPeer& peer, const std::vector<std::string>& words,
                                                  double patience = 10) {
  return device::open_osc(
      {"127.0.0.1", 0}, scene,
      [&](const std::string& line) {
        const std::size_t at = line.find(": waiting");
        if (at == std::string::npos) return;
        for (const std::string& datagram : words) peer.send(datagram, port_of(line.substr(0, at)));
      },
      patience);
}

}  // namespace wholehand
