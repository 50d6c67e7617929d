// SPDX-License-Identifier: MIT
#include "app/viewer/server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "app/viewer/files.h"
#include "app/viewer/local_server.h"
#include "base/files/json.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

using httplib::Request;
using httplib::Response;
using Handled = httplib::Server::HandlerResponse;

constexpr std::chrono::milliseconds LAST_WORDS{500};  // for viewers to learn that it is over
constexpr std::chrono::milliseconds SIGN_OF_LIFE{1000};

// 128 bits that nobody guesses.
std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw failure_error("no random numbers are available");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

// Takes equally long for any text of the same length.
bool is_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char differs = 0;
  for (std::size_t k = 0; k < a.size(); ++k) differs |= static_cast<unsigned char>(a[k] ^ b[k]);
  return differs == 0;
}

void refuse(Response& response, int status, const std::string& words) {
  response.status = status;
  response.set_content(words + "\n", "text/plain; charset=utf-8");
}

void give(Response& response, std::string_view bytes, std::string_view type) {
  response.set_content(bytes.data(), bytes.size(), std::string(type));
}

ViewContent::Query query_of(const Request& request) {
  ViewContent::Query query;
  for (const auto& [name, value] : request.params) query[name] = value;
  return query;
}

// One viewer's frames, until it stops reading: those after number `seen`.
class Watcher {
 public:
  Watcher(FrameHub& frames, std::uint64_t seen) : frames_(frames), seen_(seen) {}
  ~Watcher() { frames_.leave(); }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  bool write(httplib::DataSink& sink) {
    const FrameHub::Update update = frames_.wait(seen_, SIGN_OF_LIFE);
    seen_ = update.number;
    std::string text;
    if (update.frame) text = fmt::format("data: {}\n\n", *update.frame);
    if (update.is_over) text += fmt::format("event: end\ndata: {{\"reason\":{}}}\n\n", json_text(nlohmann::json(update.reason)));
    if (text.empty()) text = ":\n\n";  // nobody there is found out by writing
    sink.write(text.data(), text.size());
    if (update.is_over) sink.done();
    return true;
  }

 private:
  FrameHub& frames_;
  std::uint64_t seen_;
};

}  // namespace

class ViewServer::Pages {
 public:
  Pages(ViewContent content, int port) : content_(std::move(content)), token_(new_token()), server_(MOST_CONNECTIONS) {
    server_.set_default_headers(
        {{"Content-Security-Policy", "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
         {"Cache-Control", "no-store"},
         {"Cross-Origin-Resource-Policy", "same-origin"},
         {"Referrer-Policy", "no-referrer"},
         {"X-Content-Type-Options", "nosniff"}});
    // every request is answered here except the one that has a body
    server_.set_pre_routing_handler([this](const Request& request, Response& response) { return route(request, response); });
    server_.Post("/" + token_ + "/control", [this](const Request& request, Response& response) {
      answer(response, [&] {
        content_.control(request.body);
        response.status = 204;
      });
    });
    port_ = server_.bind(port);
    address_ = fmt::format("http://127.0.0.1:{}/{}/", port_, token_);
    server_.start();
  }

  const std::string& address() const { return address_; }

  void stop() {
    if (content_.frames) {
      content_.frames->close("done");
      const auto until = std::chrono::steady_clock::now() + LAST_WORDS;
      while (content_.frames->viewers() > 0 && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    server_.stop_all();
  }

 private:
  // A page of another origin must not get in by another name for this address, nor by a request from there.
  bool is_own(const Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1) return false;
    if (!is_own_host(host, port_)) return false;
    return !request.has_header("Origin") ||
           (request.get_header_value_count("Origin") == 1 && request.get_header_value("Origin") == "http://" + host);
  }

  Handled route(const Request& request, Response& response) {
    if (!is_own(request)) {
      refuse(response, 403, "another origin");
      return Handled::Handled;
    }
    const std::string_view path = request.path;
    const std::size_t head = token_.size() + 2;
    if (path.size() < head || path[0] != '/' || path[head - 1] != '/' || !is_equal(path.substr(1, token_.size()), token_)) {
      refuse(response, 404, "not here");
      return Handled::Handled;
    }
    const std::string_view rest = path.substr(head);
    if (request.method == "POST" && rest == "control" && content_.control) {
      if (request.get_header_value("Content-Type").rfind("application/json", 0) == 0) return Handled::Unhandled;
      refuse(response, 415, "a control must be application/json");
    } else if (request.method != "GET") {
      refuse(response, 405, "allowed: GET, and POST of a control");
    } else {
      answer(response, [&] { get(rest, request, response); });
    }
    return Handled::Handled;
  }

  template <typename Work>
  void answer(Response& response, Work work) {
    try {
      work();
    } catch (const Error& error) {
      refuse(response, error.code == ExitCode::usage ? 400 : 500, error.what());
    } catch (const std::exception&) {
      refuse(response, 500, "it went wrong");
    }
  }

  void get(std::string_view path, const Request& request, Response& response) {
    const EmbeddedFile* file = find_view_file(path.empty() ? "index.html" : path);
    if (file) return give(response, file->bytes, content_type(file->path));
    if (path == "scene.json") return give(response, content_.scene, "application/json");
    if (path == "recording" && content_.recording) return give(response, content_.recording(query_of(request)), "application/json");
    if (path == "state" && content_.state) return give(response, content_.state(query_of(request)), "application/json");
    if (path == "frames" && content_.frames) return stream(response);
    for (std::size_t v = 0; v < content_.meshes.size(); ++v) {
      if (!content_.meshes[v].empty() && path == fmt::format("meshes/{}.bin", v))
        return give(response, content_.meshes[v], "application/octet-stream");
    }
    refuse(response, 404, "not here");
  }

  void stream(Response& response) {
    const auto newest = content_.frames->join();
    if (!newest) return refuse(response, 503, fmt::format("{} viewers watch already", MOST_VIEWERS));
    const auto watcher = std::make_shared<Watcher>(*content_.frames, *newest);
    response.set_chunked_content_provider("text/event-stream",
                                          [watcher](std::size_t, httplib::DataSink& sink) { return watcher->write(sink); });
  }

  ViewContent content_;
  std::string token_;
  LocalServer server_;
  int port_ = 0;
  std::string address_;
};

ViewServer::ViewServer(ViewContent content, int port) : pages_(std::make_unique<Pages>(std::move(content), port)) {}

ViewServer::~ViewServer() { stop(); }

const std::string& ViewServer::address() const { return pages_->address(); }

void ViewServer::stop() { pages_->stop(); }

bool is_own_host(std::string_view host, int port) {
  constexpr int HTTP = 80;
  for (const char* name : {"127.0.0.1", "localhost"})
    if (host == fmt::format("{}:{}", name, port) || (port == HTTP && host == name)) return true;
  return false;
}

double query_number(const ViewContent::Query& query, const std::string& name, double low, double high) {
  const auto found = query.find(name);
  if (found == query.end()) throw usage_error(fmt::format("{} is missing", name));
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value < low || value > high)
    throw usage_error(fmt::format("{} must be a number from {:g} to {:g}", name, low, high));
  return value;
}

}  // namespace wholehand
