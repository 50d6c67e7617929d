// SPDX-License-Identifier: MIT
// A session as OSC on its way: datagrams, addresses, and what happens where nobody listens.
// sanitizers: address
#include "app/viewer/osc_stream.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <lo/lo.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "base/text/error.h"
#include "tests/support/live_script.h"
#include "tests/support/osc_listener.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

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
  for (int v = 1; v < device::LIVE_VESSELS; ++v) {
    VesselData vessel = cylinder(std::string(60, 'v') + std::to_string(v), 60, 90, 1.5);
    vessel.place = {0.2 * v, 0, 0};
    scene.vessels.push_back(vessel);
  }
  PlayedSession played(scene);
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
  PlayedSession played(scene);
  int free_port = 0;
  {
    const Socket socket;
    free_port = socket.port;
  }
  OscStream to_nobody({"127.0.0.1", free_port}, played.session.live());
  Socket deaf;  // its buffer is full soon
  OscStream to_deaf({"127.0.0.1", deaf.port}, played.session.live());
  const device::DisplayMoment moment = played.at(10);
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
  const device::LiveScene live(scene);
  EXPECT_EQ(OscStream({"localhost", 9000}, live).note(), "");
  EXPECT_EQ(OscStream({"127.255.0.3", 9000}, live).note(), "");
  // nothing is sent before the first frame
  const std::string note = OscStream({"192.0.2.7", 9000}, live).note();
  EXPECT_NE(note.find("192.0.2.7 port 9000"), std::string::npos) << note;
  EXPECT_EQ(note.find('\n'), std::string::npos);
}

TEST(OscStream, AHostThatIsNotKnownIsAFailureInOneLine) {
  const device::LiveScene live(live_scene());
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
    const HostPort target = parse_osc_url(url);
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
