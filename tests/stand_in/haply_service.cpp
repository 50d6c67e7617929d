// SPDX-License-Identifier: MIT
#include "tests/stand_in/haply_service.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace wholehand::stand_in {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using nlohmann::json;

std::string id_of(std::size_t arm) { return "0A0" + std::to_string(arm + 1); }

json vector_of(const Vector& v) { return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}}; }

// "3.5.0.0" and later: a force is a `vector`; before: `values`. Others are ignored, as the service does with what it does not know.
bool takes_vectors(const std::string& version) { return !(version < "3.5"); }

// A text frame of a server, which is not masked.
std::string frame_of(const std::string& text) {
  std::string frame = "\x81";
  frame += static_cast<char>(text.size() < 126 ? text.size() : 126);
  if (text.size() >= 126) {
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size() & 0xff);
  }
  return frame + text;
}

}  // namespace

struct HaplyService::Connection {
  asio::io_context context{1};
  beast::websocket::stream<tcp::socket, false> stream{context};
  int descriptor = -1;
  std::int64_t messages = 0;
  std::thread thread;
};

HaplyService::HaplyService(const HaplyOptions& options) : options_(options), forces_(options.sides.size()) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(options.port));
  socklen_t size = sizeof address;
  if (bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || listen(listener_, 16) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("the stand-in for the Inverse Service cannot listen");
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { accept(); });
}

HaplyService::~HaplyService() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    for (const auto& connection : connections_) shutdown(connection->descriptor, SHUT_RDWR);
  }
  shutdown(listener_, SHUT_RDWR);
  thread_.join();
  for (const auto& connection : connections_) connection->thread.join();
  close(listener_);
}

void HaplyService::misbehave(HaplyFault fault) {
  const std::lock_guard lock(mutex_);
  fault_ = fault;
}

void HaplyService::move(std::function<HaplyMotion(double)> motion) {
  const std::lock_guard lock(mutex_);
  motion_ = std::move(motion);
}

void HaplyService::rest_at(const HaplyMotion& motion) {
  move([motion](double) { return motion; });
}

Vector HaplyService::force(std::size_t arm) const {
  const std::lock_guard lock(mutex_);
  return forces_[arm];
}

bool HaplyService::has_force() const {
  const std::lock_guard lock(mutex_);
  for (const Vector& force : forces_)
    if (force != Vector{}) return true;
  return false;
}

std::size_t HaplyService::clients() const {
  const std::lock_guard lock(mutex_);
  return clients_;
}

std::int64_t HaplyService::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void HaplyService::push(const Vector& force) {
  const std::lock_guard lock(mutex_);
  forces_[0] = force;
}

std::int64_t HaplyService::other_messages() const {
  const std::lock_guard lock(mutex_);
  std::int64_t most = 0;
  for (const auto& connection : connections_) most = std::max(most, connection->messages);
  return messages_ - most;
}

bool HaplyService::wait(const std::function<bool()>& holds) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    std::unique_lock lock(mutex_);
    if (std::chrono::steady_clock::now() > end) return false;
    changed_.wait_for(lock, std::chrono::milliseconds(2));
  }
  return true;
}

void HaplyService::accept() {
  for (;;) {
    const int descriptor = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const std::lock_guard lock(mutex_);
    if (descriptor < 0 || is_over_) {
      if (descriptor >= 0) close(descriptor);
      return;
    }
    connections_.push_back(std::make_unique<Connection>());
    Connection& connection = *connections_.back();
    connection.descriptor = descriptor;
    connection.stream.next_layer().assign(tcp::v4(), descriptor);
    connection.thread = std::thread([this, &connection] { serve(connection); });
  }
}

// An error of the socket is the end of the connection.
void HaplyService::serve(Connection& connection) {
  bool is_client = false;
  try {
    auto& stream = connection.stream;
    stream.next_layer().set_option(tcp::no_delay(true));
    beast::flat_buffer buffer;
    http::request<http::string_body> request;
    http::read(stream.next_layer(), buffer, request);
    if (!beast::websocket::is_upgrade(request)) {
      http::response<http::string_body> response{http::status::not_found, request.version()};
      if (request.target() == "/version" && !options_.version.empty()) {
        response.result(http::status::ok);
        response.body() = json{{"project_name", "haply-inverse-service"}, {"project_version", options_.version}}.dump();
      }
      response.prepare_payload();
      http::write(stream.next_layer(), response);
      shutdown(connection.descriptor, SHUT_RDWR);
      return;
    }
    stream.accept(request);
    stream.text(true);
    is_client = true;
    {
      const std::lock_guard lock(mutex_);
      ++clients_;
      if (start_ == std::chrono::steady_clock::time_point{}) start_ = std::chrono::steady_clock::now();
    }
    if (!options_.says_nothing) stream.write(asio::buffer(state(true)));
    for (;;) {
      beast::flat_buffer message;
      stream.read(message);
      take(std::string(static_cast<const char*>(message.data().data()), message.size()), connection);
      if (!answer(connection)) break;
    }
  } catch (const std::exception&) {
  }
  shutdown(connection.descriptor, SHUT_RDWR);
  const std::lock_guard lock(mutex_);
  if (is_client) --clients_;
  changed_.notify_all();
}

void HaplyService::take(const std::string& text, Connection& connection) {
  const json message = json::parse(text, nullptr, false);
  const std::lock_guard lock(mutex_);
  ++messages_;
  ++connection.messages;
  const char* const key = takes_vectors(options_.version) ? "vector" : "values";
  if (message.is_object() && message.contains("inverse3")) {
    for (const json& device : message["inverse3"]) {
      const json& command = device.at("commands").at("set_cursor_force");
      if (!command.contains(key)) continue;
      for (std::size_t arm = 0; arm < forces_.size(); ++arm)
        if (device.at("device_id") == id_of(arm))
          forces_[arm] = {command.at(key).at("x"), command.at(key).at("y"), command.at(key).at("z")};
    }
  }
  changed_.notify_all();
}

std::string HaplyService::state(bool is_inventory) {
  const std::lock_guard lock(mutex_);
  const double now = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const HaplyMotion motion = motion_ ? motion_(now) : HaplyMotion{};
  const bool has_vanished = fault_ == HaplyFault::vanished && !is_inventory;
  json arms = json::array();
  if (fault_ == HaplyFault::foreign)
    arms.push_back({{"device_id", "FFFF"}, {"state", {{"cursor_position", vector_of({9, 9, 9})}}}});
  for (std::size_t arm = 0; arm < options_.sides.size(); ++arm) {
    if (has_vanished && arm == 1) continue;
    json device{{"device_id", id_of(arm)}};
    if (is_inventory) {
      device["config"] = {{"type", "inverse3"}, {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}}};
      if (!options_.sides[arm].empty()) device["config"]["handedness"] = options_.sides[arm];
    }
    if (fault_ != HaplyFault::no_state || is_inventory) {
      device["state"] = {{"cursor_position", vector_of(motion.cursors[arm])},
                         {"cursor_velocity", vector_of({0, 0, 0})},
                         {"current_cursor_force", vector_of(forces_[arm])},
                         {"control_domain", "cartesian"},
                         {"control_mode", "idle"}};
    }
    device["status"] = {{"calibrated", true}, {"power_supply", true}, {"ready", true}};
    arms.push_back(device);
  }
  json message{{"session_id", 7}, {"inverse3", arms}, {"verse_grip", json::array()}, {"wireless_verse_grip", json::array()}};
  if (options_.is_old) {
    message["inverse3"] = json::object();
    message["inverse3"]["0A01"] = {{"state", {{"cursor_position", vector_of({0, 0, 0})}}}};
  }
  if (options_.has_grip && !has_vanished) {
    const auto& q = motion.orientation;
    message["wireless_verse_grip"].push_back({{"device_id", "0B01"},
                                              {"state",
                                               {{"orientation", {{"w", q[0]}, {"x", q[1]}, {"y", q[2]}, {"z", q[3]}}},
                                                {"buttons", {{"a", motion.is_pressed}, {"b", false}, {"c", false}}}}}});
  }
  return message.dump();
}

// False: no more of this connection.
bool HaplyService::answer(Connection& connection) {
  HaplyFault fault = HaplyFault::none;
  {
    const std::lock_guard lock(mutex_);
    fault = fault_;
    if (fault == HaplyFault::skips_one) fault_ = HaplyFault::none;
    if (fault == HaplyFault::halves && connection.messages % 2 == 0) fault = HaplyFault::none;
  }
  auto& stream = connection.stream;
  std::string text = state(false);
  const auto replace_number = [&text](const char* word) {
    const std::size_t at = text.find("\"x\":") + 4;
    text.replace(at, text.find_first_of(",}", at) - at, word);
  };
  switch (fault) {
    case HaplyFault::silent:
    case HaplyFault::skips_one:
    case HaplyFault::halves:
      return true;
    case HaplyFault::closed:
      return false;
    case HaplyFault::no_json:
      text.resize(text.size() / 2);
      break;
    case HaplyFault::no_number:
      replace_number("NaN");
      break;
    case HaplyFault::no_finite:
      replace_number("1e999");
      break;
    case HaplyFault::flood:
      for (int k = 0; k < 60; ++k) stream.write(asio::buffer(text));
      break;
    case HaplyFault::foreign:
      stream.write(asio::buffer(std::string(R"({"inverse3":[{"device_id":"FFFF","state":{}}]})")));
      break;
    case HaplyFault::split: {
      const std::string frame = frame_of(text);
      for (std::size_t at = 0; at < frame.size();) {
        const std::size_t size = at < 5 ? 1 : (frame.size() + 3) / 4;
        asio::write(stream.next_layer(), asio::buffer(frame.substr(at, size)));
        at += size;
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
      return true;
    }
    default:
      break;
  }
  stream.write(asio::buffer(text));
  return true;
}

}  // namespace wholehand::stand_in
