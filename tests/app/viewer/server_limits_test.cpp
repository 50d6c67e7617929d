// SPDX-License-Identifier: MIT
// The viewer's server against a browser of our own: what becomes of those who send too much, too slowly, or stop reading.
// sanitizers: thread
#include "app/viewer/server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/viewer/http_connection.h"
#include "base/text/error.h"
#include "tests/support/http_client.h"
#include "tests/support/served_view.h"

namespace wholehand {
namespace {

// ---- limits ----

TEST(ViewServer, WhatIsTooLargeIsNotRead) {
  const ServedView served;
  EXPECT_EQ(status_of(*served.at, served.at->request("scene.json", "X: " + std::string(7000, 'x') + "\r\n")), 200);
  EXPECT_EQ(status_of(*served.at, served.at->request("scene.json", "X: " + std::string(LARGEST_HEAD, 'x') + "\r\n")), 431);
  EXPECT_EQ(status_of(*served.at, std::string(LARGEST_HEAD + 1, 'x')), 431) << "a line without an end";
  EXPECT_EQ(status_of(*served.at, served.at->post(std::string(LARGEST_BODY, 'x'))), 204);
  EXPECT_EQ(served.controls.size(), 1u);
  EXPECT_EQ(status_of(*served.at, served.at->post(std::string(LARGEST_BODY + 1, 'x'))), 413);
  for (const char* length : {"99999999999999999999", "-1", "0x10", "1e3", ""}) {
    EXPECT_EQ(status_of(*served.at, "POST /" + served.at->token + "/control HTTP/1.1\r\nHost: " + served.at->host() +
                                        "\r\nContent-Type: application/json\r\nContent-Length: " + length + "\r\n\r\n"),
              413)
        << length;
  }
  const std::string post =
      "POST /" + served.at->token + "/control HTTP/1.1\r\nHost: " + served.at->host() + "\r\nContent-Type: application/json\r\n";
  EXPECT_EQ(status_of(*served.at, post + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"), 400)
      << "which has no length";
  EXPECT_EQ(status_of(*served.at, post + "Content-Length: 1\r\nContent-Length: 2\r\n\r\nxx"), 400);
  EXPECT_EQ(status_of(*served.at, post + "Content-Length : 1\r\n\r\nx"), 400) << "a space in a name";
  EXPECT_EQ(status_of(*served.at, served.at->request("scene.json")), 200) << "it lives";
}

// httplib takes some headers apart by recursion, a level each character: none of them gets there.
TEST(ViewServer, HeadersThatRecurseDoNotReachTheLibrary) {
  const ServedView served;
  std::string ranges = "bytes=0-0";
  while (ranges.size() < 8000) ranges += ",0-0";
  const HttpReply reply = served.at->get("scene.json", "Range: " + ranges + "\r\nAccept-Encoding: gzip, br\r\n");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.headers.count("content-encoding"), 0u) << "compressing takes longer than sending to this machine";
  EXPECT_EQ(status_of(*served.at, served.at->request("x", "RANGE:" + ranges + "\r\n")), 404);
  std::string path(7000, 'a');
  EXPECT_EQ(served.at->get(path).status, 404);
}

TEST(ViewServer, GarbageIsAnsweredOrCutAndHurtsNobody) {
  const ServedView served;
  std::uint64_t state = 1;
  for (int k = 0; k < 200; ++k) {
    std::string text = served.at->request("scene.json", "Content-Length: 3\r\n") + "abc";
    for (int change = 0; change < 8; ++change) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      text[(state >> 33) % text.size()] = static_cast<char>(state >> 25);
    }
    HttpSocket socket(served.at->port);
    socket.send(text + "\r\n\r\n");
    socket.end_sending();
    socket.read_all();
  }
  EXPECT_EQ(served.at->get("scene.json").status, 200);
}

TEST(ViewServer, WhoSendsNothingIsCut) {
  const ServedView served;
  HttpSocket silent(served.at->port);
  EXPECT_EQ(silent.read_all(), "");
}

TEST(ViewServer, TwoHundredConnectionsAtOnceAreServedOrToldNo) {
  const ServedView served;
  std::vector<HttpSocket> sockets;
  for (int k = 0; k < 200; ++k) sockets.emplace_back(served.at->port);
  int open = 0, served_now = 0, refused = 0;
  for (HttpSocket& socket : sockets) {
    open += socket.is_open();
    socket.send(served.at->request("scene.json", "Connection: close\r\n"));
  }
  for (HttpSocket& socket : sockets) {
    const int status = socket.read_reply().status;
    served_now += status == 200;
    refused += status == 503 || status == 0;  // cut at once: what it sent may have come too late to be read
  }
  EXPECT_EQ(open, 200);
  EXPECT_EQ(served_now + refused, 200);
  EXPECT_GE(served_now, static_cast<int>(MOST_CONNECTIONS) / 2);
  // those that are there have their threads back
  int again = 0;
  for (int k = 0; k < 200 && again == 0; ++k) {
    again = served.at->get("scene.json").status == 200;
    if (!again) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(again, 1);
}

// ---- frames ----

// A socket that watches, when the server knows it.
HttpSocket watch(ServedView& served, int receive_buffer = 0) {
  const int before = served.frames.viewers();
  HttpSocket socket(served.at->port, receive_buffer);
  socket.send(served.at->request("frames"));
  for (int k = 0; k < 1000 && served.frames.viewers() == before; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(served.frames.viewers(), before + 1);
  return socket;
}

TEST(ViewServer, FramesAreServerSentEventsAndTheLastOneSaysWhy) {
  ServedView served;
  served.frames.publish("{\"t\":-1}");
  HttpSocket socket = watch(served);
  served.frames.publish("{\"t\":0}");
  const HttpReply head = socket.read_reply();
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.headers.at("content-type"), "text/event-stream");
  EXPECT_EQ(socket.read_event(), "{\"t\":0}") << "what was before it came is old";
  served.frames.publish("{\"t\":1}");
  EXPECT_EQ(socket.read_event(), "{\"t\":1}");
  served.frames.close("it \"fell\"");
  EXPECT_EQ(socket.read_event("end"), "{\"reason\":\"it \\\"fell\\\"\"}");
  EXPECT_EQ(socket.read_until("0\r\n\r\n").substr(0, 2), "\r\n") << "the whole answer is there";
}

TEST(ViewServer, NineAreTooMany) {
  ServedView served;
  {
    std::vector<HttpSocket> viewers;
    for (int k = 0; k < MOST_VIEWERS; ++k) viewers.push_back(watch(served));
    EXPECT_EQ(served.at->get("frames").status, 503);
    EXPECT_EQ(served.at->get("scene.json").status, 200) << "the rest goes on";
    served.frames.publish("all");
    for (HttpSocket& viewer : viewers) EXPECT_EQ(viewer.read_event(), "all");
  }
  // they are gone when a frame does not reach them
  for (int k = 0; k < 1000 && served.frames.viewers() > 0; ++k) {
    served.frames.publish("nobody");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(served.frames.viewers(), 0);
  HttpSocket next = watch(served);
  served.frames.publish("again");
  EXPECT_EQ(next.read_event(), "again");
}

TEST(ViewServer, WhoStopsReadingIsDroppedAndKeepsNobodyWaiting) {
  ServedView served;
  HttpSocket stopped = watch(served, 4096);
  HttpSocket reads = watch(served);
  const std::string frame(3000, 'x');
  std::atomic<bool> is_over{false};
  std::atomic<int> seen{0};
  std::thread reader([&] {
    while (!is_over && !reads.read_event().empty()) ++seen;
  });
  int published = 0;
  for (; published < 20000 && served.frames.viewers() == 2; ++published) {
    served.frames.publish(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(served.frames.viewers(), 1) << "after " << published << " frames";
  const int before = seen;
  for (int k = 0; k < 1000 && seen == before; ++k) {
    served.frames.publish(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GT(seen, before);
  is_over = true;
  served.frames.close("done");
  reader.join();
}

// ---- the end, and ports ----

TEST(ViewServer, StoppingCutsAllConnections) {
  auto served = std::make_unique<ServedView>();
  const ViewAddress at = *served->at;
  HttpSocket idle(at.port), half(at.port), watching = watch(*served);
  half.send("GET /");
  served->server->stop();
  EXPECT_NE(watching.read_all().find("event: end"), std::string::npos);
  EXPECT_EQ(idle.read_all() + half.read_all(), "");
  EXPECT_FALSE(HttpSocket(at.port).is_open());
  served.reset();
}

TEST(ViewServer, APortThatIsTakenIsRefused) {
  const ServedView served;
  try {
    ViewServer second(ViewContent{}, served.at->port);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_EQ(std::string(error.what()).rfind("--view-port " + std::to_string(served.at->port) + ": cannot listen on this port", 0),
              0u)
        << error.what();
  }
}

TEST(ViewServer, APortOfTheUsersOwnIsTaken) {
  int port = 0;
  {
    const ServedView before;
    port = before.at->port;
  }
  // somebody else may have it by now
  try {
    const ViewServer server(ViewContent{}, port);
    EXPECT_EQ(ViewAddress(server.address()).port, port);
    EXPECT_EQ(ViewAddress(server.address()).get("scene.json").body, "");
  } catch (const Error&) {
  }
}

}  // namespace
}  // namespace wholehand
