// SPDX-License-Identifier: MIT
// Addresses and sockets of UDP, on this machine.
// sanitizers: address
#include "base/system/udp.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

#include "base/text/error.h"

namespace wholehand {
namespace {

constexpr double SOON = 10;  // s: on however busy a machine

UdpAddress loopback(const char* host = "127.0.0.1", int port = 0) { return find_udp_address({host, port}, "test"); }

TEST(Udp, ADatagramComesWholeWithItsSender) {
  for (const char* host : {"127.0.0.1", "::1"}) {
    const UdpAddress any = loopback(host);
    UdpSocket here(any.family(), "test"), there(any.family(), "test");
    const int error = here.bind(any);
    if (any.family() == AF_INET6 && error == EADDRNOTAVAIL) continue;  // a machine without an IPv6 address of its own
    ASSERT_EQ(error, 0) << host;
    ASSERT_EQ(there.bind(any), 0) << host;
    EXPECT_GT(here.address().port(), 0);
    EXPECT_NE(here.address(), there.address());
    const std::string said = "five!";
    ASSERT_TRUE(there.send({said.data(), said.size()}, here.address()));
    ASSERT_TRUE(here.wait(SOON));
    std::string room(100, 0);
    UdpAddress from;
    ASSERT_EQ(here.receive({room.data(), room.size()}, from), 5);
    EXPECT_EQ(room.substr(0, 5), said);
    EXPECT_EQ(from, there.address());
    EXPECT_EQ(from.host(), host);
    EXPECT_EQ(from.with_port(here.address().port()), here.address()) << "the same host";
    EXPECT_EQ(here.receive({room.data(), room.size()}, from), -1) << "no other";
    EXPECT_FALSE(here.wait(0.001));
  }
}

TEST(Udp, ALongDatagramSaysHowLongItIsAndKeepsToItsRoom) {
  UdpSocket here(AF_INET, "test"), there(AF_INET, "test");
  ASSERT_EQ(here.bind(loopback()), 0);
  const std::string said(1000, 'x');
  ASSERT_TRUE(there.send({said.data(), said.size()}, here.address()));
  ASSERT_TRUE(here.wait(SOON));
  std::string room(20, '.');
  UdpAddress from;
  EXPECT_EQ(here.receive({room.data(), 10}, from), 1000);
  EXPECT_EQ(room, std::string(10, 'x') + std::string(10, '.'));
}

TEST(Udp, ADatagramToAllOfANetworkNeedsLeave) {
  UdpSocket socket(AF_INET, "test");
  const UdpAddress all = loopback("127.255.255.255", 9);
  errno = 0;
  EXPECT_FALSE(socket.send({"five!", 5}, all));
  EXPECT_EQ(errno, EACCES);
  socket.allow_broadcast();
  EXPECT_TRUE(socket.send({"five!", 5}, all));
}

TEST(Udp, APortIsOnesOwn) {
  UdpSocket here(AF_INET, "test"), there(AF_INET, "test");
  ASSERT_EQ(here.bind(loopback()), 0);
  EXPECT_EQ(there.bind(here.address()), EADDRINUSE);
  EXPECT_EQ(there.bind(loopback("192.0.2.7", 9000)), EADDRNOTAVAIL) << "no address of this machine";
}

TEST(Udp, WhatIsNotTakenIsSaid) {
  const UdpSocket socket(AF_INET, "test");
  const std::string too_long(70000, 'x');
  EXPECT_FALSE(socket.send({too_long.data(), too_long.size()}, loopback("127.0.0.1", 9)));
  EXPECT_EQ(errno, EMSGSIZE);
}

TEST(Udp, KnowsThisMachine) {
  EXPECT_TRUE(loopback("127.0.0.1").is_loopback());
  EXPECT_TRUE(loopback("127.255.0.3").is_loopback());
  EXPECT_TRUE(loopback("::1").is_loopback());
  EXPECT_FALSE(loopback("192.0.2.7").is_loopback());
  EXPECT_FALSE(loopback("0.0.0.0").is_loopback()) << "all there are";
  EXPECT_FALSE(loopback("2001:db8::1").is_loopback());
}

TEST(Udp, AHostThatIsNotKnownIsAFailureInOneLine) {
  try {
    find_udp_address({"a..b", 9000}, "--here");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(std::string(error.what()).rfind("--here: host 'a..b' is not found: ", 0), 0u) << error.what();
  }
}

TEST(Udp, PortsHaveOneForm) {
  int port = -1;
  EXPECT_TRUE(read_port("9000", 1, port));
  EXPECT_EQ(port, 9000);
  EXPECT_TRUE(read_port("0", 0, port));
  EXPECT_TRUE(read_port("65535", 1, port));
  for (const char* text : {"", "0", "65536", "-1", "+1", " 1", "1 ", "1e3", "0x10", "99999999999999999999", "a"})
    EXPECT_FALSE(read_port(text, 1, port)) << text;
}

}  // namespace
}  // namespace wholehand
