// SPDX-License-Identifier: MIT
// The thread that speaks with Haply's Inverse Service: the newest force goes out, the newest state comes in, as fast as the service answers.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "device/grippers/haply_messages.h"
#include "device/grippers/haply_socket.h"
#include "device/loop/gripper.h"
#include "device/session/newest.h"

namespace wholehand::device {

constexpr double HAPLY_RATE = 4000;  // Hz: messages at most. The service itself answers faster.

// From its construction on, zero force goes to the devices until put() gives another one. Zero force also goes while the last put() is older than the
// watchdog, after drop() and release(), and while a signal or an exit ends the process (is_releasing()). One thread puts and takes: no call of it
// locks or allocates.
class HaplyExchange {
 public:
  // `idle` may be null: a second connection that stays silent, for panic(). Throws std::system_error: the system has no
  // thread or no descriptor left.
  HaplyExchange(std::unique_ptr<HaplySocket> socket, std::unique_ptr<HaplySocket> idle, const haply::Devices& devices,
                const haply::Version& version, double watchdog);
  ~HaplyExchange();
  HaplyExchange(const HaplyExchange&) = delete;
  HaplyExchange& operator=(const HaplyExchange&) = delete;

  // ---- of the one thread ----
  // The newest state since the last call, waiting for one at most `patience` s. False: none.
  bool take(haply::Measurement& into, double patience) noexcept;
  // The forces from now on, N in Haply's frame. They must be finite.
  void put(const std::array<Triple, 2>& forces) noexcept;

  // ---- of any thread ----
  // False: the connection is over, for good.
  bool is_open() const noexcept { return is_open_.load(); }
  // Why it is over; a text that stays valid.
  const char* ending() const noexcept { return ending_.load(); }
  // What was wrong with the last message, or ""; a text that stays valid.
  const char* wrong() const noexcept { return wrong_.load(); }
  // Zero force instead of all that was put so far (for_good: and of all that will be). Returns whether a message of the service has come after zero
  // force since, within `patience` s. It is the answer, unless the service also sends what nobody asked for.
  bool drop(bool for_good, double patience) noexcept;
  // The same in a signal handler, and by the idle connection too. Returns whether one of both took zero force.
  bool panic(double patience) noexcept;
  // Zero force for good, then the end of both connections.
  void stop() noexcept;
  std::int64_t wrong_count() const noexcept { return wrong_count_.load(); }
  std::int64_t unasked_count() const noexcept { return unasked_count_.load(); }
  bool has_idle() const noexcept { return idle_descriptor_.load() >= 0; }

 private:
  struct Put {
    std::array<Triple, 2> forces{};
    std::uint64_t number = 0;
    double moment = 0;  // s on the clock
  };
  void run() noexcept;
  bool exchange();
  void read();
  double away_from_put(double moment) const noexcept;
  bool wants_zero(const Put& newest) const noexcept;
  void tend_idle();

  std::unique_ptr<HaplySocket> socket_, idle_;
  const haply::Devices devices_;
  const haply::Version version_;
  const double watchdog_;   // s
  const std::string zero_;  // the message
  const std::string zero_frame_;
  std::atomic<int> idle_descriptor_;  // -1: none
  const int arrived_;                 // an eventfd: a state has arrived
  Newest<haply::Measurement> measured_;
  Newest<Put> put_;
  std::uint64_t put_number_ = 0;  // of the one thread
  // of the thread that speaks
  Put newest_;
  double interval_ = 0;           // s between two puts; 0: unknown
  std::string text_, next_;       // messages
  std::int64_t owed_ = 0;         // answers that have not come
  std::int64_t unconfirmed_ = 0;  // answers until the next one is to zero force
  int surplus_ = 0;               // unasked messages, less the answers since
  double tended_ = 0;             // s on the clock
  static constexpr std::uint64_t ALL = ~std::uint64_t{0};
  std::atomic<std::uint64_t> last_put_{0}, dropped_{0};  // numbers
  std::atomic<std::uint64_t> zeros_{0};                  // answers to messages with zero force
  std::atomic<bool> is_open_{true}, is_over_{false};
  std::atomic<const char*> wrong_{""}, ending_{"the service closed the connection"};
  std::atomic<std::int64_t> wrong_count_{0}, unasked_count_{0};
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "read in a signal handler");
  std::thread thread_;
};

}  // namespace wholehand::device
