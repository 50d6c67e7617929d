// SPDX-License-Identifier: MIT
#include "device/grippers/haply_socket.h"

#include <fmt/format.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <exception>

#include "base/text/error.h"

namespace wholehand::device {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr std::size_t LARGEST_MESSAGE = 1 << 20;  // bytes: many devices with all that the service says of each
// What runs without a wait: the stream answers pings within a read, and a flood of them would have no end.
constexpr int MOST_HANDLERS = 64;

// Runs what was started until it is done. False: the patience was over before.
template <class IsDone>
bool run_until(asio::io_context& context, double patience, const IsDone& is_done) {
  using Clock = std::chrono::steady_clock;
  context.restart();
  for (int k = 0; patience <= 0 && k < MOST_HANDLERS && !is_done() && context.poll_one() > 0; ++k) {
  }
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
  while (!is_done() && context.run_one_until(end) > 0) {
  }
  return is_done();
}

// Connects a socket within the patience. An error that is not set: it did not answer.
bool connect(asio::io_context& context, tcp::socket& socket, const HostPort& at, double patience, ErrorCode& error) {
  tcp::resolver resolver(context);
  const auto addresses = resolver.resolve(at.host, std::to_string(at.port), error);
  if (error) return false;
  bool is_done = false;
  asio::async_connect(socket, addresses, [&](const ErrorCode& result, const tcp::endpoint&) {
    error = result;
    is_done = true;
  });
  if (run_until(context, patience, [&] { return is_done; })) {
    if (!error) socket.set_option(tcp::no_delay(true), error);
    return !error;
  }
  ErrorCode ignored;
  socket.close(ignored);
  run_until(context, 1, [&] { return is_done; });
  error = {};
  return false;
}

}  // namespace

struct HaplySocket::Parts {
  asio::io_context context{1};
  websocket::stream<tcp::socket, false> stream{context};  // without compression
  beast::flat_buffer buffer{LARGEST_MESSAGE};
  bool is_reading = false, has_message = false, is_closed = false;

  void start_reading() {
    is_reading = true;
    stream.async_read(buffer, [this](const ErrorCode& error, std::size_t) {
      is_reading = false;
      has_message = !error;
      is_closed = is_closed || error;
    });
  }
  // Ends what waits, so that no handler outlives what it refers to.
  void drop() {
    is_closed = true;
    ErrorCode ignored;
    stream.next_layer().close(ignored);
    context.restart();
    context.run_for(std::chrono::seconds(1));
  }
};

HaplySocket::HaplySocket(const HostPort& at, const std::string& place, double patience) : parts_(std::make_unique<Parts>()) {
  ErrorCode error;
  if (!connect(parts_->context, parts_->stream.next_layer(), at, patience, error)) {
    throw failure_error(
        fmt::format("{}: no Inverse Service answers there ({}); start it (in the Haply Hub, or "
                    "`systemctl start haply-inverse-service`)",
                    place, error ? error.message() : "it does not answer"));
  }
  parts_->stream.read_message_max(LARGEST_MESSAGE);
  bool is_done = false;
  parts_->stream.async_handshake(authority(at), "/", [&](const ErrorCode& result) {
    error = result;
    is_done = true;
  });
  const bool was_in_time = run_until(parts_->context, patience, [&] { return is_done; });
  if (was_in_time && !error) return;
  parts_->drop();
  throw failure_error(fmt::format("{}: what answers there is no WebSocket ({}); give the port of the Inverse Service", place,
                                  was_in_time ? error.message() : "no answer in time"));
}

HaplySocket::~HaplySocket() {
  try {
    parts_->drop();
  } catch (const std::exception&) {  // no memory: the socket is closed by its destructor
  }
}

bool HaplySocket::send(const std::string& text, double patience) noexcept {
  if (parts_->is_closed) return false;
  try {
    bool is_done = false;
    ErrorCode error;
    parts_->stream.text(true);
    parts_->stream.async_write(asio::buffer(text), [&](const ErrorCode& result, std::size_t) {
      error = result;
      is_done = true;
    });
    if (run_until(parts_->context, patience, [&] { return is_done; }) && !error) return true;
    parts_->drop();
  } catch (const std::exception&) {
    parts_->is_closed = true;
  }
  return false;
}

HaplySocket::Got HaplySocket::receive(std::string& into, double patience) noexcept {
  try {
    Parts& parts = *parts_;
    if (!parts.has_message && parts.is_closed) return Got::closed;
    if (!parts.has_message && !parts.is_reading) parts.start_reading();
    if (!parts.has_message) run_until(parts.context, patience, [&] { return parts.has_message || parts.is_closed; });
    if (!parts.has_message) return parts.is_closed ? Got::closed : Got::nothing;
    const auto bytes = parts.buffer.data();
    into.assign(static_cast<const char*>(bytes.data()), bytes.size());
    parts.buffer.consume(bytes.size());
    parts.has_message = false;
    return Got::message;
  } catch (const std::exception&) {
    parts_->is_closed = true;
    return Got::closed;
  }
}

void HaplySocket::close(double patience) noexcept {
  try {
    bool is_done = false;
    if (!parts_->is_closed) {
      parts_->stream.async_close(websocket::close_code::normal, [&](const ErrorCode&) { is_done = true; });
      run_until(parts_->context, patience, [&] { return is_done; });
    }
    parts_->drop();
  } catch (const std::exception&) {
    parts_->is_closed = true;
  }
}

std::string HaplySocket::peer() const {
  ErrorCode error;
  const auto address = parts_->stream.next_layer().remote_endpoint(error).address();
  return address.is_loopback() ? "127.0.0.1" : address.to_string();
}

int HaplySocket::descriptor() const noexcept { return parts_->stream.next_layer().native_handle(); }

std::string authority(const HostPort& at) {
  return at.host.find(':') == std::string::npos ? fmt::format("{}:{}", at.host, at.port) : fmt::format("[{}]:{}", at.host, at.port);
}

std::string http_get(const HostPort& at, const std::string& target, double patience) noexcept {
  namespace http = beast::http;
  try {
    asio::io_context context{1};
    tcp::socket socket(context);
    ErrorCode error;
    if (!connect(context, socket, at, patience, error)) return "";
    http::request<http::empty_body> request{http::verb::get, target, 11};
    request.set(http::field::host, authority(at));
    http::response<http::string_body> response;
    beast::flat_buffer buffer{LARGEST_MESSAGE};
    bool is_done = false;
    http::async_write(socket, request, [&](const ErrorCode& failed, std::size_t) {
      error = failed;
      is_done = bool(failed);
      if (failed) return;
      http::async_read(socket, buffer, response, [&](const ErrorCode& wrong, std::size_t) {
        error = wrong;
        is_done = true;
      });
    });
    const bool was_in_time = run_until(context, patience, [&] { return is_done; });
    ErrorCode ignored;
    socket.close(ignored);
    context.restart();
    context.run_for(std::chrono::seconds(1));
    return was_in_time && !error && response.result() == http::status::ok ? response.body() : "";
  } catch (const std::exception&) {
    return "";
  }
}

}  // namespace wholehand::device
