// SPDX-License-Identifier: MIT
// The viewer's server against a browser of our own: what is there and which requests get in. With app/viewer/local_server and
// app/viewer/http_connection, which it is made of.
// sanitizers: thread
#include "app/viewer/server.h"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/viewer/files.h"
#include "tests/support/http_client.h"
#include "tests/support/served_view.h"

namespace wholehand {
namespace {

// ---- what is there ----

TEST(ViewServer, TheAddressIsLoopbackWithATokenOf128Bits) {
  const ServedView served, other;
  EXPECT_EQ(served.server->address(), "http://127.0.0.1:" + std::to_string(served.at->port) + "/" + served.at->token + "/");
  EXPECT_EQ(served.at->token.size(), 32u);
  EXPECT_EQ(served.at->token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(served.at->token, other.at->token);
}

TEST(ViewServer, ServesThePageItsFilesAndTheScene) {
  const ServedView served;
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
    std::ifstream on_disk(std::string(WHOLEHAND_SOURCE_DIR) + "/app/viewer/page/" + std::string(file.path), std::ios::binary);
    if (!on_disk) continue;
    ++page_files;
    EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(on_disk), {}) == file.bytes) << file.path;
  }
  EXPECT_EQ(view_files().size(), static_cast<std::size_t>(page_files) + 1);
  EXPECT_EQ(content_type("a/b.css"), "text/css; charset=utf-8");
  EXPECT_EQ(content_type("b"), "application/octet-stream");
}

TEST(ViewServer, EveryAnswerSaysWhatABrowserMayDoWithIt) {
  const ServedView served;
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
  const ServedView served;
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

// ---- which requests get in ----

TEST(ViewServer, WithoutTheTokenNothingIsThere) {
  const ServedView served;
  const std::string tail = " HTTP/1.1\r\nHost: " + served.at->host() + "\r\n\r\n";
  std::string wrong = served.at->token;
  wrong[31] = wrong[31] == '0' ? '1' : '0';
  for (const std::string& path :
       {std::string("/"), "/" + served.at->token, "/" + wrong + "/", "/" + wrong + "/scene.json", std::string("/scene.json"),
        "/" + served.at->token.substr(1) + "/scene.json", "//" + served.at->token + "/scene.json", std::string("/../")})
    EXPECT_EQ(status_of(*served.at, "GET " + path + tail), 404) << path;
}

TEST(ViewServer, AnotherHostOrOriginIsRefused) {
  const ServedView served;
  const std::string line = "GET /" + served.at->token + "/scene.json HTTP/1.1\r\n", port = ":" + std::to_string(served.at->port);
  for (const std::string& host : {"evil.example" + port, std::string("127.0.0.1"), "127.0.0.1:1" + port,
                                  "127.0.0.1.evil.example" + port, "[::1]" + port, "127.0.0.1%3a" + port.substr(1),
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

// What httplib would cut off or pass by, so that a request looks as if it came from here.
TEST(ViewServer, AHeaderThatIsEmptyOrHasAControlCharacterIsRefused) {
  const ServedView served;
  const std::string line = "GET /" + served.at->token + "/scene.json HTTP/1.1\r\n", host = "Host: " + served.at->host();
  for (const std::string& headers :
       {host + std::string("\0", 1), host + std::string("\0.evil.example", 14), "Host: " + std::string("\0", 1) + served.at->host(),
        host + "\x01", host + "\r\nOrigin:", host + "\r\nOrigin: ", host + "\r\nOrigin: \t ",
        host + "\r\nOrigin: http://" + served.at->host() + std::string("\0x", 2), host + "\r\nOrigin: \x7F",
        host + "\r\nOri\x02gin: http://evil.example", host + "\r\nX: \n", host + "\r\nX: a\rb"})
    EXPECT_EQ(status_of(*served.at, line + headers + "\r\n\r\n"), 400) << headers;
  EXPECT_EQ(status_of(*served.at, line + "X:\r\n" + host + "\r\nY: a\tb\r\n\r\n"), 200);
}

TEST(ViewServer, APortOf80MayBeLeftOut) {
  for (const char* host : {"127.0.0.1", "localhost", "127.0.0.1:80", "localhost:80"}) EXPECT_TRUE(is_own_host(host, 80)) << host;
  for (const char* host : {"", ":80", "evil.example", "evil.example:80", "127.0.0.1:8080", "127.0.0.1:"})
    EXPECT_FALSE(is_own_host(host, 80)) << host;
  EXPECT_FALSE(is_own_host("127.0.0.1", 8080));
}

// What is refused by its head has a body that nobody reads: it is never taken as the next request, with headers of its own.
TEST(ViewServer, ABodyThatWasNotReadIsNoRequest) {
  ServedView served;
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
  const ServedView served;
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
  ServedView served;
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
  const ServedView served;
  for (const char* query : {"state", "state?tilt=", "state?tilt=x", "state?tilt=4", "state?tilt=-1", "state?tilt=nan",
                            "state?tilt=1e999", "state?tilt=1%20"}) {
    const HttpReply reply = served.at->get(query);
    EXPECT_EQ(reply.status, 400) << query;
    EXPECT_NE(reply.body.find("tilt"), std::string::npos) << reply.body;
    EXPECT_EQ(reply.body.find('\n'), reply.body.size() - 1);
  }
}

}  // namespace
}  // namespace wholehand
