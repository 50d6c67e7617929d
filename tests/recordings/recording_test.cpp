// SPDX-License-Identifier: MIT
// sanitizers: address thread
#include "recordings/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <random>

#include "core/error.h"
#include "recordings/fields.h"
#include "recordings/recorder.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

RecordingInfo some_info(std::size_t vessels) {
  RecordingInfo info;
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

RecordingEnd some_end() { return {{1e-3, 1.1e-3, 1.2e-3, 3e-3}, {1e-5, 2e-5, 3e-5, 4e-4}, 17, Fault::interrupted, ""}; }

// Values that a field may have, the strange ones among them.
class RandomTicks {
 public:
  explicit RandomTicks(unsigned seed) : random_(seed) {}

  Tick next(std::size_t vessels) {
    Tick tick;
    for (const RecordedField& field : recorded_fields()) {
      char* at = reinterpret_cast<char*>(&tick) + field.offset;
      const std::size_t count = recorded_values(field, vessels);
      for (std::size_t k = 0; k < count; ++k) put(field, at, k);
    }
    tick.vessel = std::min(tick.vessel, static_cast<int>(vessels) - 1);
    tick.number = number_ += 1 + (random_() % 5 == 0 ? random_() % 1000 : 0);
    return tick;
  }

  std::vector<Tick> some(std::size_t count, std::size_t vessels) {
    std::vector<Tick> ticks(count);
    for (Tick& tick : ticks) tick = next(vessels);
    return ticks;
  }

 private:
  void put(const RecordedField& field, char* at, std::size_t k) {
    if (field.as == RecordedAs::real) return store(at, k, real(field.is_finite));
    if (field.as == RecordedAs::word) return store(at, k, static_cast<std::uint32_t>(random_()));
    if (field.as == RecordedAs::integer)
      return store(at, k, std::uniform_int_distribution<int>(static_cast<int>(field.least), static_cast<int>(field.most))(random_));
    if (field.as == RecordedAs::flag) return store(at, k, static_cast<char>(random_() % static_cast<unsigned>(field.most + 1)));
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
void expect_same(const Tick& a, const Tick& b, const std::string& which) {
  for (const RecordedField& field : recorded_fields()) {
    EXPECT_EQ(std::memcmp(reinterpret_cast<const char*>(&a) + field.offset, reinterpret_cast<const char*>(&b) + field.offset,
                          bytes_in_tick(field)),
              0)
        << which << ": " << field.name;
  }
}

void expect_same(const std::vector<Tick>& a, const std::vector<Tick>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same(a[k], b[k], fmt::format("tick {}", k));
}

std::string record(const TemporaryFolder& folder, const std::vector<Tick>& ticks, std::size_t vessels = 2) {
  const std::string path = folder / "session.nc";
  RecordingWriter writer(path, some_info(vessels));
  EXPECT_TRUE(writer.append(ticks));
  EXPECT_TRUE(writer.finish(some_end())) << writer.trouble();
  return path;
}

// What reading it is refused with: exit code 2 and one line that starts with the file.
std::string refusal(const std::string& path) {
  try {
    read_recording(path);
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.code, ExitCode::usage) << line;
    EXPECT_EQ(line.rfind(path + ": ", 0), 0u) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  ADD_FAILURE() << "was read";
  return {};
}

#define EXPECT_REFUSED(path, gist)                               \
  do {                                                           \
    const std::string refused = refusal(path);                   \
    EXPECT_NE(refused.find(gist), std::string::npos) << refused; \
  } while (false)

// A member that the table lacks would be lost: nothing as large as a number lies between those that it has.
TEST(Recording, FieldsCoverTheTick) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (const RecordedField& field : recorded_fields()) places.push_back({field.offset, bytes_in_tick(field)});
  std::sort(places.begin(), places.end());
  std::size_t end = 0;
  for (const auto& [offset, size] : places) {
    EXPECT_GE(offset, end) << "two fields at one place";
    EXPECT_LT(offset - end, 8u) << "something lies before " << offset;
    end = offset + size;
  }
  EXPECT_LT(sizeof(Tick) - end, 8u);
}

// docs/session.md has a line for each variable, with its units.
TEST(Recording, VariablesAreInTheDocumentation) {
  const std::string text = file_text(WHOLEHAND_SOURCE_DIR "/docs/session.md");
  for (const RecordedField& field : recorded_fields()) {
    const std::size_t line = text.find(fmt::format("\n| `{}` | tick", field.name));
    ASSERT_NE(line, std::string::npos) << field.name;
    EXPECT_LT(text.find(fmt::format("| {} |", field.units), line), text.find('\n', line + 1)) << field.name;
  }
}

TEST(Recording, GivesBackEveryBit) {
  for (const std::size_t vessels : {1u, 3u, 16u}) {
    const TemporaryFolder folder;
    const auto ticks = RandomTicks(7).some(3000, vessels);
    const std::string path = folder / "a.nc";
    RecordingWriter writer(path, some_info(vessels));
    // blocks of every size, none among them
    for (std::size_t first = 0, size = 0; first < ticks.size(); first += size++) {
      size = std::min(size, ticks.size() - first);
      ASSERT_TRUE(writer.append(std::span(ticks).subspan(first, size)));
    }
    EXPECT_EQ(writer.records(), ticks.size());
    EXPECT_TRUE(std::filesystem::exists(path + ".partial"));
    EXPECT_TRUE(writer.finish(some_end()));
    EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
    EXPECT_EQ(std::filesystem::file_size(path), writer.bytes());
    const Recording recording = read_recording(path);
    expect_same(recording.ticks, ticks);
    EXPECT_EQ(recording.note, "");
  }
}

TEST(Recording, GivesBackWhatIsKnownOfTheSession) {
  const TemporaryFolder folder;
  const RecordingInfo info = some_info(3);
  RecordingWriter writer(folder / "a.nc", info);
  EXPECT_TRUE(writer.finish(some_end()));
  const Recording recording = read_recording(folder / "a.nc");
  EXPECT_TRUE(recording.ticks.empty());
  const RecordingInfo& got = recording.info;
  EXPECT_EQ(got.scene_name, info.scene_name);
  EXPECT_EQ(got.scene_file, info.scene_file);
  EXPECT_EQ(got.scene_text, info.scene_text);
  EXPECT_EQ(got.version, info.version);
  EXPECT_EQ(got.start, info.start);
  EXPECT_EQ(got.seed, info.seed);
  EXPECT_EQ(got.rate, info.rate);
  EXPECT_EQ(got.device.name, "omega.7");
  EXPECT_EQ(got.device.address, "hid:/dev/hidraw0");
  EXPECT_EQ(got.device.force, 12);
  EXPECT_EQ(got.device.grip, 8);
  EXPECT_EQ(got.device.gap, (std::array<double, 2>{1e-3, 26e-3}));
  EXPECT_EQ(got.device.rate, 3900);
  EXPECT_FALSE(got.device.has_rotation);
  EXPECT_TRUE(got.device.is_left_handed);
  ASSERT_EQ(got.vessels.size(), 3u);
  EXPECT_EQ(got.vessels[1].name, "vessel 2");
  EXPECT_EQ(got.vessels[1].liquid, "");
  EXPECT_EQ(got.vessels[2].liquid, "water");
  EXPECT_EQ(got.vessels[2].force_range, 4);
  EXPECT_EQ(got.force_base, 0.8);
  EXPECT_EQ(got.force_max, 8);
  ASSERT_EQ(got.amounts.size(), 2u);
  EXPECT_EQ(got.amounts[1].liquid, "oil");
  EXPECT_EQ(got.amounts[1].volume, 2e-4);
  EXPECT_EQ(got.tolerance, 5e-6);
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->period.p999, 1.2e-3);
  EXPECT_EQ(recording.end->step.max, 4e-4);
  EXPECT_EQ(recording.end->missed, 17);
  EXPECT_EQ(recording.end->fault, Fault::interrupted);
  EXPECT_EQ(recording.end->early, "");
}

// By the library that everybody else reads it with.
TEST(Recording, IsWhatTheNetcdfLibraryReads) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(3).some(50, 2);
  const std::string path = record(folder, ticks);
  int file = -1, id = -1, format = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_inq_format(file, &format), NC_NOERR);
  EXPECT_EQ(format, NC_FORMAT_64BIT_OFFSET);
  std::size_t length = 0;
  ASSERT_EQ(nc_inq_unlimdim(file, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_dimlen(file, id, &length), NC_NOERR);
  EXPECT_EQ(length, ticks.size());
  int variables = 0;
  ASSERT_EQ(nc_inq_nvars(file, &variables), NC_NOERR);
  for (id = 0; id < variables; ++id) {
    char name[NC_MAX_NAME + 1] = {};
    nc_inq_varname(file, id, name);
    std::size_t text = 0;
    EXPECT_EQ(nc_inq_attlen(file, id, "long_name", &text), NC_NOERR) << name;
    nc_type type = NC_NAT;
    nc_inq_vartype(file, id, &type);
    const bool is_label = type == NC_CHAR;
    EXPECT_EQ(nc_inq_attlen(file, id, "units", &text), is_label ? NC_ENOTATT : NC_NOERR) << name;
  }
  const auto variable = [file](const char* name) {
    int found = -1;
    EXPECT_EQ(nc_inq_varid(file, name, &found), NC_NOERR) << name;
    return found;
  };
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const std::size_t at[] = {k, 1, 2}, row_column[] = {k, 2, 1};
    double value = 0;
    signed char flag = -1;
    int word = 0;
    EXPECT_EQ(nc_get_var1_double(file, variable("tick"), at, &value), NC_NOERR);
    EXPECT_EQ(value, static_cast<double>(ticks[k].number));
    EXPECT_EQ(nc_get_var1_double(file, variable("time"), at, &value), NC_NOERR);
    EXPECT_EQ(value, static_cast<double>(ticks[k].number) / 4000);
    EXPECT_EQ(nc_get_var1_double(file, variable("step_time"), at, &value), NC_NOERR);
    EXPECT_EQ(value, ticks[k].step_time);
    EXPECT_EQ(nc_get_var1_double(file, variable("coupling_force"), at, &value), NC_NOERR);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(ticks[k].coupling[1][2]));
    EXPECT_EQ(nc_get_var1_double(file, variable("vessel_rotation"), row_column, &value), NC_NOERR);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(ticks[k].vessel_rotation[7]));
    EXPECT_EQ(nc_get_var1_double(file, variable("spilt_volume"), at, &value), NC_NOERR);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(ticks[k].spilt[1]));
    EXPECT_EQ(nc_get_var1_schar(file, variable("state"), at, &flag), NC_NOERR);
    EXPECT_EQ(flag, static_cast<signed char>(ticks[k].state));
    EXPECT_EQ(nc_get_var1_int(file, variable("touch_mask"), at, &word), NC_NOERR);
    EXPECT_EQ(static_cast<std::uint32_t>(word), ticks[k].touch_mask);
  }
  const std::size_t second[] = {1, 0}, count[] = {1, 8};
  char label[9] = {};
  EXPECT_EQ(nc_get_vara_text(file, variable("vessel"), second, count, label), NC_NOERR);
  EXPECT_STREQ(label, "vessel 2");
  double missed = 0;
  EXPECT_EQ(nc_get_att_double(file, NC_GLOBAL, "missed_periods", &missed), NC_NOERR);
  EXPECT_EQ(missed, 17);
  char meanings[200] = {};
  EXPECT_EQ(nc_get_att_text(file, variable("fault"), "flag_meanings", meanings), NC_NOERR);
  EXPECT_STREQ(meanings, "none read_error timeout stale not_finite jump write_error late ring_full interrupted");
  nc_close(file);
  EXPECT_EQ(std::system(("ncdump -h '" + path + "' > " + (folder / "header.txt")).c_str()), 0);
  EXPECT_NE(file_text(folder / "header.txt").find("double grip_force(tick) ;"), std::string::npos);
}

TEST(Recording, XarraySelectsByName) {
  const TemporaryFolder folder;
  const std::string path = record(folder, RandomTicks(3).some(4, 2));
  const std::string command = "/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/recordings/xarray_test.py '" + path + "' 'vessel 2'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Recording, KeepsNumbersOfTicksThatSkip) {
  const TemporaryFolder folder;
  std::vector<Tick> ticks(3);
  ticks[0].number = 5;
  ticks[1].number = 6;
  ticks[2].number = 9007199254740992;
  const Recording recording = read_recording(record(folder, ticks));
  ASSERT_EQ(recording.ticks.size(), 3u);
  EXPECT_EQ(recording.ticks[1].number, 6);
  EXPECT_EQ(recording.ticks[2].number, 9007199254740992);
}

TEST(Recording, IsReadableWhileItIsMade) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(1).some(100, 2);
  RecordingWriter writer(folder / "a.nc", some_info(2));
  for (std::size_t k = 0; k < 100; k += 25) {
    EXPECT_EQ(read_recording(folder / "a.nc.partial").ticks.size(), k);
    ASSERT_TRUE(writer.append(std::span(ticks).subspan(k, 25)));
  }
  const Recording recording = read_recording(folder / "a.nc.partial");
  expect_same(recording.ticks, ticks);
  EXPECT_FALSE(recording.end);
  EXPECT_EQ(recording.note, (folder / "a.nc.partial") + " was not finished: the session was killed, or is still running");
}

// Killed with SIGKILL, at whatever it was doing then: the file holds whole blocks, in order.
TEST(Recording, OutlivesTheProcess) {
  const TemporaryFolder folder;
  for (int round = 0; round < 5; ++round) {
    const std::string path = (folder / fmt::format("{}.nc", round));
    int begun[2] = {};
    ASSERT_EQ(pipe(begun), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RecordingWriter writer(path, some_info(2));
      std::vector<Tick> block(64);
      for (std::int64_t number = 0;;) {
        const bool is_first = number == 0;
        for (Tick& tick : block) tick.number = tick.device.sequence = static_cast<std::uint32_t>(++number);
        writer.append(block);
        if (is_first && write(begun[1], "x", 1) != 1) _exit(1);
      }
    }
    char first = 0;
    ASSERT_EQ(read(begun[0], &first, 1), 1);  // however busy the machine is
    close(begun[0]);
    close(begun[1]);
    usleep(static_cast<useconds_t>(10000 + 7000 * round));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_FALSE(std::filesystem::exists(path)) << "looks finished";
    const Recording recording = read_recording(path + ".partial");
    EXPECT_GT(recording.ticks.size(), 0u);
    int file = -1;
    std::size_t records = 0;
    EXPECT_EQ(nc_open((path + ".partial").c_str(), NC_NOWRITE, &file), NC_NOERR);
    EXPECT_EQ(nc_inq_dimlen(file, 0, &records), NC_NOERR);
    EXPECT_EQ(records, recording.ticks.size()) << "for everybody else";
    nc_close(file);
    EXPECT_EQ(recording.ticks.size() % 64, 0u);
    const std::size_t bytes = std::filesystem::file_size(path + ".partial");
    for (std::size_t k = 0; k < recording.ticks.size(); ++k) ASSERT_EQ(recording.ticks[k].device.sequence, k + 1);
    // no more than the block under way is lost
    const double per_tick = 708 + 24 * 2;
    EXPECT_LT(static_cast<double>(bytes), (static_cast<double>(recording.ticks.size()) + 64) * per_tick + 20000);
  }
}

TEST(Recording, EndsWhereTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(5).some(500, 2);
  const std::string path = folder / "a.nc";
  std::size_t kept = 0;
  {
    const FileSizeLimit limit(100000);
    RecordingWriter writer(path, some_info(2));
    EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(20)));
    EXPECT_EQ(writer.trouble(), path + ": recording ended: File too large; it is whole up to here");
    kept = writer.records();
    EXPECT_GT(kept, 100u) << "what still fits is kept";
    EXPECT_LE(writer.bytes(), 100000u);
    EXPECT_GT(writer.bytes() + writer.record_size(), 100000u);
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(490))) << "nothing behind a gap";
    EXPECT_EQ(writer.records(), kept);
    EXPECT_TRUE(writer.finish(some_end()));
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
  const Recording recording = read_recording(path);
  expect_same(recording.ticks, {ticks.begin(), ticks.begin() + static_cast<std::ptrdiff_t>(kept)});
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->missed, 17);
  EXPECT_EQ(recording.end->early, "File too large");
  EXPECT_EQ(recording.note, path + " ended before the session: File too large");
}

TEST(Recording, SaysWhenItCannotStart) {
  const TemporaryFolder folder;
  const FileSizeLimit limit(1000);
  try {
    RecordingWriter writer(folder / "a.nc", some_info(2));
    ADD_FAILURE() << "started";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_NE(std::string(error.what()).find("cannot record: File too large"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.nc.partial"));
}

TEST(Recording, OverwritesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto refused = [&path] {
    try {
      RecordingWriter writer(path, some_info(2));
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return std::string(error.what());
    }
    return std::string("taken");
  };
  write_file(path, "a letter");
  EXPECT_NE(refused().find("is not overwritten"), std::string::npos);
  EXPECT_EQ(file_text(path), "a letter");
  std::filesystem::remove(path);
  write_file(path + ".partial", "");
  EXPECT_NE(refused().find("of a session that was killed or is still running"), std::string::npos);
  std::filesystem::remove(path + ".partial");
  write_file(path, "");  // as mktemp leaves it
  EXPECT_EQ(refused(), "taken");
  std::filesystem::remove(path + ".partial");
  EXPECT_THROW(check_recording_path(folder / "no/such/folder.nc"), Error);
  EXPECT_THROW(check_recording_path(folder / ""), Error);
}

// What appears under the recording's name during the session is somebody's.
TEST(Recording, WhatAppearsMeanwhileStays) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto ticks = RandomTicks(6).some(20, 2);
  RecordingWriter writer(path, some_info(2));
  EXPECT_TRUE(writer.append(ticks));
  write_file(path, "a letter");
  EXPECT_FALSE(writer.finish(some_end()));
  EXPECT_EQ(writer.trouble(),
            path + ": something was put there meanwhile, and is not overwritten; the recording is whole at " + path + ".partial");
  EXPECT_EQ(file_text(path), "a letter");
  expect_same(read_recording(path + ".partial").ticks, ticks);
}

TEST(Recording, APartialFileThatIsTakenAwayIsNotCalledWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc", partial = path + ".partial";
  const auto ticks = RandomTicks(7).some(40, 2);
  {
    RecordingWriter writer(path, some_info(2));
    EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
    std::filesystem::remove(partial);
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(20)));
    EXPECT_EQ(writer.trouble(),
              path + ": recording ended: " + partial + " was removed or renamed meanwhile, and with it what was recorded");
    EXPECT_FALSE(writer.finish(some_end()));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  RecordingWriter writer(path, some_info(2));
  EXPECT_TRUE(writer.append(ticks));
  std::filesystem::rename(partial, folder / "mine");
  write_file(partial, "a letter");
  EXPECT_FALSE(writer.finish(some_end()));
  EXPECT_NE(writer.trouble().find("was removed or renamed"), std::string::npos);
  EXPECT_EQ(file_text(partial), "a letter");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Recording, APartialFileThatIsCutIsNotCalledWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto ticks = RandomTicks(8).some(40, 2);
  RecordingWriter writer(path, some_info(2));
  EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
  std::filesystem::resize_file(path + ".partial", writer.bytes() - 9 * writer.record_size() - 5);
  EXPECT_FALSE(writer.append(std::span(ticks).subspan(20))) << "nothing behind a gap";
  EXPECT_NE(writer.trouble().find(".partial was cut to "), std::string::npos) << writer.trouble();
  writer.finish(some_end());
  const Recording recording = read_recording(path);
  expect_same(recording.ticks, {ticks.begin(), ticks.begin() + 10});
  EXPECT_EQ(recording.note, path + " ended before the session: its file was cut");
}

TEST(Recording, ALinkIsFollowed) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc", target = folder / "target.nc";
  std::filesystem::create_symlink("target.nc", path);
  const auto ticks = RandomTicks(9).some(5, 2);
  {
    RecordingWriter writer(path, some_info(2));
    EXPECT_TRUE(std::filesystem::exists(target + ".partial"));
    EXPECT_TRUE(writer.append(ticks));
    EXPECT_TRUE(writer.finish(some_end()));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(path));
  expect_same(read_recording(target).ticks, ticks);
  EXPECT_THROW(check_recording_path(path), Error) << "with something in it now";
  EXPECT_THROW(check_recording_path("-"), Error);
}

TEST(Recording, RefusesOtherFiles) {
  const TemporaryFolder folder;
  EXPECT_REFUSED(folder / "missing.nc", "No such file");
  EXPECT_REFUSED(std::string("/tmp"), "is a directory");
  EXPECT_REFUSED(std::string("/dev/null"), "is a device");
  const std::string path = folder / "other.nc";
  for (const std::string& bytes : {std::string(), std::string("CDF"), std::string("CDF\1"), std::string("some text\n")}) {
    write_file(path, bytes);
    EXPECT_REFUSED(path, "is no recording");
  }
  for (const int mode : {NC_NETCDF4, NC_64BIT_OFFSET}) {
    std::filesystem::remove(path);
    int file = -1, dimension = -1, variable = -1;
    ASSERT_EQ(nc_create(path.c_str(), mode, &file), NC_NOERR);
    nc_def_dim(file, "tick", NC_UNLIMITED, &dimension);
    nc_def_var(file, "state", NC_BYTE, 1, &dimension, &variable);
    nc_close(file);
    EXPECT_REFUSED(path, mode == NC_NETCDF4 ? "is a NetCDF-4 file" : "but another NetCDF file");
  }
}

// A recording with some bytes of it changed.
class Changed {
 public:
  explicit Changed(std::size_t ticks) : path_(folder_ / "changed.nc") {
    whole_ = file_text(record(folder_, RandomTicks(11).some(ticks, 2)));
    header_ = classic::parse_header(whole_, whole_.size());
  }

  // Another name of the same length, wherever it stands in the header.
  std::string& renamed(const std::string& from, const std::string& to) {
    bytes_ = whole_;
    std::string length;
    classic::append_32(length, static_cast<std::uint32_t>(from.size()));
    bool found = false;
    for (std::size_t at = 0; (at = bytes_.find(length + from, at)) < header_.bytes; ++at) {
      bytes_.replace(at + 4, to.size(), to);
      found = true;
    }
    EXPECT_TRUE(found) << from;
    return save();
  }
  std::string& with_value(const char* name, std::size_t record, const std::string& value) {
    bytes_ = whole_;
    bytes_.replace(header_.variable(name)->begin + record * header_.record_size, value.size(), value);
    return save();
  }
  std::string& with_byte(std::size_t at, char byte) {
    bytes_ = whole_;
    bytes_[at] = byte;
    return save();
  }
  // Another header of the same length: places and lengths of its parts.
  std::string& with_header(const std::function<void(classic::Header&)>& change) {
    classic::Header other = header_;
    change(other);
    const std::string start = classic::encode_header(other);
    EXPECT_EQ(start.size(), header_.bytes);
    bytes_ = start + whole_.substr(start.size());
    return save();
  }
  std::string& cut_at(std::size_t length) {
    bytes_ = whole_.substr(0, length);
    return save();
  }
  const std::string& whole() const { return whole_; }
  const classic::Header& header() const { return header_; }

 private:
  std::string& save() {
    write_file(path_, bytes_);
    return path_;
  }

  TemporaryFolder folder_;
  std::string path_, whole_, bytes_;
  classic::Header header_;
};

std::string as_real(double value) {
  std::string bytes;
  classic::append_real(bytes, value);
  return bytes;
}

TEST(Recording, RefusesWhatLacksSomething) {
  Changed changed(3);
  for (const char* name : {"state", "device_gap", "proxies", "liquid_volume", "step_time"}) {
    std::string other = name;
    other[0] = 'X';
    EXPECT_REFUSED(changed.renamed(name, other), fmt::format("lacks the variable {}(tick", name));
  }
  EXPECT_REFUSED(changed.renamed("rate_Hz", "rate_hz"), "lacks the attribute rate_Hz");
  EXPECT_REFUSED(changed.renamed("scene_name", "scene_nam_"), "lacks the text attribute scene_name");
  EXPECT_REFUSED(changed.renamed("content", "contenT"), "but another NetCDF file");
  EXPECT_REFUSED(changed.renamed("contact", "contacT"), "lacks the variable");
}

TEST(Recording, RefusesWhatCannotBe) {
  Changed changed(4);
  EXPECT_REFUSED(changed.with_value("tick", 2, as_real(1)), "record 2: tick 1 after");
  EXPECT_REFUSED(changed.with_value("tick", 2, as_real(NOT_A_NUMBER)), "record 2: tick is none");
  EXPECT_REFUSED(changed.with_value("tick", 0, as_real(-1)), "record 0: tick is none");
  EXPECT_REFUSED(changed.with_value("tick", 3, as_real(1e300)), "record 3: tick is none");
  EXPECT_REFUSED(changed.with_value("tick", 3, as_real(5000.5)), "record 3: tick is none");
  EXPECT_REFUSED(changed.with_value("state", 1, "\x07"), "record 1: state is none");
  EXPECT_REFUSED(changed.with_value("read", 1, "\x03"), "record 1: read is none");
  EXPECT_REFUSED(changed.with_value("fault", 1, "\x0a"), "record 1: fault is none");
  EXPECT_REFUSED(changed.with_value("task_done", 1, "\xff"), "record 1: task_done is none");
  EXPECT_REFUSED(changed.with_value("vessel_index", 1, std::string("\0\0\0\2", 4)), "record 1: vessel_index 2 of 2 vessels");
  EXPECT_REFUSED(changed.with_value("vessel_index", 1, "\xff\xff\xff\xfe"), "record 1: vessel_index is none");
  EXPECT_REFUSED(changed.with_value("grasps", 1, "\xff\xff\xff\xff"), "record 1: grasps is none");
  EXPECT_REFUSED(changed.with_value("step_time", 1, as_real(NOT_A_NUMBER)), "record 1: step_time is none");
  EXPECT_REFUSED(changed.with_value("latency", 1, as_real(INFINITE)), "record 1: latency is none");
  EXPECT_REFUSED(changed.with_value("written_arm_force", 1, as_real(NOT_A_NUMBER)), "record 1: written_arm_force is none");
  EXPECT_NO_THROW(read_recording(changed.with_value("hold_force", 1, as_real(NOT_A_NUMBER))));
}

TEST(Recording, RefusesPlacesThatCannotBe) {
  Changed changed(2);
  const auto place = [](const char* name, const std::function<void(std::uint64_t&, const classic::Header&)>& move) {
    return [name, move](classic::Header& header) {
      for (classic::Variable& variable : header.variables) {
        if (variable.name == name) move(variable.begin, header);
      }
    };
  };
  const auto set = [](std::uint64_t to) { return [to](std::uint64_t& at, const classic::Header&) { at = to; }; };
  EXPECT_NO_THROW(read_recording(changed.with_header([](classic::Header&) {})));
  EXPECT_REFUSED(changed.with_header(place("vessel", set(0))), "'vessel' has no place in the file");
  EXPECT_REFUSED(changed.with_header(place("vessel", set(1ull << 40))), "'vessel' has no place in the file");
  EXPECT_REFUSED(changed.with_header(place("state", set(~0ull))), "'state' has no place in the file");
  EXPECT_REFUSED(changed.with_header(place("state", set(1ull << 40))), "'state' has no place in the records");
  EXPECT_REFUSED(changed.with_header(place("state", [](std::uint64_t& at, const classic::Header&) { at -= 4; })), "has no place");
  EXPECT_REFUSED(changed.with_header(place("time", [](std::uint64_t& at, const classic::Header&) { at -= 400; })), "has no place");
  const auto length = [](const char* name, std::uint32_t to) {
    return [name, to](classic::Header& header) {
      for (classic::Dimension& dimension : header.dimensions) {
        if (dimension.name == name) dimension.length = to;
      }
    };
  };
  EXPECT_REFUSED(changed.with_header(length("vessel", 0xFFFFFFFF)), "");
  EXPECT_REFUSED(changed.with_header(length("text_length", 0xFFFFFFFF)), "has no place in the file");
  EXPECT_REFUSED(changed.with_header(length("xyz", 0)), "has the records in the wrong place");
  EXPECT_REFUSED(changed.with_header(length("xyz", 0xFFFFFFFF)), "");
  EXPECT_REFUSED(changed.with_header([](classic::Header& header) { header.variables[3].dimensions[0] = 1000; }), "damaged");
  EXPECT_REFUSED(changed.with_header([](classic::Header& header) { header.variables.back().type = classic::Type::float32; }), "");
}

TEST(Recording, ReadsWhatIsThereOfACutFile) {
  Changed changed(10);
  const auto& header = changed.header();
  for (std::size_t records = 0; records < 10; ++records) {
    for (const std::size_t more : {std::size_t{0}, std::size_t{1}, std::size_t{header.record_size - 1}}) {
      const std::string& path = changed.cut_at(header.record_begin + records * header.record_size + more);
      const Recording recording = read_recording(path);
      EXPECT_EQ(recording.ticks.size(), records);
      EXPECT_EQ(recording.note, fmt::format("{} is cut off: {} of 10 ticks are there", path, records));
    }
  }
  // as some programs leave the count: the file's length tells
  const std::string& path = changed.with_byte(4, '\xff');
  std::string bytes = file_text(path);
  bytes.replace(4, 4, "\xff\xff\xff\xff");
  write_file(path, bytes);
  EXPECT_EQ(read_recording(path).ticks.size(), 10u);
  // not even the header
  for (std::size_t length = 0; length < header.record_begin; length += length < 64 ? 1 : 97) refusal(changed.cut_at(length));
}

// Any byte of the header, changed to anything: it is read or refused.
TEST(Recording, TakesNoHarmFromADamagedHeader) {
  Changed changed(2);
  int refused = 0;
  for (std::size_t at = 0; at < changed.header().bytes; at += 7) {
    for (const char byte : {'\0', '\x7f', '\xff'}) {
      const std::string& path = changed.with_byte(at, byte);
      try {
        read_recording(path);
      } catch (const Error& error) {
        ASSERT_EQ(error.code, ExitCode::usage);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 500);
}

TEST(Recorder, WritesDownWhatGoesThroughTheRing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  TickRing ring(4096);
  std::vector<std::int64_t> seen;  // by the recorder's thread until it has stopped
  Recorder recorder(ring, std::make_unique<RecordingWriter>(path, some_info(2)), [&seen](std::span<const Tick> batch) {
    for (const Tick& tick : batch) seen.push_back(tick.number);
  });
  const auto ticks = RandomTicks(2).some(20000, 2);
  for (const Tick& tick : ticks) {
    while (!ring.push(tick)) usleep(100);
  }
  EXPECT_TRUE(recorder.stop(some_end()));
  EXPECT_TRUE(recorder.stop({}));
  EXPECT_FALSE(recorder.trouble());
  const Recording recording = read_recording(path);
  expect_same(recording.ticks, ticks);
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->missed, 17);
  ASSERT_EQ(seen.size(), ticks.size()) << "each is shown, once";
  for (std::size_t k = 0; k < seen.size(); ++k) ASSERT_EQ(seen[k], ticks[k].number) << k;
}

TEST(Recorder, GoesOnDrainingWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const FileSizeLimit limit(200000);
  TickRing ring(1024);
  Recorder recorder(ring, std::make_unique<RecordingWriter>(path, some_info(2)));
  std::optional<std::string> trouble;
  std::size_t told = 0;
  Tick tick;
  for (; tick.number < 10000; ++tick.number) {
    while (!ring.push(tick)) usleep(1000);
    if (auto news = recorder.trouble()) {
      trouble = news;
      ++told;
    }
  }
  EXPECT_FALSE(recorder.stop(some_end()));
  if (recorder.trouble()) ++told;
  EXPECT_EQ(told, 1u) << "once, and while the session goes on";
  ASSERT_TRUE(trouble);
  EXPECT_EQ(*trouble, path + ": recording ended: File too large; it is whole up to here");
  EXPECT_EQ(ring.size(), 0u);
  const Recording recording = read_recording(path);
  EXPECT_GT(recording.ticks.size(), 100u);
  EXPECT_LT(recording.ticks.size(), 300u);
  EXPECT_EQ(recording.ticks.back().number, static_cast<std::int64_t>(recording.ticks.size()) - 1);
  EXPECT_NE(recording.end->early, "");
}

TEST(Recorder, DrainsWithoutARecording) {
  TickRing ring(256);
  std::atomic<std::int64_t> newest = -1;
  Recorder recorder(ring, nullptr, [&newest](std::span<const Tick> batch) { newest = batch.back().number; });
  Tick tick;
  for (; tick.number < 1000; ++tick.number) {
    while (!ring.push(tick)) usleep(100);
  }
  EXPECT_TRUE(recorder.stop({}));
  EXPECT_EQ(newest, 999);
}

// Dropped without a word, as when the session ends by an exception: what was in the ring is in the file.
TEST(Recorder, FinishesWhenItGoes) {
  const TemporaryFolder folder;
  TickRing ring(64);
  {
    Recorder recorder(ring, std::make_unique<RecordingWriter>(folder / "a.nc", some_info(1)));
    for (Tick tick; tick.number < 50; ++tick.number) ring.push(tick);
  }
  const Recording recording = read_recording(folder / "a.nc");
  EXPECT_EQ(recording.ticks.size(), 50u);
  EXPECT_TRUE(recording.end);
}

}  // namespace
}  // namespace wholehand
