// SPDX-License-Identifier: MIT
// Datagrams of any bytes at all, as they may come to the port of a hand over the network: reading stays within its bounds, and what it accepts
// keeps the promises of device/grippers/osc_messages.h.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "device/grippers/osc_messages.h"
#include "tests/fuzz/must.h"

namespace wholehand::device::osc {
namespace {

void must_be_rotation(const Rotation& r) {
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      const double dot = r[3 * a] * r[3 * b] + r[3 * a + 1] * r[3 * b + 1] + r[3 * a + 2] * r[3 * b + 2];
      must(std::abs(dot - (a == b)) < 1e-12, "axes that are not orthonormal");
    }
}

void must_hold(const Words& words) {
  if (words.has_hello) {
    must(words.hello.gap[0] < words.hello.gap[1] && words.hello.gap[0] >= LEAST_GAP && words.hello.gap[1] <= MOST_GAP, "a gap");
    must(words.hello.force >= 0 && words.hello.force <= MOST_FORCE, "a largest force");
    must(words.hello.grip >= 0 && words.hello.grip <= MOST_FORCE, "a largest grip");
    must(words.hello.port >= 0 && words.hello.port <= 65535, "a port");
  }
  if (!words.has_state) return;
  for (const double part : words.state.position) must(std::isnan(part) || std::abs(part) <= MOST_PLACE, "a place out of range");
  must(std::isnan(words.state.gap) || (words.state.gap >= LEAST_GAP && words.state.gap <= MOST_GAP), "a gap out of range");
  if (device::is_finite(words.state)) must_be_rotation(words.state.rotation);
}

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool is_same(const Words& a, const Words& b) {
  bool same = a.has_hello == b.has_hello && a.has_state == b.has_state && a.has_bye == b.has_bye;
  same = same && a.hello.gap == b.hello.gap && a.hello.force == b.hello.force && a.hello.port == b.hello.port;
  same = same && a.state.sequence == b.state.sequence && a.state.buttons == b.state.buttons && is_same(a.state.gap, b.state.gap);
  for (std::size_t k = 0; k < 3; ++k) same = same && is_same(a.state.position[k], b.state.position[k]);
  for (std::size_t k = 0; k < 9; ++k) same = same && is_same(a.state.rotation[k], b.state.rotation[k]);
  return same;
}

// The same in a bundle of its own: it says the same, or is one bundle too deep.
void must_go_into_a_bundle(std::span<const char> datagram, const Words& words) {
  std::vector<char> bundle(20 + datagram.size(), 0);
  std::memcpy(bundle.data(), "#bundle", 7);
  for (std::size_t k = 0; k < 4; ++k) bundle[16 + k] = static_cast<char>(datagram.size() >> (24 - 8 * k));
  std::copy(datagram.begin(), datagram.end(), bundle.begin() + 20);
  Words again;
  const char* wrong = read_words(bundle, again);
  must(wrong ? std::string(wrong) == "too many bundles in each other" : is_same(words, again), "something else in a bundle");
}

}  // namespace
}  // namespace wholehand::device::osc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace wholehand;
  const std::span<const char> datagram(reinterpret_cast<const char*>(data), size);
  device::osc::Words words;
  if (device::osc::read_words(datagram, words)) {
    must(!words.is_any(), "something of a datagram that is wrong");
  } else {
    device::osc::must_hold(words);
    device::osc::must_go_into_a_bundle(datagram, words);
  }
  return 0;
}
