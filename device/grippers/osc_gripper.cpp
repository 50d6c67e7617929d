// SPDX-License-Identifier: MIT
#include "device/grippers/osc_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include "base/system/clock.h"
#include "base/system/osc_bundle.h"
#include "base/text/error.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "device/grippers/osc_messages.h"
#include "device/grippers/packet_motion.h"
#include "device/loop/guard.h"

namespace wholehand::device {
namespace {

constexpr int MOST_DATAGRAMS = 32;              // read at once at most, so that a flooded port does not delay the loop
constexpr std::size_t MOST_CALLERS = 256;       // whose datagrams are read before the first state
constexpr int RELEASES = 3;                     // of the last message, because a network may lose one
constexpr double RELEASE_PAUSE = 1e-3;          // s between two of them
constexpr std::size_t LARGEST_DATAGRAM = 2048;  // bytes: more than what networks pass on in one piece
constexpr std::size_t FORCE_MESSAGE = 128;      // bytes, in its bundle

std::array<double, 2> hand_gap(const HandData& hand) {
  const PreparedHand prepared = prepare_hand(hand);
  return {hand.scale * prepared.gap_closed, hand.scale * prepared.gap_open};
}

std::string place_of(const UdpAddress& address) {
  const bool has_brackets = address.family() == AF_INET6;
  return fmt::format("osc:{}{}{}:{}", has_brackets ? "[" : "", address.host(), has_brackets ? "]" : "", address.port());
}
std::string address_words(const UdpAddress& address) { return fmt::format("{} port {}", address.host(), address.port()); }

// A force message as a datagram of its own.
class ForceMessage {
 public:
  std::span<const char> of(std::uint32_t number, std::uint32_t heard, const GripperForce& force, int state) noexcept {
    bundle_.clear();
    bundle_.add(osc::FORCE,
                {static_cast<std::int32_t>(number), static_cast<std::int32_t>(heard), static_cast<float>(force.arm[0]),
                 static_cast<float>(force.arm[1]), static_cast<float>(force.arm[2]), static_cast<float>(force.grip), state});
    return bundle_.first_message();
  }

 private:
  OscBundle bundle_{FORCE_MESSAGE};
};

// A datagram as it was read.
struct Heard {
  UdpAddress from;
  osc::Words words;
  const char* wrong = nullptr;  // null: nothing
};

// A sender before there is a hand.
struct Caller {
  UdpAddress from;
  std::optional<osc::Hello> hello;
  const char* wrong_hello = nullptr;  // what is wrong with a hello of it
};

// Counts of the ignored datagrams. The haptic thread counts, others read.
struct Ignored {
  std::atomic<std::int64_t> malformed{0}, late{0}, foreign{0};
  std::atomic<const char*> first_wrong{nullptr};  // of the malformed ones
};

class OscGripper final : public Gripper {
 public:
  OscGripper(const HostPort& at, const Scene& scene)
      : address_(find_udp_address(at, "osc")),
        socket_(address_.family(), "osc"),
        motion_(scene.live.rate),
        steps_(scene.live.rate, scene.live.jump, JUMP_TURN),
        period_(1 / scene.live.rate) {
    if (const int error = socket_.bind(address_); error != 0) refuse(error);
    address_ = socket_.address();
    limits_.name = "hand over the network";
    limits_.address = place_of(address_);
    limits_.force = PAPER_FORCE;
    limits_.grip = PAPER_GRIP;
    limits_.gap = hand_gap(scene.hand);
    limits_.rate = scene.live.rate;
    limits_.watchdog = UNKNOWN_WATCHDOG;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    take_away_ = kept({}, NO_STATE);
    release_ = kept({}, static_cast<int>(SessionState::released));
  }
  ~OscGripper() override {
    if (has_hand_) release();
  }

  const GripperLimits& limits() const noexcept override { return limits_; }
  void begin() noexcept override;
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override;
  bool write(const GripperForce& force) noexcept override;
  ReleaseResult release() noexcept override;
  const char* last_error() const noexcept override { return last_error_; }
  ReleaseResult panic() noexcept override {
    // the flag first, so that a write in between also sends no force
    has_panicked_.store(true);
    bool is_taken = false;
    for (int k = 0; k < RELEASES; ++k) is_taken = socket_.send(release_.all(), to_) || is_taken;
    return is_taken ? ReleaseResult::written : ReleaseResult::refused;
  }
  ReleaseResult release_from_watchdog() noexcept override {
    return socket_.send(take_away_.all(), to_) ? ReleaseResult::written : ReleaseResult::refused;
  }
  void show(const Tick& tick) noexcept override { shown_ = static_cast<int>(tick.state); }
  bool is_done() const noexcept override { return is_done_; }
  std::optional<std::string> take_warning() override;
  std::vector<std::string> notes_for_report() const override;

  // A warning for an address that others can reach; empty: no other can.
  std::string openness() const {
    if (address_.is_loopback()) return "";
    return limits_.address + ": whoever reaches this port first is the hand, and the forces go there unencrypted";
  }
  // The start: until the first state. Throws Error (failure).
  void wait_for_hand(double patience);
  // The hand's address and the forces that it bears, in words.
  std::string hand() const {
    return fmt::format("{}{} {:g} N at the arm and {:g} N on each finger", address_words(hand_),
                       has_hello_ ? "; its hello says that it bears" : ", without a hello; so it has to bear", limits_.force,
                       limits_.grip);
  }

 private:
  static constexpr int NO_STATE = -1;
  struct Kept {
    std::array<char, FORCE_MESSAGE> bytes{};
    std::size_t size = 0;
    std::span<const char> all() const noexcept { return {bytes.data(), size}; }
  };
  Kept kept(const GripperForce& force, int state);
  [[noreturn]] void refuse(int error) const;
  void follow(std::int64_t tick) noexcept;
  bool receive(Heard& heard) noexcept;
  bool take_datagram() noexcept;
  void obey(const osc::Words& words) noexcept;
  void meet(Caller& caller, const Heard& heard);
  [[noreturn]] void refuse_silence(double patience, const std::vector<Caller>& callers) const;
  void note_malformed(const char* wrong) noexcept;
  bool send(std::span<const char> bytes) noexcept;

  UdpAddress address_;
  UdpSocket socket_;
  GripperLimits limits_;
  PacketMotion motion_;
  PacketSteps steps_;
  double period_;            // s
  UdpAddress hand_, to_;     // the obeyed sender, and where the forces go; set before the session
  bool has_hand_ = false;    // the hand's address is known
  bool has_hello_ = false;   // and what it bears
  bool is_new_ = false;      // newest_ came since the last read
  bool is_missing_ = false;  // no state came when the loop began
  bool is_moving_ = false;   // a read has begun the motion
  bool has_jumped_ = false;  // since the last read
  bool is_done_ = false;     // it said goodbye
  std::int64_t tick_ = 0;    // of the read
  GripperState newest_;      // as it came
  std::uint32_t reads_ = 0, writes_ = 0;
  int shown_ = 0;                 // state of the session
  const char* breach_ = nullptr;  // why the forces that it claimed to bear may be too much
  const char* last_error_ = "";
  std::array<char, 120> unsent_{};  // words for what the system does not send
  Ignored ignored_;
  UdpAddress foreign_;  // the first of them; set before its count
  bool was_foreign_reported_ = false;
  ForceMessage message_;
  Kept take_away_, release_;
  std::array<char, LARGEST_DATAGRAM> datagram_{};
  std::atomic<bool> has_panicked_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");
};

OscGripper::Kept OscGripper::kept(const GripperForce& force, int state) {
  const std::span<const char> bytes = message_.of(0, 0, force, state);
  Kept kept;
  kept.size = bytes.size();
  std::copy(bytes.begin(), bytes.end(), kept.bytes.begin());
  return kept;
}

void OscGripper::refuse(int error) const {
  const std::string place = place_of(address_);
  if (error == EADDRINUSE)
    throw failure_error(fmt::format("{}: the port is in use, by another session perhaps; give another port", place));
  throw failure_error(fmt::format("{}: this machine cannot listen there: {}", place, std::generic_category().message(error)));
}

void OscGripper::note_malformed(const char* wrong) noexcept {
  if (!ignored_.first_wrong.load()) ignored_.first_wrong.store(wrong);
  ++ignored_.malformed;
}

// False: none waits.
bool OscGripper::receive(Heard& heard) noexcept {
  const std::int64_t length = socket_.receive(datagram_, heard.from);
  if (length < 0) return false;
  const std::size_t size = std::min(static_cast<std::size_t>(length), datagram_.size());
  heard.wrong = osc::read_words(std::span<const char>(datagram_).first(size), heard.words);
  if (static_cast<std::size_t>(length) > size) {
    osc::Words words;
    words.names_hello = heard.words.names_hello;
    words.names_state = heard.words.names_state;
    heard.words = words;
    heard.wrong = "a datagram that is too long";
  }
  if (heard.wrong && (!has_hand_ || heard.from == hand_)) note_malformed(heard.wrong);
  return true;
}

// In the session. False: none waits.
bool OscGripper::take_datagram() noexcept {
  Heard heard;
  if (!receive(heard)) return false;
  if (heard.from == hand_) {
    if (heard.wrong && heard.words.names_hello && !has_hello_) breach_ = "a hello of the hand cannot be read";
    if (!heard.wrong) obey(heard.words);
    return true;
  }
  if (ignored_.foreign.load() == 0) foreign_ = heard.from;
  ++ignored_.foreign;
  return true;
}

// A state with NaN stays the newest, so that the guard sees it.
void OscGripper::obey(const osc::Words& words) noexcept {
  if (words.has_bye) is_done_ = true;
  if (words.has_hello && (words.hello.force < limits_.force || words.hello.grip < limits_.grip))
    breach_ = "the hand says in the session that it bears less force";
  if (!words.has_state || !is_finite(newest_)) return;
  if (!osc::is_later(words.state.sequence, newest_.sequence)) {
    ++ignored_.late;
    return;
  }
  newest_ = words.state;
  is_new_ = true;
  if (is_moving_ && is_finite(newest_) && !steps_.allows(newest_, tick_)) has_jumped_ = true;
}

// The first sender of a state becomes the hand. Its hello, with the forces that it can bear, comes before or with it. A hello that cannot be read
// must not count as no hello, because the largest forces may be too much.
void OscGripper::meet(Caller& caller, const Heard& heard) {
  const osc::Words& words = heard.words;
  if (heard.wrong && words.names_hello) caller.wrong_hello = heard.wrong;
  if (words.has_hello) caller.hello = words.hello;
  const bool is_hand = words.has_state || (heard.wrong && words.names_hello && words.names_state);
  if (is_hand && caller.wrong_hello)
    throw failure_error(
        fmt::format("{}: the hello of {} cannot be read: {}", limits_.address, address_words(caller.from), caller.wrong_hello));
  if (!is_hand) return;
  hand_ = to_ = caller.from;
  has_hand_ = true;
  newest_ = words.state;
  is_done_ = words.has_bye;
  has_hello_ = caller.hello.has_value();
  if (!has_hello_) return;
  limits_.gap = caller.hello->gap;
  limits_.force = caller.hello->force;
  limits_.grip = caller.hello->grip;
  if (caller.hello->port > 0) to_ = hand_.with_port(caller.hello->port);
}

void OscGripper::wait_for_hand(double patience) {
  std::vector<Caller> callers;
  const double end = monotonic_now() + patience;
  while (!has_hand_ && monotonic_now() < end) {
    Heard heard;
    if (!receive(heard)) {
      socket_.wait(READ_PATIENCE);
      continue;
    }
    const auto is_known = [&heard](const Caller& caller) { return caller.from == heard.from; };
    auto caller = std::find_if(callers.begin(), callers.end(), is_known);
    if (caller == callers.end() && callers.size() == MOST_CALLERS) continue;
    if (caller == callers.end()) caller = callers.insert(caller, Caller{heard.from, {}, nullptr});
    meet(*caller, heard);
  }
  if (!has_hand_) refuse_silence(patience, callers);
}

void OscGripper::refuse_silence(double patience, const std::vector<Caller>& callers) const {
  std::string why = fmt::format("no {} came within {:g} s", osc::STATE, patience);
  if (!callers.empty()) why += fmt::format("; {} sent something else", address_words(callers[0].from));
  if (callers.size() > 1) why += fmt::format(", and so did other senders: {}", callers.size() - 1);
  if (const char* wrong = ignored_.first_wrong.load())
    why += fmt::format("; datagrams that could not be read: {}, the first of them: {}", ignored_.malformed.load(), wrong);
  throw failure_error(fmt::format("{}: {}", limits_.address, why));
}

// Datagrams from before the session are old, and the system may have dropped later ones, so only their sequence counts. Then the session begins where
// the hand is now.
void OscGripper::begin() noexcept {
  const double end = monotonic_now() + OSC_SILENCE;
  while (take_datagram() && monotonic_now() < end) {
  }
  is_new_ = false;
  while (!is_new_ && !is_done_ && is_finite(newest_) && monotonic_now() < end)
    if (!take_datagram()) socket_.wait(READ_PATIENCE);
  is_missing_ = !is_new_;
}

// Reads all that wait; the last state counts.
ReadOutcome OscGripper::read(GripperState& state, std::int64_t tick) noexcept {
  tick_ = tick;
  for (int k = 0; k < MOST_DATAGRAMS && take_datagram(); ++k) {
  }
  if (breach_) {
    last_error_ = breach_;
    return ReadOutcome::error;
  }
  if (!is_finite(newest_)) {
    state = newest_;
    state.sequence = ++reads_;
    return ReadOutcome::value;
  }
  is_missing_ = is_missing_ && !is_new_;
  follow(tick);
  if (is_missing_ || motion_.silence(tick) > OSC_SILENCE) {
    last_error_ = "no new state for 50 ms";
    return ReadOutcome::timeout;
  }
  motion_.move(state, tick);
  state.sequence = ++reads_;
  state.time = period_ * static_cast<double>(tick);
  return ReadOutcome::value;
}

// A jump is passed on as one step, for the guard to see.
void OscGripper::follow(std::int64_t tick) noexcept {
  if (!is_moving_) steps_.start(newest_, tick);
  if (!is_moving_ || has_jumped_)
    motion_.start(newest_, tick);
  else if (is_new_)
    motion_.aim(newest_, tick);
  is_moving_ = true;
  is_new_ = has_jumped_ = false;
}

bool OscGripper::write(const GripperForce& force) noexcept {
  if (has_panicked_.load()) return send(release_.all());
  const bool is_number = is_finite(force);
  GripperForce sent = is_number ? force : GripperForce{};
  // the last guard before the wire
  const double size = norm(sent.arm);
  if (size > limits_.force)
    for (double& part : sent.arm) part *= limits_.force / size;
  sent.grip = std::clamp(sent.grip, -limits_.grip, limits_.grip);
  if (++writes_ == 0) ++writes_;  // 0 takes the force away
  const bool is_taken = send(message_.of(writes_, newest_.sequence, sent, shown_));
  if (!is_number) last_error_ = "a force that is NaN or infinite";
  return is_taken && is_number;
}

bool OscGripper::send(std::span<const char> bytes) noexcept {
  if (socket_.send(bytes, to_)) return true;
  std::snprintf(unsent_.data(), unsent_.size(), "the system sends no datagram to it: %s", strerrordesc_np(errno));
  last_error_ = unsent_.data();
  return false;
}

ReleaseResult OscGripper::release() noexcept {
  bool is_taken = false;
  for (int k = 0; k < RELEASES; ++k) {
    if (k > 0) pause_for(RELEASE_PAUSE);
    is_taken = send(release_.all()) || is_taken;
  }
  return is_taken ? ReleaseResult::written : ReleaseResult::refused;
}

std::optional<std::string> OscGripper::take_warning() {
  if (was_foreign_reported_ || ignored_.foreign.load() == 0) return std::nullopt;
  was_foreign_reported_ = true;
  return fmt::format("{}: {} sends too, and is not obeyed: the hand is {}, which came first", limits_.address,
                     address_words(foreign_), address_words(hand_));
}

std::vector<std::string> OscGripper::notes_for_report() const {
  std::vector<std::string> lines;
  if (const std::string line = openness(); !line.empty()) lines.push_back(line);
  if (const std::int64_t count = ignored_.malformed.load(); count > 0)
    lines.push_back(fmt::format("{}: datagrams that could not be read: {}, the first of them: {}", limits_.address, count,
                                ignored_.first_wrong.load()));
  if (const std::int64_t count = ignored_.late.load(); count > 0)
    lines.push_back(fmt::format("{}: states that came late or twice: {}", limits_.address, count));
  if (const std::int64_t count = ignored_.foreign.load(); count > 0)
    lines.push_back(fmt::format("{}: datagrams of others than the hand: {}", limits_.address, count));
  return lines;
}

}  // namespace

std::unique_ptr<Gripper> open_osc(const HostPort& at, const Scene& scene, const std::function<void(const std::string&)>& say,
                                  double patience) {
  auto gripper = std::make_unique<OscGripper>(at, scene);
  const std::string& place = gripper->limits().address;
  if (const std::string line = gripper->openness(); !line.empty()) say(line);
  say(fmt::format("{}: waiting for a hand, {:g} s at most", place, patience));
  gripper->wait_for_hand(patience);
  say(fmt::format("{}: the hand is {}", place, gripper->hand()));
  return gripper;
}

}  // namespace wholehand::device
