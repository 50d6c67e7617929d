// SPDX-License-Identifier: MIT
// The viewer's server against a browser of our own: who gets in, what is there, and what becomes of those who send too much, too slowly, or stop
// reading. With viewer/local_server and viewer/http_connection, which it is made of.
// sanitizers: address thread
#include "viewer/server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/support/http_client.h"
#include "viewer/files.h"
#include "viewer/http_connection.h"

namespace wholehand {
namespace {

// A view with all that there can be.
struct Served {
  FrameHub frames{MOST_VIEWERS};
  std::mutex mutex;
  std::vector<std::string> controls;
  std::unique_ptr<ViewServer> server;
  std::unique_ptr<ViewAddress> at;

  Served() {
    ViewContent content;
    content.scene = "{\"mode\":\"live\"}";
    content.meshes = {"", std::string("\1\0\0\0", 4)};
    content.frames = &frames;
    content.state = [](const ViewContent::Query& query) {
      return "{\"tilt\":" + std::to_string(query_number(query, "tilt", 0, 3)) + "}";
    };
    content.control = [this](const std::string& body) {
      if (body == "bad") throw usage_error("what was found; what is allowed");
      const std::lock_guard lock(mutex);
      controls.push_back(body);
    };
    server = std::make_unique<ViewServer>(std::move(content), 0);
    at = std::make_unique<ViewAddress>(server->address());
  }
};

int status_of(const ViewAddress& at, const std::string& request) {
  HttpSocket socket(at.port);
  socket.send(request);
  return socket.read_reply().status;
}

// ---- what is there ----

TEST(ViewServer, TheAddressIsLoopbackWithATokenOf128Bits) {
  const Served served, other;
  EXPECT_EQ(served.server->address(), "http://127.0.0.1:" + std::to_string(served.at->port) + "/" + served.at->token + "/");
  EXPECT_EQ(served.at->token.size(), 32u);
  EXPECT_EQ(served.at->token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(served.at->token, other.at->token);
}

TEST(ViewServer, ServesThePageItsFilesAndTheScene) {
  const Served served;
  for (const EmbeddedFile& file : view_files()) {
    const HttpReply reply = served.at->get(std::string(file.path));
    EXPECT_EQ(reply.status, 200) << file.path;
    EXPECT_TRUE(reply.body == file.bytes) << file.path;
    EXPECT_EQ(reply.headers.at("content-type"), content_type(file.path));
  }
  const EmbeddedFile* page = find_view_file("index.html");
  EXPECT_EQ(served.at->get("").body == (page ? page->bytes : "not here\n"), true);
  EXPECT_EQ(served.at->get("scene.json").body, "{\"mode\":\"live\"}");
  EXPECT_EQ(served.at->get("meshes/1.bin").body, std::string("\1\0\0\0", 4));
  EXPECT_EQ(served.at->get("state?tilt=1.5").body, "{\"tilt\":1.500000}");
  for (const char* path : {"meshes/0.bin", "meshes/2.bin", "recording", "nothing", "../scene.json", "three.module.js/", "%00"})
    EXPECT_EQ(served.at->get(path).status, 404) << path;
}

TEST(ViewFiles, AreTheFilesThatWereBuiltIn) {
  const EmbeddedFile* three = find_view_file("three.module.js");
  ASSERT_TRUE(three);
  EXPECT_NE(three->bytes.find("export {"), std::string::npos) << "an ES module";
  int page_files = 0;
  for (const EmbeddedFile& file : view_files()) {
    std::ifstream on_disk(std::string(WHOLEHAND_SOURCE_DIR) + "/viewer/page/" + std::string(file.path), std::ios::binary);
    if (!on_disk) continue;
    ++page_files;
    EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(on_disk), {}) == file.bytes) << file.path;
  }
  EXPECT_EQ(view_files().size(), static_cast<std::size_t>(page_files) + 1);
  EXPECT_EQ(content_type("a/b.css"), "text/css; charset=utf-8");
  EXPECT_EQ(content_type("b"), "application/octet-stream");
}

TEST(ViewServer, EveryAnswerSaysWhatABrowserMayDoWithIt) {
  const Served served;
  for (const char* path : {"scene.json", "nothing"}) {
    const HttpReply reply = served.at->get(path);
    EXPECT_EQ(reply.headers.at("content-security-policy").rfind("default-src 'self';", 0), 0u);
    EXPECT_EQ(reply.headers.at("cache-control"), "no-store");
    EXPECT_EQ(reply.headers.at("referrer-policy"), "no-referrer");
    EXPECT_EQ(reply.headers.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(reply.headers.count("access-control-allow-origin"), 0u);
  }
}

TEST(ViewServer, OneConnectionTakesManyRequests) {
  const Served served;
  HttpSocket socket(served.at->port);
  for (int k = 0; k < 50; ++k) {
    socket.send(served.at->request("scene.json"));
    EXPECT_EQ(socket.read_reply().status, 200);
  }
  socket.send(served.at->request("scene.json") + served.at->post("one") + served.at->request("nothing", "Connection: close\r\n"));
  EXPECT_EQ(socket.read_reply().status, 200);
  EXPECT_EQ(socket.read_reply().status, 204);
  EXPECT_EQ(socket.read_reply().status, 404);
  EXPECT_EQ(socket.read_all(), "") << "closed, as it was asked";
}

// ---- who gets in ----

TEST(ViewServer, WithoutTheTokenNothingIsThere) {
  const Served served;
  const std::string tail = " HTTP/1.1\r\nHost: " + served.at->host() + "\r\n\r\n";
  std::string wrong = served.at->token;
  wrong[31] = wrong[31] == '0' ? '1' : '0';
  for (const std::string& path :
       {std::string("/"), "/" + served.at->token, "/" + wrong + "/", "/" + wrong + "/scene.json", std::string("/scene.json"),
        "/" + served.at->token.substr(1) + "/scene.json", "//" + served.at->token + "/scene.json", std::string("/../")})
    EXPECT_EQ(status_of(*served.at, "GET " + path + tail), 404) << path;
}

TEST(ViewServer, AnotherHostOrOriginIsRefused) {
  const Served served;
  const std::string line = "GET /" + served.at->token + "/scene.json HTTP/1.1\r\n", port = ":" + std::to_string(served.at->port);
  for (const std::string& host : {"evil.example" + port, std::string("127.0.0.1"), "127.0.0.1:1" + port,
                                  "127.0.0.1.evil.example" + port, "[::1]" + port, std::string(""), "127.0.0.1%3a" + port.substr(1),
                                  "127.0.0.1%3A" + port.substr(1), "%31" + std::string("27.0.0.1") + port, "localhos%74" + port})
    EXPECT_EQ(status_of(*served.at, line + "Host: " + host + "\r\n\r\n"), 403) << host;
  EXPECT_EQ(status_of(*served.at, line + "\r\n"), 403) << "none";
  EXPECT_EQ(status_of(*served.at, line + "Host: 127.0.0.1" + port + "\r\nHost: evil.example\r\n\r\n"), 403) << "two";
  EXPECT_EQ(status_of(*served.at, line + "Host: localhost" + port + "\r\n\r\n"), 200);
  const std::string own = line + "Host: 127.0.0.1" + port + "\r\nOrigin: ";
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://127.0.0.1" + port, std::string("http://127.0.0.1"),
        "http://localhost" + port, "http://127.0.0.1%3a" + port.substr(1), "http%3a//127.0.0.1" + port})
    EXPECT_EQ(status_of(*served.at, own + origin + "\r\n\r\n"), 403) << origin;
  EXPECT_EQ(status_of(*served.at, own + "http://127.0.0.1" + port + "\r\n\r\n"), 200);
}

TEST(ViewServer, APortOf80MayBeLeftOut) {
  for (const char* host : {"127.0.0.1", "localhost", "127.0.0.1:80", "localhost:80"}) EXPECT_TRUE(is_own_host(host, 80)) << host;
  for (const char* host : {"", ":80", "evil.example", "evil.example:80", "127.0.0.1:8080", "127.0.0.1:"})
    EXPECT_FALSE(is_own_host(host, 80)) << host;
  EXPECT_FALSE(is_own_host("127.0.0.1", 8080));
}

// What is refused by its head has a body that nobody reads: it is never taken as the next request, with headers of its own.
TEST(ViewServer, ABodyThatWasNotReadIsNoRequest) {
  Served served;
  const std::string inner = served.at->request("scene.json") + served.at->post("hidden");
  struct Case {
    std::string request;
    int status;
  };
  for (const Case& c :
       {Case{served.at->post(inner, "Origin: http://evil.example\r\nContent-Type: text/plain\r\n"), 403},
        Case{served.at->post(inner, "Content-Type: text/plain\r\n"), 415},
        Case{served.at->request("scene.json", "Content-Length: " + std::to_string(inner.size()) + "\r\n") + inner, 200}}) {
    HttpSocket socket(served.at->port);
    socket.send(c.request);
    EXPECT_EQ(socket.read_reply().status, c.status);
    EXPECT_EQ(socket.read_all(), "") << "closed, and nothing more is said";
  }
  EXPECT_TRUE(served.controls.empty());
  HttpSocket socket(served.at->port);
  socket.send("POST /" + served.at->token + "/control HTTP/1.1\r\nHost: " + served.at->host() +
              "\r\nContent-Type: application/json\r\n\r\n" + served.at->request("scene.json"));
  EXPECT_EQ(socket.read_reply().status, 204);
  EXPECT_EQ(served.controls, std::vector<std::string>{""}) << "without a length it has no body, and what follows is a request";
  EXPECT_EQ(socket.read_reply().status, 200);
}

TEST(ViewServer, OnlyReadsAndControlsAreTaken) {
  const Served served;
  for (const char* method : {"HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"}) {
    EXPECT_EQ(status_of(*served.at, std::string(method) + " /" + served.at->token +
                                        "/scene.json HTTP/1.1\r\nHost: " + served.at->host() + "\r\n\r\n"),
              405)
        << method;
  }
  EXPECT_EQ(status_of(*served.at, served.at->post("x", "Content-Type: text/plain\r\n")), 415)
      << "what a form of another page could send";
  EXPECT_EQ(served.at->get("control").status, 404);
}

TEST(ViewServer, AControlIsTakenOrItsFaultTold) {
  Served served;
  EXPECT_EQ(status_of(*served.at, served.at->post("{\"gap\":1}")), 204);
  EXPECT_EQ(served.controls, std::vector<std::string>{"{\"gap\":1}"});
  HttpSocket socket(served.at->port);
  socket.send(served.at->post("bad"));
  const HttpReply reply = socket.read_reply();
  EXPECT_EQ(reply.status, 400);
  EXPECT_EQ(reply.body, "what was found; what is allowed\n");
  EXPECT_EQ(reply.headers.at("content-type").rfind("text/plain", 0), 0u);
}

TEST(ViewServer, ABadQueryIsToldWhatIsAllowed) {
  const Served served;
  for (const char* query : {"state", "state?tilt=", "state?tilt=x", "state?tilt=4", "state?tilt=-1", "state?tilt=nan",
                            "state?tilt=1e999", "state?tilt=1%20"}) {
    const HttpReply reply = served.at->get(query);
    EXPECT_EQ(reply.status, 400) << query;
    EXPECT_NE(reply.body.find("tilt"), std::string::npos) << reply.body;
    EXPECT_EQ(reply.body.find('\n'), reply.body.size() - 1);
  }
}

// ---- limits ----

TEST(ViewServer, WhatIsTooLargeIsNotRead) {
  const Served served;
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
  const Served served;
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
  const Served served;
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
  const Served served;
  HttpSocket silent(served.at->port);
  EXPECT_EQ(silent.read_all(), "");
}

TEST(ViewServer, TwoHundredConnectionsAtOnceAreServedOrToldNo) {
  const Served served;
  std::vector<HttpSocket> sockets;
  for (int k = 0; k < 200; ++k) sockets.emplace_back(served.at->port);
  int open = 0, served_now = 0, told = 0;
  for (HttpSocket& socket : sockets) {
    open += socket.is_open();
    socket.send(served.at->request("scene.json", "Connection: close\r\n"));
  }
  for (HttpSocket& socket : sockets) {
    const int status = socket.read_reply().status;
    served_now += status == 200;
    told += status == 503 || status == 0;  // cut at once: what it sent may have come too late to be read
  }
  EXPECT_EQ(open, 200);
  EXPECT_EQ(served_now + told, 200);
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
HttpSocket watch(Served& served, int receive_buffer = 0) {
  const int before = served.frames.viewers();
  HttpSocket socket(served.at->port, receive_buffer);
  socket.send(served.at->request("frames"));
  for (int k = 0; k < 1000 && served.frames.viewers() == before; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(served.frames.viewers(), before + 1);
  return socket;
}

TEST(ViewServer, FramesAreServerSentEventsAndTheLastOneSaysWhy) {
  Served served;
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
  Served served;
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
  Served served;
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
  auto served = std::make_unique<Served>();
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
  const Served served;
  try {
    ViewServer second(ViewContent{}, served.at->port);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_EQ(std::string(error.what()).rfind("--view-port " + std::to_string(served.at->port) + ": cannot listen there", 0), 0u)
        << error.what();
  }
}

TEST(ViewServer, APortOfTheUsersOwnIsTaken) {
  int port = 0;
  {
    const Served before;
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
