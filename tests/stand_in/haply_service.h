// SPDX-License-Identifier: MIT
// A stand-in for Haply's Inverse Service: devices that a test moves, the protocol as docs/devices.md has it, and what may go wrong with it. Unlike
// the documented service it keeps a force that nobody renews, and takes that of the last client alone: so a test sees what a client left behind.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wholehand::stand_in {

using Vector = std::array<double, 3>;

enum class HaplyFault {
  none,
  silent,     // takes messages, and answers none
  flood,      // two hundred states for each message
  no_json,    // half a message
  no_state,   // devices without their state
  no_number,  // NaN, which JSON does not have
  no_finite,  // a number beyond what a double holds
  vanished,   // the second device (or the grip) is not in the states any more
  foreign,    // states of somebody else's devices before and within the own ones
  split,      // frames in pieces, slowly
  closed,     // closes each connection at its next message
  skips_one,  // leaves one message without an answer
  halves,     // answers every second message
};

struct HaplyOptions {
  std::vector<std::string> sides{"left", "right"};  // of the Inverse3; their ids are 0A01, 0A02, ..
  bool has_grip = false;                            // a wireless VerseGrip 0B01
  std::string version = "3.5.0.0";                  // empty: no answer to GET /version
  bool is_old = false;                              // format 3.0
  bool says_nothing = false;                        // no inventory
  int port = 0;                                     // 0: any free one
};

// What the devices do at a time since the first client came, Haply's frame.
struct HaplyMotion {
  std::array<Vector, 4> cursors{};
  std::array<double, 4> orientation{1, 0, 0, 0};  // w, x, y, z
  bool is_pressed = false;                        // the grip's first button
};

class HaplyService {
 public:
  explicit HaplyService(const HaplyOptions& options);
  ~HaplyService();
  HaplyService(const HaplyService&) = delete;
  HaplyService& operator=(const HaplyService&) = delete;

  int port() const { return port_; }
  void misbehave(HaplyFault fault);
  // The same from within a motion.
  void misbehave_within(HaplyFault fault) { fault_ = fault; }
  // From now on. Without it, all devices rest at their origin.
  void move(std::function<HaplyMotion(double)> motion);
  void rest_at(const HaplyMotion& motion);

  // What the last message of any client has, N in Haply's frame; zero without a message.
  Vector force(std::size_t arm) const;
  bool has_force() const;
  std::size_t clients() const;
  std::int64_t messages() const;
  // Messages of all clients but the one that has sent the most, which is the one that speaks.
  std::int64_t other_messages() const;
  // A message of another client: what a second program would do with the first device.
  void push(const Vector& force);
  // Waits until it holds, a minute at most. Called again with each message.
  bool wait(const std::function<bool()>& holds) const;

 private:
  struct Connection;
  void accept();
  void serve(Connection& connection);
  void take(const std::string& text, Connection& connection);
  std::string state(bool is_inventory);
  bool answer(Connection& connection);

  const HaplyOptions options_;
  int listener_ = -1, port_ = 0;
  std::chrono::steady_clock::time_point start_{};  // the first client
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  HaplyFault fault_ = HaplyFault::none;
  std::function<HaplyMotion(double)> motion_;
  std::vector<Vector> forces_;
  std::int64_t messages_ = 0;
  std::size_t clients_ = 0;
  bool is_over_ = false;
  std::list<std::unique_ptr<Connection>> connections_;
  std::thread thread_;
};

}  // namespace wholehand::stand_in
