// SPDX-License-Identifier: MIT
// Recordings of ticks at random, the strangest values among them, and ticks compared bit for bit.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "device/recordings/fields.h"
#include "device/recordings/recording.h"
#include "tests/support/files.h"
#include "tests/support/renewed_recording.h"
#include "tests/support/special_values.h"

namespace wholehand {

inline device::RecordingInfo recorded_info(std::size_t vessels) {
  device::RecordingInfo info;
  info.scene_name = "a bench";
  info.scene_file = "bench.toml";
  info.scene_text = "[scene]\nname = \"a bench\"\n# and \xC2\xB5\n";
  info.version = "1.2.3";
  info.start = "2020-06-30T12:34:56+02:00";
  info.seed = 18446744073709551615ull;
  info.rate = 4000;
  info.device = {"omega.7", "hid:/dev/hidraw0", 12, 8, {1e-3, 26e-3}, 3900, false, true};
  for (std::size_t v = 0; v < vessels; ++v)
    info.vessels.push_back({fmt::format("vessel {}", v + 1), v % 2 == 0 ? "water" : "", 2.0 + static_cast<double>(v)});
  info.force_base = 0.8;
  info.force_max = 8;
  info.amounts = {{"water", 1e-4}, {"oil", 2e-4}};
  info.tolerance = 5e-6;
  return info;
}

inline device::RecordingEnd recorded_end() {
  return {{1e-3, 1.1e-3, 1.2e-3, 3e-3}, {1e-5, 2e-5, 3e-5, 4e-4}, 17, device::Fault::interrupted, ""};
}

// Values that a field may have, the strange ones among them.
class RandomTicks {
 public:
  explicit RandomTicks(unsigned seed) : random_(seed) {}

  device::Tick next(std::size_t vessels) {
    device::Tick tick;
    for (const device::RecordedField& field : device::recorded_fields()) {
      char* at = reinterpret_cast<char*>(&tick) + field.offset;
      const std::size_t count = device::recorded_values(field, vessels);
      for (std::size_t k = 0; k < count; ++k) put(field, at, k);
    }
    tick.vessel = std::min(tick.vessel, static_cast<int>(vessels) - 1);
    tick.number = number_ += 1 + (random_() % 5 == 0 ? random_() % 1000 : 0);
    return tick;
  }

  std::vector<device::Tick> some(std::size_t count, std::size_t vessels) {
    std::vector<device::Tick> ticks(count);
    for (device::Tick& tick : ticks) tick = next(vessels);
    return ticks;
  }

 private:
  void put(const device::RecordedField& field, char* at, std::size_t k) {
    if (field.as == device::RecordedAs::real) return store(at, k, real(field.is_finite));
    if (field.as == device::RecordedAs::word) return store(at, k, static_cast<std::uint32_t>(random_()));
    if (field.as == device::RecordedAs::integer)
      return store(at, k, std::uniform_int_distribution<int>(static_cast<int>(field.least), static_cast<int>(field.most))(random_));
    if (field.as == device::RecordedAs::flag)
      return store(at, k, static_cast<char>(random_() % static_cast<unsigned>(field.most + 1)));
  }
  template <class Number>
  static void store(char* at, std::size_t k, Number value) {
    std::memcpy(at + k * sizeof value, &value, sizeof value);
  }
  double real(bool is_finite) {
    // any bits: denormals, NaNs with a payload, infinities
    while (true) {
      const double value = random_() % 8 == 0 ? strange() : std::bit_cast<double>(bits_(random_));
      if (!is_finite || std::isfinite(value)) return value;
    }
  }
  double strange() {
    constexpr double VALUES[] = {0.0, -0.0, NOT_A_NUMBER, INFINITE, -INFINITE, 5e-324, 1.7976931348623157e308};
    return VALUES[random_() % std::size(VALUES)];
  }

  std::mt19937 random_;
  std::uniform_int_distribution<std::uint64_t> bits_;
  std::int64_t number_ = 0;
};

// Every member, bit for bit; padding is none of anybody's business.
inline void expect_same_ticks(const device::Tick& a, const device::Tick& b, const std::string& which) {
  for (const device::RecordedField& field : device::recorded_fields()) {
    EXPECT_EQ(std::memcmp(reinterpret_cast<const char*>(&a) + field.offset, reinterpret_cast<const char*>(&b) + field.offset,
                          device::bytes_in_tick(field)),
              0)
        << which << ": " << field.name;
  }
}

inline void expect_same_ticks(const std::vector<device::Tick>& a, const std::vector<device::Tick>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same_ticks(a[k], b[k], fmt::format("tick {}", k));
}

inline std::string record_session(const TemporaryFolder& folder, const std::vector<device::Tick>& ticks, std::size_t vessels = 2) {
  const std::string path = folder / "session.nc";
  device::RecordingWriter writer(path, recorded_info(vessels));
  EXPECT_TRUE(writer.append(ticks));
  EXPECT_TRUE(writer.finish(recorded_end())) << writer.last_error();
  return path;
}

}  // namespace wholehand
