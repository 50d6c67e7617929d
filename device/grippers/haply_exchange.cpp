// SPDX-License-Identifier: MIT
#include "device/grippers/haply_exchange.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <exception>
#include <system_error>

#include "base/system/block_signals.h"
#include "base/system/clock.h"
#include "device/loop/panic.h"
#include "device/loop/realtime.h"

namespace wholehand::device {
namespace {

constexpr double SEND_PATIENCE = 0.1;                         // s: a service that reads nothing for so long is gone
constexpr double GOODBYE_PATIENCE = 0.1;                      // s
constexpr double QUIET_BEFORE = 200e-6, QUIET_AFTER = 30e-6;  // s, about a put(): as long as a message and its answer, and a step
constexpr double IDLE_PAUSE = 0.1;                            // s between two looks for a ping on the idle connection
constexpr double ANSWER_PATIENCE = 5e-3;  // s: a quarter of the watchdog, so that a silent service still gets zero force in time
constexpr int MOST_SURPLUS = 200;         // a flood hides which message is an answer, and so what became of a force
constexpr int MUCH_SURPLUS = 50;          // from here on only zero force goes out, so that no other one waits to be read at the end
constexpr int MOST_AT_ONCE = 1000;        // messages read at once: a flood must not keep the force from going out
constexpr int MOST_IDLE = 100;            // the same on the idle connection
constexpr long LOOK_NS = 200'000;         // between two looks for an answer in a signal handler

int milliseconds(double seconds) { return static_cast<int>(std::ceil(std::max(seconds, 0.0) * 1e3)); }

}  // namespace

HaplyExchange::HaplyExchange(std::unique_ptr<HaplySocket> socket, std::unique_ptr<HaplySocket> idle, const haply::Devices& devices,
                             const haply::Version& version, double watchdog)
    : socket_(std::move(socket)),
      idle_(std::move(idle)),
      devices_(devices),
      version_(version),
      watchdog_(watchdog),
      zero_(write_forces(devices, {}, version)),
      zero_frame_(haply::masked_frame(zero_)),
      idle_descriptor_(idle_ ? idle_->descriptor() : -1),
      arrived_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (arrived_ < 0) throw std::system_error(errno, std::generic_category(), "the event of a new state of the service");
  const BlockSignals inherited;
  thread_ = std::thread([this] { run(); });
}

HaplyExchange::~HaplyExchange() {
  stop();
  close(arrived_);
}

bool HaplyExchange::take(haply::Measurement& into, double patience) noexcept {
  const double end = monotonic_now() + patience;
  for (;;) {
    std::uint64_t count = 0;
    const ssize_t got = ::read(arrived_, &count, sizeof count);  // before the look, so that what arrives after it ends the wait
    static_cast<void>(got);
    if (measured_.take(into)) return true;
    const double left = end - monotonic_now();
    if (left <= 0 || !is_open_.load()) return false;
    pollfd arrival{arrived_, POLLIN, 0};
    poll(&arrival, 1, milliseconds(left));
  }
}

void HaplyExchange::put(const std::array<Triple, 2>& forces) noexcept {
  last_put_.store(++put_number_);
  put_.put({forces, put_number_, monotonic_now()});
}

bool HaplyExchange::drop(bool for_good, double patience) noexcept {
  const std::uint64_t dropped = for_good ? ALL : last_put_.load();
  std::uint64_t before = dropped_.load();
  while (before < dropped && !dropped_.compare_exchange_weak(before, dropped)) {
  }
  const std::uint64_t zeros = zeros_.load();
  const double end = monotonic_now() + patience;
  const timespec pause{0, LOOK_NS};
  while (zeros_.load() == zeros) {
    if (!is_open_.load() || monotonic_now() >= end) return false;
    nanosleep(&pause, nullptr);
  }
  return true;
}

// drop() does nothing that a signal handler may not. If the thread that speaks is the one that failed, it does not answer; then its last message may
// still lie in the service when the first zero force comes there by the idle connection, so that goes repeatedly.
bool HaplyExchange::panic(double patience) noexcept {
  constexpr int TIMES = 10;
  bool is_taken = false;
  for (int k = 0; k < TIMES; ++k) {
    if (const int idle = idle_descriptor_.load(); idle >= 0) {
      const ssize_t sent = ::send(idle, zero_frame_.data(), zero_frame_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      is_taken = sent == static_cast<ssize_t>(zero_frame_.size());
    }
    if (drop(true, patience / TIMES)) return true;
  }
  return is_taken;
}

void HaplyExchange::stop() noexcept {
  dropped_ = ALL;
  is_over_ = true;
  if (thread_.joinable()) thread_.join();
}

bool HaplyExchange::wants_zero(const Put& newest) const noexcept {
  return newest.number <= dropped_.load() || is_releasing() || monotonic_now() - newest.moment > watchdog_;
}

void HaplyExchange::run() noexcept {
  pthread_setname_np(pthread_self(), "haply");
  assist_realtime();
  const double period = 1 / HAPLY_RATE;
  try {
    const HandlerStack stack;
    double due = monotonic_now();
    while (!is_over_.load() && exchange()) {
      tend_idle();
      due = std::max(away_from_put(due + period), monotonic_now());
      pause_for(due - monotonic_now());
    }
  } catch (const std::exception&) {
    ending_ = "no memory";
  }
  const bool is_sent = socket_->send(zero_, SEND_PATIENCE);
  idle_descriptor_ = -1;  // before: a signal handler must not send amid another frame, nor use a number that was given back
  socket_->close(GOODBYE_PATIENCE);
  // the end of a connection discards what a flooding service had not read, zero force too
  if (idle_ && (!is_sent || surplus_ > MOST_SURPLUS)) idle_->send(zero_, SEND_PATIENCE);
  if (idle_) idle_->close(GOODBYE_PATIENCE);
  is_open_ = false;
  eventfd_write(arrived_, 1);
}

// The moment, or one just after the next put() if it is so near before that: an answer that arrives in a step of the loop would interrupt it, and the
// new force is sent at once instead.
double HaplyExchange::away_from_put(double moment) const noexcept {
  const double next = newest_.moment + interval_;
  return interval_ > 0 && moment > next - QUIET_BEFORE && moment < next + QUIET_AFTER ? next + QUIET_AFTER : moment;
}

// One message and its answer. A service that does not answer gets the next message all the same, because it may be zero force. False: the connection
// is over.
bool HaplyExchange::exchange() {
  const Put before = newest_;
  if (put_.take(newest_)) {
    interval_ = (newest_.moment - before.moment) / static_cast<double>(newest_.number - before.number);
    if (before.number == 0 || interval_ > watchdog_) interval_ = 0;
  }
  const bool is_zero = wants_zero(newest_) || surplus_ > MUCH_SURPLUS;
  if (!socket_->send(is_zero ? zero_ : write_forces(devices_, newest_.forces, version_), SEND_PATIENCE)) return false;
  ++owed_;
  if (!is_zero) unconfirmed_ = owed_;
  // all answers that are due, so that a late one does not leave each later state one message old; and what comes unasked
  const double end = monotonic_now() + ANSWER_PATIENCE;
  HaplySocket::Got got = HaplySocket::Got::nothing;
  int count = 0;
  for (; count < MOST_AT_ONCE; ++count) {
    got = socket_->receive(next_, owed_ > 0 ? end - monotonic_now() : 0);
    if (got != HaplySocket::Got::message) break;
    text_.swap(next_);
    if (owed_ > 0) {
      --owed_;
      surplus_ = std::max(surplus_ - 1, 0);
      if (unconfirmed_ > 0)
        --unconfirmed_;
      else
        ++zeros_;
    } else {
      ++unasked_count_;
      ++surplus_;
    }
  }
  if (surplus_ > MOST_SURPLUS) {
    ending_ = "the service sends more than it is asked for";
    return false;
  }
  if (got == HaplySocket::Got::closed) return false;
  if (count == 0) return true;
  if (got == HaplySocket::Got::nothing) owed_ = 0;  // an answer that did not come in the whole wait must not prolong each later one
  read();
  return true;
}

void HaplyExchange::read() {
  haply::Measurement measurement;
  const char* const wrong = haply::read_measurement(text_, devices_, measurement);
  wrong_ = wrong ? wrong : "";
  if (wrong) {
    ++wrong_count_;
    return;
  }
  measured_.put(measurement);
  eventfd_write(arrived_, 1);
}

// Answers a ping there, which only a reader does, and discards what comes.
void HaplyExchange::tend_idle() {
  if (idle_descriptor_ < 0 || monotonic_now() - tended_ < IDLE_PAUSE) return;
  tended_ = monotonic_now();
  HaplySocket::Got got = HaplySocket::Got::message;
  for (int k = 0; k < MOST_IDLE && got == HaplySocket::Got::message; ++k) got = idle_->receive(next_, 0);
  if (got == HaplySocket::Got::closed) idle_descriptor_ = -1;
}

}  // namespace wholehand::device
