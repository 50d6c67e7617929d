// SPDX-License-Identifier: MIT
// What is no recording, or a damaged one: refused in a line, or read as far as it goes.
// sanitizers: thread
#include "device/recordings/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "base/text/error.h"
#include "tests/support/files.h"
#include "tests/support/recorded_ticks.h"
#include "tests/support/refusal.h"
#include "tests/support/special_values.h"

namespace wholehand::device {
namespace {

// What reading it is refused with: exit code 2 and one line that starts with the file.
std::string refusal(const std::string& path) {
  const std::string line = refusal_line([&] { read_recording(path); });
  EXPECT_EQ(line.rfind(path + ": ", 0), 0u) << (line.empty() ? "was read" : line);
  return line;
}

#define EXPECT_REFUSED(path, gist)                               \
  do {                                                           \
    const std::string refused = refusal(path);                   \
    EXPECT_NE(refused.find(gist), std::string::npos) << refused; \
  } while (false)

TEST(Recording, RefusesOtherFiles) {
  const TemporaryFolder folder;
  EXPECT_REFUSED(folder / "missing.nc", "No such file");
  EXPECT_REFUSED(std::string("/tmp"), "is a directory");
  EXPECT_REFUSED(std::string("/dev/null"), "is a device");
  const std::string path = folder / "other.nc";
  for (const std::string& bytes : {std::string(), std::string("CDF"), std::string("CDF\1"), std::string("some text\n")}) {
    write_file(path, bytes);
    EXPECT_REFUSED(path, "is not a recording");
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
    whole_ = file_text(record_session(folder_, RandomTicks(11).some(ticks, 2)));
    header_ = classic::parse_header(whole_, whole_.size());
  }

  // Another name of the same length, anywhere in the header.
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
    renew_checksums(bytes_);
    return save();
  }
  std::string& with_value(const char* name, std::size_t record, const std::string& value) {
    bytes_ = whole_;
    bytes_.replace(header_.variable(name)->begin + record * header_.record_size, value.size(), value);
    renew_checksums(bytes_);
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
    renew_checksums(bytes_);
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

TEST(Recording, RefusesVersionsBefore04) {
  Changed changed(1);
  EXPECT_REFUSED(changed.renamed("1.2.3", "0.3.9"),
                 "written by version 0.3.9; this version reads files from 0.4.0 on: record the session again");
  EXPECT_NO_THROW(read_recording(changed.renamed("1.2.3", "0.4.0")));
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
  EXPECT_REFUSED(changed.with_value("tick", 2, as_real(1)), "record 2: tick 1 follows");
  EXPECT_REFUSED(changed.with_value("tick", 2, as_real(NOT_A_NUMBER)), "record 2: tick has an impossible value");
  EXPECT_REFUSED(changed.with_value("tick", 0, as_real(-1)), "record 0: tick has an impossible value");
  EXPECT_REFUSED(changed.with_value("tick", 3, as_real(1e300)), "record 3: tick has an impossible value");
  EXPECT_REFUSED(changed.with_value("tick", 3, as_real(5000.5)), "record 3: tick has an impossible value");
  EXPECT_REFUSED(changed.with_value("state", 1, "\x08"), "record 1: state has an impossible value");
  EXPECT_REFUSED(changed.with_value("read", 1, "\x03"), "record 1: read has an impossible value");
  EXPECT_REFUSED(changed.with_value("fault", 1, "\x0a"), "record 1: fault has an impossible value");
  EXPECT_REFUSED(changed.with_value("task_done", 1, "\xff"), "record 1: task_done has an impossible value");
  EXPECT_REFUSED(changed.with_value("vessel_index", 1, std::string("\0\0\0\2", 4)), "record 1: vessel_index 2 of 2 vessels");
  EXPECT_REFUSED(changed.with_value("vessel_index", 1, "\xff\xff\xff\xfe"), "record 1: vessel_index has an impossible value");
  EXPECT_REFUSED(changed.with_value("grasps", 1, "\xff\xff\xff\xff"), "record 1: grasps has an impossible value");
  EXPECT_REFUSED(changed.with_value("step_time", 1, as_real(NOT_A_NUMBER)), "record 1: step_time has an impossible value");
  EXPECT_REFUSED(changed.with_value("latency", 1, as_real(INFINITE)), "record 1: latency has an impossible value");
  EXPECT_REFUSED(changed.with_value("written_arm_force", 1, as_real(NOT_A_NUMBER)),
                 "record 1: written_arm_force has an impossible value");
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
  // as some programs leave the count: the file's length decides
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

}  // namespace
}  // namespace wholehand::device
