// SPDX-License-Identifier: MIT
// A session as OSC: every frame against the ticks it was made of, read by liblo, which has no part in sending it; and what happens where nobody
// listens.
// sanitizers: address
#include "viewer/osc_stream.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <lo/lo.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "grips/hand_nodes.h"
#include "live/hand_view.h"
#include "tests/support/files.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using Argument = std::variant<std::int32_t, float, std::string>;
struct Message {
  std::string address;
  std::vector<Argument> arguments;
};
std::int32_t whole(const Message& message, std::size_t k = 0) { return std::get<std::int32_t>(message.arguments.at(k)); }
float number(const Message& message, std::size_t k = 0) { return std::get<float>(message.arguments.at(k)); }
std::string text(const Message& message, std::size_t k = 0) { return std::get<std::string>(message.arguments.at(k)); }

// liblo's server: refuses malformed packets by itself.
class Listener {
 public:
  Listener() : server_(lo_server_new(nullptr, [](int, const char* words, const char*) { ADD_FAILURE() << words; })) {
    lo_server_add_method(server_, nullptr, nullptr, &Listener::take, this);
  }
  ~Listener() { lo_server_free(server_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  OscTarget target() const { return {"127.0.0.1", lo_server_get_port(server_)}; }

  // Messages of one frame in their order, without those that say of which it is.
  std::vector<Message> frame() {
    messages_.clear();
    while (messages_.empty() || messages_.back().address != "/wholehand/end") {
      if (lo_server_recv_noblock(server_, 5000) <= 0) {
        ADD_FAILURE() << "nothing came";
        break;
      }
    }
    std::vector<Message> frame;
    for (const Message& message : messages_) {
      if (message.address == "/wholehand/frame") {
        frame_ = whole(message);
        time_ = number(message, 1);
      } else {
        frame.push_back(message);
      }
    }
    return frame;
  }
  std::int32_t frame_ = -1;
  float time_ = -1;

 private:
  static int take(const char* address, const char* types, lo_arg** values, int count, lo_message, void* self) {
    Message message{address, {}};
    for (int k = 0; k < count; ++k) {
      // liblo's arguments lie where the packet has them, aligned to four bytes and not as its type asks
      const void* value = values[k];
      if (types[k] == 'i') std::memcpy(&std::get<std::int32_t>(message.arguments.emplace_back(std::int32_t{})), value, 4);
      if (types[k] == 'f') std::memcpy(&std::get<float>(message.arguments.emplace_back(0.0f)), value, 4);
      if (types[k] == 's') message.arguments.emplace_back(std::string(static_cast<const char*>(value)));
    }
    EXPECT_EQ(message.arguments.size(), static_cast<std::size_t>(count)) << "only int32, float32 and strings: " << types;
    static_cast<Listener*>(self)->messages_.push_back(message);
    return 0;
  }
  lo_server server_;
  std::vector<Message> messages_;
};

// A session by script, and the moment of each tick that is asked for.
class Played {
 public:
  explicit Played(const Scene& scene) : session(scene, own_gap(scene.hand)), tracker_(scene) {
    script_.vessel = scene.vessels[0].place;
  }
  DisplayMoment at(std::int64_t number) {
    for (; next_ <= number; ++next_) {
      session.step(script_.at(next_), next_, tick);
      tracker_.follow(tick);
    }
    return moment();
  }
  DisplayMoment moment() {
    hand = hand_view(session.live(), tick, tracker_.poses());
    return {tick, tracker_.poses(), hand, timing_};
  }
  std::int64_t ticks() const { return static_cast<std::int64_t>(script_.seconds() * script_.rate); }
  Session session;
  Tick tick;
  HandView hand;

 private:
  LiveScript script_;
  VesselTracker tracker_;
  ViewFrame::Timing timing_;
  std::int64_t next_ = 0;
};

std::map<std::string, Message> by_address(const std::vector<Message>& messages) {
  std::map<std::string, Message> found;
  for (const Message& message : messages)
    EXPECT_TRUE(found.emplace(message.address, message).second) << "twice: " << message.address;
  return found;
}

using Turn = std::array<double, 9>;  // row-major
Turn turn_of(const Message& pose) {
  const double x = number(pose, 3), y = number(pose, 4), z = number(pose, 5), w = number(pose, 6);
  EXPECT_NEAR(x * x + y * y + z * z + w * w, 1, 1e-6) << pose.address;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w),    1 - 2 * (x * x + z * z),
          2 * (y * z - x * w),     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
}

void expect_place(const Message& pose, const Triple& place) {
  ASSERT_EQ(pose.arguments.size(), 7u) << pose.address;
  for (int k = 0; k < 3; ++k) EXPECT_EQ(number(pose, k), static_cast<float>(place[k])) << pose.address;
}

void expect_frame(std::map<std::string, Message> messages, const Scene& scene, const DisplayMoment& moment) {
  const Tick& tick = moment.tick;
  const auto take = [&messages](const std::string& address) {
    const auto found = messages.find(address);
    EXPECT_NE(found, messages.end()) << address;
    Message message = found == messages.end() ? Message{address, {}} : found->second;
    messages.erase(address);
    return message;
  };
  const Message state = take("/wholehand/state");
  EXPECT_EQ(whole(state), static_cast<int>(tick.state));
  EXPECT_EQ(text(state, 1), SESSION_STATE_NAMES[static_cast<std::size_t>(tick.state)]);
  EXPECT_EQ(text(take("/wholehand/hand/side")), scene.hand.handedness == Handedness::left ? "left" : "right");
  EXPECT_EQ(number(take("/wholehand/hand/closure")), static_cast<float>(tick.closure));
  EXPECT_EQ(number(take("/wholehand/hand/gap")), static_cast<float>(tick.gap));
  EXPECT_EQ(number(take("/wholehand/hand/tilt")), static_cast<float>(tick.tilt));
  EXPECT_EQ(number(take("/wholehand/hand/flow")), static_cast<float>(tick.flow));
  const Message vessel = take("/wholehand/hand/vessel");
  EXPECT_EQ(whole(vessel), tick.vessel);
  EXPECT_EQ(text(vessel, 1), tick.vessel < 0 ? "" : scene.vessels[static_cast<std::size_t>(tick.vessel)].name);
  const Message contacts = take("/wholehand/hand/contacts");
  ASSERT_EQ(contacts.arguments.size(), 24u);
  expect_place(take("/wholehand/joint/XR_HAND_JOINT_WRIST_EXT"), moment.hand.wrist);
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const Message joint = take(std::string("/wholehand/joint/") + openxr_name(j));
      expect_place(joint, moment.hand.proxies[j]);
      EXPECT_EQ(whole(contacts, j), static_cast<int>(moment.hand.contact[j]));
      const Turn turn = turn_of(joint);
      if (k + 1 == finger_joints(f)) continue;
      // OpenXR: the bone to the next joint runs along -z
      const Triple &from = moment.hand.proxies[j], &to = moment.hand.proxies[j + 1];
      const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      for (int row = 0; row < 3; ++row) EXPECT_NEAR(-turn[3 * row + 2], (to[row] - from[row]) / length, 1e-5) << joint.address;
    }
  }
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const std::string address = "/wholehand/vessel/" + scene.vessels[v].name;
    const Message pose = take(address + "/pose");
    expect_place(pose, moment.poses[v].place);
    const Turn turn = turn_of(pose);
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(turn[k], moment.poses[v].rotation[k], 1e-6) << address;
    EXPECT_EQ(number(take(address + "/liquid")), static_cast<float>(tick.volume[v]));
  }
  EXPECT_EQ(number(take("/wholehand/force/feedback")), static_cast<float>(tick.feedback));
  EXPECT_EQ(number(take("/wholehand/force/base")), is_held(tick.state) ? static_cast<float>(scene.force.base) : 0);
  EXPECT_EQ(number(take("/wholehand/force/normal")), static_cast<float>(tick.normal_force));
  EXPECT_EQ(number(take("/wholehand/force/opening")), static_cast<float>(tick.opening_force));
  EXPECT_EQ(number(take("/wholehand/force/user")), static_cast<float>(tick.user_force));
  EXPECT_EQ(number(take("/wholehand/force/hold")), std::isnan(tick.hold_force)   ? 0
                                                   : std::isinf(tick.hold_force) ? -1
                                                                                 : static_cast<float>(tick.hold_force));
  EXPECT_EQ(number(take("/wholehand/force/weight")), static_cast<float>(tick.weight));
  EXPECT_EQ(number(take("/wholehand/force/torque")), static_cast<float>(tick.torque));
  const Message amount = take("/wholehand/amount/water");
  EXPECT_EQ(number(amount), static_cast<float>(tick.arrived[0]));
  EXPECT_EQ(number(amount, 1), 200e-6f);
  EXPECT_EQ(number(take("/wholehand/task/spilt")), static_cast<float>(tick.spilt[0]));
  EXPECT_EQ(whole(take("/wholehand/task/guidance")), tick.guidance);
  EXPECT_EQ(whole(take("/wholehand/task/done")), tick.task_done ? 1 : 0);
  EXPECT_EQ(whole(take("/wholehand/end")), tick.number);
  EXPECT_TRUE(messages.empty()) << "not documented: " << messages.begin()->first;
}

// docs/stream.md has a line for each address, names left open.
void expect_documented(const std::vector<Message>& messages, const Scene& scene) {
  const std::string page = file_text(std::string(WHOLEHAND_SOURCE_DIR) + "/docs/stream.md");
  for (const Message& message : messages) {
    std::string address = message.address;
    if (address.rfind("/wholehand/joint/", 0) == 0) address = "/wholehand/joint/JOINT";
    if (address == "/wholehand/amount/water") address = "/wholehand/amount/LIQUID";
    for (const VesselData& vessel : scene.vessels) {
      const std::size_t at = address.find("/" + vessel.name + "/");
      if (at != std::string::npos) address.replace(at + 1, vessel.name.size(), "NAME");
    }
    EXPECT_NE(page.find("| `" + address + "` |"), std::string::npos) << address;
  }
}

TEST(OscStream, FramesSayWhatTheTicksDo) {
  for (const bool is_left : {false, true}) {
    Scene scene = live_scene();
    if (is_left) scene.hand = left_hand();
    Played played(scene);
    Listener listener;
    OscStream stream(listener.target(), played.session.live());
    EXPECT_EQ(stream.note(), "");
    std::map<SessionState, int> states;
    double poured = 0;
    for (std::int64_t number = 0; number < played.ticks(); number += 97) {
      const DisplayMoment moment = played.at(number);
      stream.show(moment);
      const auto messages = listener.frame();
      EXPECT_EQ(listener.frame_, number);
      EXPECT_EQ(listener.time_, static_cast<float>(static_cast<double>(number) / scene.live.rate));
      expect_frame(by_address(messages), scene, moment);
      if (number == 0) expect_documented(messages, scene);
      ++states[moment.tick.state];
      poured = std::max(poured, moment.tick.flow);
      if (HasFailure()) return;
    }
    EXPECT_EQ(states.size(), 6u) << "all but released";
    EXPECT_GT(poured, 0);
  }
}

// What a filter of single numbers needs: of a turn's two quaternions the one that goes on from the frame before.
TEST(OscStream, TurnsDoNotChangeTheirSign) {
  const Scene scene = live_scene();
  Played played(scene);
  Listener listener;
  OscStream stream(listener.target(), played.session.live());
  std::map<std::string, Message> before;
  int compared = 0;
  for (std::int64_t number = 0; number < played.ticks(); number += 17) {
    stream.show(played.at(number));
    for (const Message& message : listener.frame()) {
      if (message.arguments.size() != 7) continue;
      const auto then = before.find(message.address);
      if (then != before.end()) {
        float dot = 0;
        for (std::size_t k = 3; k < 7; ++k)
          dot += std::get<float>(message.arguments[k]) * std::get<float>(then->second.arguments[k]);
        ASSERT_GE(dot, 0) << message.address << " at " << number;
        ++compared;
      }
      before[message.address] = message;
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(OscStream, NumbersThatDoNotExistAreNumbersAllTheSame) {
  const Scene scene = live_scene();
  Played played(scene);
  Listener listener;
  OscStream stream(listener.target(), played.session.live());
  played.at(0);
  played.tick.hold_force = std::numeric_limits<double>::infinity();
  played.tick.torque = Tick::NONE;
  stream.show(played.moment());
  auto messages = by_address(listener.frame());
  EXPECT_EQ(number(messages["/wholehand/force/hold"]), -1) << "no grip holds it";
  EXPECT_EQ(number(messages["/wholehand/force/torque"]), 0);
  played.tick.hold_force = Tick::NONE;
  stream.show(played.moment());
  messages = by_address(listener.frame());
  EXPECT_EQ(number(messages["/wholehand/force/hold"]), 0) << "nothing is held";
}

// A socket of UDP on this machine.
class Socket {
 public:
  Socket() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
    socklen_t size = sizeof at;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size);
    port = ntohs(at.sin_port);
  }
  ~Socket() { close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  std::string datagram() {
    std::string bytes(65536, 0);
    const ssize_t size = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return bytes;
  }
  int port = 0;

 private:
  int socket_;
};

// As many vessels as there may be, with names as long as they may be.
TEST(OscStream, DatagramsStaySmallAndEachSaysItsFrame) {
  Scene scene = live_scene();
  scene.vessels.resize(1);
  for (int v = 1; v < LIVE_VESSELS; ++v) {
    VesselData vessel = cylinder(std::string(60, 'v') + std::to_string(v), 60, 90, 1.5);
    vessel.place = {0.2 * v, 0, 0};
    scene.vessels.push_back(vessel);
  }
  Played played(scene);
  Socket socket;
  OscStream stream({"127.0.0.1", socket.port}, played.session.live());
  for (const std::int64_t number : {0, 1500}) {
    stream.show(played.at(number));
    std::string ended;
    int count = 0;
    for (std::string bytes = socket.datagram(); !bytes.empty(); bytes = socket.datagram()) {
      EXPECT_LE(bytes.size(), OscStream::DATAGRAM);
      // after the head and its size: address, tags, tick
      const std::string frame = bytes.substr(20, 17);
      EXPECT_EQ(frame, std::string("/wholehand/frame\0", 17));
      std::uint32_t tick = 0;
      std::memcpy(&tick, bytes.data() + 44, 4);
      EXPECT_EQ(ntohl(tick), number);
      ended = bytes;
      ++count;
    }
    EXPECT_GT(count, 3);
    EXPECT_NE(ended.find("/wholehand/end"), std::string::npos) << "in the last of them";
  }
}

TEST(OscStream, AReceiverThatIsNotThereOrDoesNotReadIsNoTrouble) {
  const Scene scene = live_scene();
  Played played(scene);
  int free_port = 0;
  {
    const Socket socket;
    free_port = socket.port;
  }
  OscStream to_nobody({"127.0.0.1", free_port}, played.session.live());
  Socket deaf;  // its buffer is full soon
  OscStream to_deaf({"127.0.0.1", deaf.port}, played.session.live());
  const DisplayMoment moment = played.at(10);
  for (int k = 0; k < 500; ++k) {
    to_nobody.show(moment);
    to_deaf.show(moment);
  }
  // one who comes later gets what is sent then
  std::string last;
  for (std::string bytes = deaf.datagram(); !bytes.empty(); bytes = deaf.datagram()) last = bytes;
  EXPECT_FALSE(last.empty());
  to_deaf.show(moment);
  EXPECT_FALSE(deaf.datagram().empty());
}

TEST(OscStream, SaysWhenItLeavesTheMachine) {
  const Scene scene = live_scene();
  const LiveScene live(scene);
  EXPECT_EQ(OscStream({"localhost", 9000}, live).note(), "");
  EXPECT_EQ(OscStream({"127.255.0.3", 9000}, live).note(), "");
  // nothing is sent before the first frame
  const std::string note = OscStream({"192.0.2.7", 9000}, live).note();
  EXPECT_NE(note.find("192.0.2.7 port 9000"), std::string::npos) << note;
  EXPECT_EQ(note.find('\n'), std::string::npos);
}

TEST(OscStream, AHostThatIsNotKnownIsAFailureInOneLine) {
  const LiveScene live(live_scene());
  try {
    OscStream({"a..b", 9000}, live);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(std::string(error.what()).rfind("--stream: host 'a..b' is not found: ", 0), 0u) << error.what();
  }
}

TEST(OscStream, ReadsAddresses) {
  const auto expect = [](const std::string& url, const std::string& host, int port) {
    const OscTarget target = parse_osc_url(url);
    EXPECT_EQ(target.host, host) << url;
    EXPECT_EQ(target.port, port) << url;
  };
  expect("osc://127.0.0.1:9000", "127.0.0.1", 9000);
  expect("osc://localhost:1", "localhost", 1);
  expect("osc://td-machine.studio_2:65535", "td-machine.studio_2", 65535);
  expect("osc://[::1]:8000", "::1", 8000);
  expect("osc://[fe80::1%eth0]:8000", "fe80::1%eth0", 8000);
}

TEST(OscStream, RefusesOtherAddressesInOneLine) {
  for (const std::string url : {"",
                                "osc",
                                "osc:",
                                "osc://",
                                "http://127.0.0.1:9000",
                                "127.0.0.1:9000",
                                "OSC://127.0.0.1:9000",
                                "osc:/127.0.0.1:9000",
                                "osc://127.0.0.1",
                                "osc://:9000",
                                "osc://[]:9000",
                                "osc://[::1]",
                                "osc://::1:9000",
                                "osc://a:0",
                                "osc://a:65536",
                                "osc://a:-1",
                                "osc://a:+1",
                                "osc://a: 1",
                                "osc://a:1 ",
                                "osc://a:1/",
                                "osc://a:",
                                "osc://a:1e3",
                                "osc://a:99999999999999999999",
                                "osc://a b:1",
                                "osc://a/b:1",
                                "osc://me@a:1",
                                "osc://a\n:1",
                                "osc://[::1:9000",
                                "osc://::1]:9000"}) {
    try {
      parse_osc_url(url);
      ADD_FAILURE() << "taken: " << url;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage) << url;
      const std::string line = error.what();
      EXPECT_EQ(line.rfind("--stream '", 0), 0u) << line;
      EXPECT_NE(line.find("allowed: osc://HOST:PORT"), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
  EXPECT_THROW(parse_osc_url("osc://" + std::string(254, 'a') + ":1"), Error);
}

}  // namespace
}  // namespace wholehand
