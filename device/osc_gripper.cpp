// SPDX-License-Identifier: MIT
#include "device/osc_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/error.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "device/osc_messages.h"
#include "device/packet_motion.h"
#include "system/clock.h"
#include "system/osc_bundle.h"

namespace wholehand {
namespace {

constexpr int MOST_DATAGRAMS = 256;             // that one read takes: who floods the port does not hold the loop up
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
std::string words_of(const UdpAddress& address) { return fmt::format("{} port {}", address.host(), address.port()); }

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

// What came and was not obeyed. Counted by the haptic thread, asked for by others.
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
        period_(1 / scene.live.rate) {
    if (const int error = socket_.bind(address_); error != 0) refuse(error);
    address_ = socket_.address();
    limits_.name = "hand over the network";
    limits_.address = place_of(address_);
    limits_.force = PAPER_FORCE;
    limits_.grip = PAPER_GRIP;
    limits_.gap = hand_gap(scene.hand);
    limits_.rate = scene.live.rate;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    take_away_ = kept({}, NO_STATE);
    release_ = kept({}, static_cast<int>(SessionState::released));
  }
  ~OscGripper() override {
    if (has_hand_) send(release_.all());
  }

  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override;
  bool write(const GripperForce& force) noexcept override;
  LetGo let_go() noexcept override { return send(release_.all()) ? LetGo::written : LetGo::not_taken; }
  const char* trouble() const noexcept override { return trouble_; }
  LetGo panic() noexcept override {
    // first the flag: a write that comes between sends no force either
    has_panicked_.store(true);
    return socket_.send(release_.all(), to_) ? LetGo::written : LetGo::not_taken;
  }
  LetGo let_go_meanwhile() noexcept override { return socket_.send(take_away_.all(), to_) ? LetGo::written : LetGo::not_taken; }
  void show(const Tick& tick) noexcept override { shown_ = static_cast<int>(tick.state); }
  bool is_done() const noexcept override { return is_done_; }
  std::optional<std::string> news() override;
  std::vector<std::string> remarks() const override;

  // What the user must know of an address that others can reach; empty: nobody can.
  std::string openness() const {
    if (address_.is_loopback()) return "";
    return limits_.address + ": whoever reaches this port first is the hand, and the forces go there unencrypted";
  }
  // The start: until the first state. Throws Error (failure).
  void wait_for_hand(double patience);
  std::string hand() const { return words_of(hand_); }

 private:
  static constexpr int NO_STATE = -1;
  struct Kept {
    std::array<char, FORCE_MESSAGE> bytes{};
    std::size_t size = 0;
    std::span<const char> all() const noexcept { return {bytes.data(), size}; }
  };
  Kept kept(const GripperForce& force, int state);
  [[noreturn]] void refuse(int error) const;
  bool take_datagram() noexcept;
  void obey(const osc::Words& words, const UdpAddress& from) noexcept;
  void meet(const osc::Words& words, const UdpAddress& from) noexcept;
  void note_malformed(const char* wrong) noexcept;
  bool send(std::span<const char> bytes) noexcept;

  UdpAddress address_;
  UdpSocket socket_;
  GripperLimits limits_;
  PacketMotion motion_;
  double period_;           // s
  UdpAddress hand_, to_;    // who is obeyed, and where the forces go; set before the session
  bool has_hand_ = false;   // somebody said something that can be read
  bool has_state_ = false;  // and where the hand is
  bool is_new_ = false;     // newest_ came since the last read
  bool is_moving_ = false;  // a read has begun the motion
  bool is_done_ = false;    // it said goodbye
  GripperState newest_;     // as it came
  std::uint32_t reads_ = 0, writes_ = 0;
  int shown_ = 0;  // state of the session
  const char* trouble_ = "";
  Ignored ignored_;
  UdpAddress foreign_;  // the first of them; set before its count
  bool is_foreign_told_ = false;
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
bool OscGripper::take_datagram() noexcept {
  UdpAddress from;
  const std::int64_t length = socket_.receive(datagram_, from);
  if (length < 0) return false;
  if (has_hand_ && !(from == hand_)) {
    if (ignored_.foreign.load() == 0) foreign_ = from;
    ++ignored_.foreign;
    return true;
  }
  osc::Words words;
  const char* wrong = "a datagram that is too long";
  if (length <= static_cast<std::int64_t>(datagram_.size()))
    wrong = osc::read_words(std::span<const char>(datagram_).first(static_cast<std::size_t>(length)), words);
  if (wrong) note_malformed(wrong);
  if (words.is_any()) obey(words, from);
  return true;
}

void OscGripper::obey(const osc::Words& words, const UdpAddress& from) noexcept {
  if (!has_state_) meet(words, from);
  if (words.has_bye) is_done_ = true;
  if (!words.has_state) return;
  if (has_state_ && !osc::is_later(words.state.sequence, newest_.sequence)) {
    ++ignored_.late;
    return;
  }
  newest_ = words.state;
  has_state_ = is_new_ = true;
}

// The first who says something is the hand. What it is it says before it says where it is, or with it.
void OscGripper::meet(const osc::Words& words, const UdpAddress& from) noexcept {
  if (!has_hand_) hand_ = to_ = from;
  has_hand_ = true;
  if (!words.has_hello) return;
  limits_.gap = words.hello.gap;
  limits_.force = words.hello.force;
  limits_.grip = words.hello.grip;
  to_ = words.hello.port > 0 ? hand_.with_port(words.hello.port) : hand_;
}

void OscGripper::wait_for_hand(double patience) {
  const double end = monotonic_now() + patience;
  while (!has_state_ && !is_done_ && monotonic_now() < end)
    if (!take_datagram()) socket_.wait(READ_PATIENCE);
  if (has_state_) return;
  std::string why =
      is_done_ ? "the hand said goodbye before it said where it is" : fmt::format("no {} came within {:g} s", osc::STATE, patience);
  if (const char* wrong = ignored_.first_wrong.load())
    why += fmt::format("; {} datagrams could not be read, the first of them: {}", ignored_.malformed.load(), wrong);
  throw failure_error(fmt::format("{}: {}", limits_.address, why));
}

// All that wait are taken, and the last state counts.
ReadOutcome OscGripper::read(GripperState& state, std::int64_t tick) noexcept {
  for (int k = 0; k < MOST_DATAGRAMS && take_datagram(); ++k) {
  }
  if (!is_finite(newest_)) {
    state = newest_;
    state.sequence = ++reads_;
    return ReadOutcome::value;
  }
  if (!is_moving_) motion_.start(newest_, tick);
  if (is_moving_ && is_new_) motion_.aim(newest_, tick);
  is_moving_ = true;
  is_new_ = false;
  if (motion_.silence(tick) > OSC_SILENCE) {
    trouble_ = "no new state for 50 ms";
    return ReadOutcome::timeout;
  }
  motion_.move(state, tick);
  state.sequence = ++reads_;
  state.time = period_ * static_cast<double>(tick);
  return ReadOutcome::value;
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
  if (!is_number) trouble_ = "a force that is no number";
  return is_taken && is_number;
}

bool OscGripper::send(std::span<const char> bytes) noexcept {
  const bool is_taken = socket_.send(bytes, to_);
  if (!is_taken) trouble_ = "the system sends no datagram to it";
  return is_taken;
}

std::optional<std::string> OscGripper::news() {
  if (is_foreign_told_ || ignored_.foreign.load() == 0) return std::nullopt;
  is_foreign_told_ = true;
  return fmt::format("{}: {} sends too, and is not obeyed: the hand is {}, which came first", limits_.address, words_of(foreign_),
                     words_of(hand_));
}

std::vector<std::string> OscGripper::remarks() const {
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

}  // namespace wholehand
