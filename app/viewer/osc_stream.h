// SPDX-License-Identifier: MIT
// Streams a session to engines and patches, as Open Sound Control over UDP: docs/stream.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/viewer/frame.h"
#include "base/system/osc_bundle.h"
#include "base/system/udp.h"
#include "device/session/session.h"
#include "sweeps/grips/hand_nodes.h"

namespace wholehand {

// Parses osc://HOST:PORT, with an IPv6 HOST in brackets. Throws Error (usage) in the name of --stream.
HostPort parse_osc_url(const std::string& url);

// Sends frames without checking whether anybody receives them.
class OscStream final : public device::Display {
 public:
  // `live` must outlive it. Throws Error (failure): the host is not known, or there is no socket.
  OscStream(const HostPort& target, const device::LiveScene& live);
  OscStream(const OscStream&) = delete;
  OscStream& operator=(const OscStream&) = delete;

  // A line that the user must see: the session goes to another machine. Empty: it does not.
  const std::string& note() const { return note_; }

  // Sends a frame, in as many datagrams of DATAGRAM bytes as needed. A datagram that the system does not take at once, or that nobody receives, is
  // lost. Never waits.
  void show(const device::DisplayMoment& moment) noexcept override;

  // Bytes: fits any network between two machines unfragmented, and any receiver's buffer.
  static constexpr std::size_t DATAGRAM = 1400;

 private:
  struct Named {
    std::string pose, liquid;  // addresses
    Quaternion turn{};         // that was sent last
  };
  void put(std::string_view address, std::span<const OscValue> values) noexcept;
  void put(std::string_view address, std::initializer_list<OscValue> values) noexcept {
    put(address, std::span<const OscValue>(values.begin(), values.size()));
  }
  void put_pose(std::string_view address, const Triple& place, const Quaternion& turn, Quaternion& before) noexcept;
  void flush() noexcept;
  void put_hand(const device::DisplayMoment& moment) noexcept;
  void put_vessels(const device::Tick& tick, const device::VesselPoses& poses) noexcept;
  void put_forces(const device::DisplayMoment& moment) noexcept;
  void put_holding(const std::optional<device::HandHold>& hold) noexcept;
  void put_task(const device::Tick& tick) noexcept;
  void put_advice(const device::Advice& advice, const device::VesselPoses& poses) noexcept;
  void put_ghost(const GhostHand& ghost) noexcept;

  const device::LiveScene& live_;
  std::string note_;
  UdpAddress to_;
  UdpSocket socket_;
  std::array<std::string, JOINT_COUNT> joints_;
  std::array<Quaternion, JOINT_COUNT + 1> turns_{};  // of joints and wrist, as last sent
  std::array<std::string, JOINT_COUNT> ghost_joints_;
  std::array<Quaternion, JOINT_COUNT + 1> ghost_turns_{};
  std::vector<Named> vessels_;
  std::vector<std::string> amounts_;  // addresses
  OscBundle bundle_{DATAGRAM};
  std::int32_t tick_ = 0;  // of the frame
  float time_ = 0;         // s
};

}  // namespace wholehand
