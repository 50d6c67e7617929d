// SPDX-License-Identifier: MIT
// Open Sound Control as liblo reads it, which has no part in sending it, and a session to send.
#pragma once

#include <gtest/gtest.h>
#include <lo/lo.h>

#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "app/viewer/osc_stream.h"
#include "device/session/hand_view.h"
#include "tests/support/live_script.h"

namespace wholehand {

using OscArgument = std::variant<std::int32_t, float, std::string>;
struct OscMessage {
  std::string address;
  std::vector<OscArgument> arguments;
};
inline std::int32_t whole(const OscMessage& message, std::size_t k = 0) { return std::get<std::int32_t>(message.arguments.at(k)); }
inline float number(const OscMessage& message, std::size_t k = 0) { return std::get<float>(message.arguments.at(k)); }
inline std::string text(const OscMessage& message, std::size_t k = 0) { return std::get<std::string>(message.arguments.at(k)); }

// liblo's server: refuses malformed packets by itself.
class OscListener {
 public:
  OscListener() : server_(lo_server_new(nullptr, [](int, const char* words, const char*) { ADD_FAILURE() << words; })) {
    lo_server_add_method(server_, nullptr, nullptr, &OscListener::take, this);
  }
  ~OscListener() { lo_server_free(server_); }
  OscListener(const OscListener&) = delete;
  OscListener& operator=(const OscListener&) = delete;
  HostPort target() const { return {"127.0.0.1", lo_server_get_port(server_)}; }

  // Messages of one frame in their order, without those that say of which it is.
  std::vector<OscMessage> frame() {
    messages_.clear();
    while (messages_.empty() || messages_.back().address != "/wholehand/end") {
      if (lo_server_recv_noblock(server_, 5000) <= 0) {
        ADD_FAILURE() << "nothing came";
        break;
      }
    }
    std::vector<OscMessage> frame;
    for (const OscMessage& message : messages_) {
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
    OscMessage message{address, {}};
    for (int k = 0; k < count; ++k) {
      // liblo's arguments lie where the packet has them, aligned to four bytes and not as its type asks
      const void* value = values[k];
      if (types[k] == 'i') std::memcpy(&std::get<std::int32_t>(message.arguments.emplace_back(std::int32_t{})), value, 4);
      if (types[k] == 'f') std::memcpy(&std::get<float>(message.arguments.emplace_back(0.0f)), value, 4);
      if (types[k] == 's') message.arguments.emplace_back(std::string(static_cast<const char*>(value)));
    }
    EXPECT_EQ(message.arguments.size(), static_cast<std::size_t>(count)) << "only int32, float32 and strings: " << types;
    static_cast<OscListener*>(self)->messages_.push_back(message);
    return 0;
  }
  lo_server server_;
  std::vector<OscMessage> messages_;
};

// A session by script, and the moment of each tick that is asked for.
class PlayedSession {
 public:
  explicit PlayedSession(const Scene& scene) : session(scene, own_gap(scene.hand)) { script_.vessel = scene.vessels[0].place; }
  device::DisplayMoment at(std::int64_t number) {
    for (; next_ <= number; ++next_) session.step(script_.at(next_), next_, tick);
    return moment();
  }
  device::DisplayMoment moment() {
    hand = device::hand_view(session.live(), tick, session.poses());
    return {tick, session.poses(), hand, timing_};
  }
  std::int64_t ticks() const { return static_cast<std::int64_t>(script_.seconds() * script_.rate); }
  device::Session session;
  device::Tick tick;
  device::HandView hand;

 private:
  LiveScript script_;
  device::DisplayTiming timing_;
  std::int64_t next_ = 0;
};

}  // namespace wholehand
