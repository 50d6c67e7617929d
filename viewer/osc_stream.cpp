// SPDX-License-Identifier: MIT
#include "viewer/osc_stream.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <system_error>

#include "core/error.h"
#include "live/amounts.h"
#include "scene/text.h"

namespace wholehand {
namespace {

constexpr std::string_view SCHEME = "osc://";
constexpr std::size_t LARGEST_HOST = 253;  // of a name in the DNS
constexpr float UNHOLDABLE = -1;           // a hold force or an effort that is infinite

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

// Receivers on this machine mostly listen on IPv4 alone; so that of a name with both kinds of addresses.
const addrinfo* preferred(const addrinfo* first) {
  for (const addrinfo* address = first; address; address = address->ai_next)
    if (address->ai_family == AF_INET) return address;
  return first;
}

Addresses find_host(const OscTarget& target) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(target.host.c_str(), std::to_string(target.port).c_str(), &hints, &found);
  if (error != 0) {
    throw failure_error(fmt::format("--stream: host {} is not found: {}; give another host, or its address", in_quotes(target.host),
                                    error == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(error)));
  }
  return {found, freeaddrinfo};
}

std::string numeric(const addrinfo& address) {
  char text[NI_MAXHOST] = "";
  getnameinfo(address.ai_addr, address.ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  return text;
}

bool is_of_this_machine(const addrinfo& address) {
  if (address.ai_family == AF_INET) {
    sockaddr_in in{};
    std::memcpy(&in, address.ai_addr, sizeof in);
    return ntohl(in.sin_addr.s_addr) >> 24 == 127;
  }
  sockaddr_in6 in{};
  std::memcpy(&in, address.ai_addr, sizeof in);
  return IN6_IS_ADDR_LOOPBACK(&in.sin6_addr);
}

int open_socket(const addrinfo& address) {
  const int socket = ::socket(address.ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) throw failure_error(fmt::format("--stream: no socket: {}", std::generic_category().message(errno)));
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);  // several machines may listen
  return socket;
}

float number(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0; }
float holding_number(double value) { return std::isinf(value) ? UNHOLDABLE : number(value); }

}  // namespace

OscTarget parse_osc_url(const std::string& url) {
  const auto refuse = [&url](const char* found) {
    throw usage_error(
        fmt::format("--stream {}: {}; allowed: osc://HOST:PORT, for example osc://127.0.0.1:9000", in_quotes(url), found));
  };
  if (url.rfind(SCHEME, 0) != 0) refuse("it does not begin with osc://");
  const std::string rest = url.substr(SCHEME.size());
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos || rest.back() == ']') refuse("there is no port");
  OscTarget target;
  target.host = rest.substr(0, colon);
  const bool has_brackets = !target.host.empty() && target.host.front() == '[' && target.host.back() == ']';
  if (has_brackets) target.host = target.host.substr(1, target.host.size() - 2);
  if (target.host.empty()) refuse("there is no host");
  const auto is_of_host = [has_brackets](char c) {
    const bool is_alphanumeric = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return is_alphanumeric || c == '.' || c == '-' || c == '_' || (has_brackets && (c == ':' || c == '%'));
  };
  if (target.host.size() > LARGEST_HOST || !std::all_of(target.host.begin(), target.host.end(), is_of_host))
    refuse("its host is not valid");
  const char *port = rest.data() + colon + 1, *end = rest.data() + rest.size();
  const auto [stop, error] = std::from_chars(port, end, target.port);
  if (error != std::errc{} || stop != end || target.port < 1 || target.port > 65535)
    refuse("its port is not a whole number from 1 to 65535");
  return target;
}

OscStream::OscStream(const OscTarget& target, const LiveScene& live) : live_(live) {
  for (int j = 0; j < JOINT_COUNT; ++j) joints_[j] = std::string("/wholehand/joint/") + openxr_name(j);
  for (const VesselData& vessel : live.scene.vessels) {
    const std::string address = "/wholehand/vessel/" + vessel.name;
    vessels_.push_back({address + "/pose", address + "/liquid", {}});
  }
  if (live.scene.task)
    for (const auto& [liquid, volume] : live.scene.task->amounts) amounts_.push_back("/wholehand/amount/" + liquid);
  const Addresses found = find_host(target);
  const addrinfo& address = *preferred(found.get());
  to_.resize(address.ai_addrlen);
  std::memcpy(to_.data(), address.ai_addr, to_.size());
  if (!is_of_this_machine(address)) {
    note_ =
        fmt::format("--stream: the session goes unencrypted to {} port {}, outside of this machine", numeric(address), target.port);
  }
  socket_ = open_socket(address);
}

OscStream::~OscStream() { close(socket_); }

void OscStream::show(const DisplayMoment& moment) noexcept {
  const auto state = static_cast<std::size_t>(moment.tick.state);
  tick_ = static_cast<std::int32_t>(moment.tick.number & INT32_MAX);
  time_ = number(static_cast<double>(moment.tick.number) / live_.scene.live.rate);
  put("/wholehand/state", {static_cast<std::int32_t>(state), std::string_view(SESSION_STATE_NAMES[state])});
  put_hand(moment);
  put_vessels(moment.tick, moment.poses);
  put_forces(moment);
  put_task(moment.tick);
  put("/wholehand/end", {tick_});
  flush();
}

// Every datagram says first of which frame it is.
void OscStream::put(std::string_view address, std::span<const OscValue> values) noexcept {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (bundle_.is_empty()) bundle_.add("/wholehand/frame", {tick_, time_});
    if (bundle_.add(address, values)) return;
    flush();
  }
}

// A quaternion and its negative are the same turn; the one that is nearer to what was sent before lets receivers smooth it number
// by number.
void OscStream::put_pose(std::string_view address, const Triple& place, const Quaternion& turn, Quaternion& before) noexcept {
  double dot = 0;
  for (std::size_t k = 0; k < 4; ++k) dot += turn[k] * before[k];
  for (std::size_t k = 0; k < 4; ++k) before[k] = dot < 0 ? -turn[k] : turn[k];
  put(address, {number(place[0]), number(place[1]), number(place[2]), number(before[0]), number(before[1]), number(before[2]),
                number(before[3])});
}

void OscStream::flush() noexcept {
  if (!bundle_.is_empty()) {
    const std::span<const char> bytes = bundle_.bytes();
    sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(to_.data()),
           static_cast<socklen_t>(to_.size()));
  }
  bundle_.clear();
}

void OscStream::put_hand(const DisplayMoment& moment) noexcept {
  const Tick& tick = moment.tick;
  const HandView& hand = moment.hand;
  const HandData& data = live_.scene.hand;
  std::string_view vessel;
  if (tick.vessel >= 0) vessel = live_.scene.vessels[static_cast<std::size_t>(tick.vessel)].name;
  put("/wholehand/hand/side", {std::string_view(data.handedness == Handedness::left ? "left" : "right")});
  put("/wholehand/hand/closure", {number(tick.closure)});
  put("/wholehand/hand/gap", {number(tick.gap)});
  put("/wholehand/hand/vessel", {static_cast<std::int32_t>(tick.vessel), vessel});
  put("/wholehand/hand/tilt", {number(tick.tilt)});
  put("/wholehand/hand/flow", {number(tick.flow)});
  const HandNodes nodes = hand_nodes(data, live_.hand, hand.wrist, hand.rotation, hand.proxies);
  put_pose("/wholehand/joint/XR_HAND_JOINT_WRIST_EXT", nodes.wrist.position, nodes.wrist.rotation, turns_[JOINT_COUNT]);
  for (int j = 0; j < JOINT_COUNT; ++j) put_pose(joints_[j], nodes.joints[j].position, nodes.joints[j].rotation, turns_[j]);
  std::array<OscValue, JOINT_COUNT> contacts;
  for (int j = 0; j < JOINT_COUNT; ++j) contacts[j] = static_cast<std::int32_t>(hand.contact[j]);
  put("/wholehand/hand/contacts", contacts);
}

void OscStream::put_vessels(const Tick& tick, const VesselPoses& poses) noexcept {
  for (std::size_t v = 0; v < vessels_.size(); ++v) {
    put_pose(vessels_[v].pose, poses[v].place, quaternion_of(poses[v].rotation), vessels_[v].turn);
    put(vessels_[v].liquid, {number(tick.volume[v])});
  }
}

void OscStream::put_forces(const DisplayMoment& moment) noexcept {
  const Tick& tick = moment.tick;
  const std::optional<HandHold>& hold = moment.hand.hold;
  const float base = is_held(tick.state) ? number(live_.scene.force.base) : 0;
  put("/wholehand/force/feedback", {number(tick.feedback)});
  put("/wholehand/force/base", {base});
  put("/wholehand/force/normal", {number(tick.normal_force)});
  put("/wholehand/force/opening", {number(tick.opening_force)});
  put("/wholehand/force/user", {number(tick.user_force)});
  put("/wholehand/force/hold", {holding_number(hold ? hold->force() : tick.hold_force)});
  put("/wholehand/force/weight", {number(tick.weight)});
  put("/wholehand/force/torque", {number(tick.torque)});
  if (live_.scene.strength) put_holding(hold);
}

void OscStream::put_holding(const std::optional<HandHold>& hold) noexcept {
  put("/wholehand/force/tips_hold", {hold ? holding_number(hold->tips_force()) : 0});
  put("/wholehand/hand/effort", {hold ? holding_number(hold->effort) : 0});
  put("/wholehand/hand/tips_effort", {hold ? holding_number(hold->tips) : 0});
}

void OscStream::put_task(const Tick& tick) noexcept {
  const Scene& scene = live_.scene;
  for (std::size_t k = 0; k < amounts_.size(); ++k) {
    const auto& [liquid, wanted] = scene.task->amounts[k];
    put(amounts_[k], {number(total_arrived(scene, tick, liquid)), number(wanted)});
  }
  put("/wholehand/task/spilt", {number(total_spilt(scene, tick))});
  put("/wholehand/task/guidance", {static_cast<std::int32_t>(tick.guidance)});
  put("/wholehand/task/done", {tick.task_done ? 1 : 0});
}

}  // namespace wholehand
