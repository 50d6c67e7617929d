// SPDX-License-Identifier: MIT
// What a recording holds: every bit of every tick, as this program and others read it.
// sanitizers: thread
#include "device/recordings/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/hand_size.h"
#include "core/people/person.h"
#include "core/reader/reader.h"
#include "device/recordings/fields.h"
#include "tests/support/files.h"
#include "tests/support/recorded_ticks.h"

namespace wholehand::device {
namespace {

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
    RecordingWriter writer(path, recorded_info(vessels));
    // blocks of every size, none among them
    for (std::size_t first = 0, size = 0; first < ticks.size(); first += size++) {
      size = std::min(size, ticks.size() - first);
      ASSERT_TRUE(writer.append(std::span(ticks).subspan(first, size)));
    }
    EXPECT_EQ(writer.records(), ticks.size());
    EXPECT_TRUE(std::filesystem::exists(path + ".partial"));
    EXPECT_TRUE(writer.finish(recorded_end()));
    EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
    EXPECT_EQ(std::filesystem::file_size(path), writer.bytes());
    const Recording recording = read_recording(path);
    expect_same_ticks(recording.ticks, ticks);
    EXPECT_EQ(recording.note, "");
  }
}

TEST(Recording, GivesBackWhatIsKnownOfTheSession) {
  const TemporaryFolder folder;
  const RecordingInfo info = recorded_info(3);
  RecordingWriter writer(folder / "a.nc", info);
  EXPECT_TRUE(writer.finish(recorded_end()));
  const Recording recording = read_recording(folder / "a.nc");
  EXPECT_TRUE(recording.ticks.empty());
  const RecordingInfo& got = recording.info;
  EXPECT_EQ(got.scene_name, info.scene_name);
  EXPECT_EQ(got.scene_file, info.scene_file);
  EXPECT_EQ(got.scene_text, info.scene_text);
  EXPECT_EQ(got.version, info.version);
  EXPECT_EQ(got.start, info.start);
  EXPECT_EQ(got.seed, info.seed);
  EXPECT_FALSE(got.person);
  EXPECT_EQ(got.rate, info.rate);
  EXPECT_EQ(got.has_clock, info.has_clock);
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

// The hand of a virtual person is not in the scene's text: the number is.
TEST(Recording, GivesBackThePersonAndTheirHand) {
  const TemporaryFolder folder;
  RecordingInfo info = recorded_info(1);
  info.scene_text = "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 70\nheight_mm = 95\nwall_mm = 1\n";
  info.seed = 5;
  info.person = 18446744073709551615u;
  RecordingWriter(folder / "a.nc", info).finish(recorded_end());
  const RecordingInfo got = read_recording(folder / "a.nc").info;
  ASSERT_TRUE(got.person);
  EXPECT_EQ(*got.person, *info.person);
  const Scene plain = parse_scene(info.scene_text, "a.toml"), own = scene_of_recording(got);
  EXPECT_EQ(size_of(own.hand).length, size_of(hand_of(plain.hand, draw_person(plain.people, 5, *info.person))).length);
  EXPECT_NE(size_of(own.hand).length, size_of(plain.hand).length);
  info.person.reset();
  EXPECT_EQ(size_of(scene_of_recording(info).hand).length, size_of(plain.hand).length);
}

// By the library that everybody else reads it with.
TEST(Recording, IsWhatTheNetcdfLibraryReads) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(3).some(50, 2);
  const std::string path = record_session(folder, ticks);
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
    EXPECT_EQ(nc_get_var1_double(file, variable("spilled_volume"), at, &value), NC_NOERR);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(ticks[k].spilled[1]));
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
  const std::string path = record_session(folder, RandomTicks(3).some(4, 2));
  const std::string command =
      "/usr/bin/python3 " WHOLEHAND_SOURCE_DIR "/tests/device/recordings/xarray_test.py '" + path + "' 'vessel 2'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Recording, KeepsNumbersOfTicksThatSkip) {
  const TemporaryFolder folder;
  std::vector<Tick> ticks(3);
  ticks[0].number = 5;
  ticks[1].number = 6;
  ticks[2].number = 9007199254740992;
  const Recording recording = read_recording(record_session(folder, ticks));
  ASSERT_EQ(recording.ticks.size(), 3u);
  EXPECT_EQ(recording.ticks[1].number, 6);
  EXPECT_EQ(recording.ticks[2].number, 9007199254740992);
}

TEST(Recording, IsReadableWhileItIsMade) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(1).some(100, 2);
  RecordingWriter writer(folder / "a.nc", recorded_info(2));
  for (std::size_t k = 0; k < 100; k += 25) {
    EXPECT_EQ(read_recording(folder / "a.nc.partial").ticks.size(), k);
    ASSERT_TRUE(writer.append(std::span(ticks).subspan(k, 25)));
  }
  const Recording recording = read_recording(folder / "a.nc.partial");
  expect_same_ticks(recording.ticks, ticks);
  EXPECT_FALSE(recording.end);
  EXPECT_EQ(recording.note, (folder / "a.nc.partial") + " was not finished: the session was killed, or is still running");
}

// A fuzzer whose seeds are refused at the first name reaches nothing behind it.
TEST(Recording, SeedsOfTheFuzzerAreRead) {
  for (const char* name : {"session", "unfinished", "cut", "empty"})
    EXPECT_NO_THROW(read_recording(std::string(WHOLEHAND_SOURCE_DIR "/tests/fuzz/corpus/recording/") + name + ".nc")) << name;
}

}  // namespace
}  // namespace wholehand::device
