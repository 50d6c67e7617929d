// SPDX-License-Identifier: MIT
// One bit of a recording flipped anywhere: it is refused, or is read as it was written.
#include "device/recordings/checksums.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "base/text/error.h"
#include "device/recordings/layout.h"
#include "device/recordings/recording.h"
#include "tests/support/files.h"
#include "tests/support/recorded_ticks.h"
#include "tests/support/refusal.h"

namespace wholehand::device {
namespace {

// All that a recording says.
std::string content_of(const Recording& recording) {
  const RecordingLayout layout = layout_recording(recording.info);
  std::string text = classic::encode_header(layout.header) + layout.fixed;
  for (const Tick& tick : recording.ticks)
    for (const RecordedField& field : recorded_fields()) append_field(text, field, tick, recording.info.vessels.size());
  if (!recording.end) return text;
  const RecordingEnd& end = *recording.end;
  for (const Percentiles& values : {end.period, end.step})
    text += fmt::format(" {} {} {} {}", values.p50, values.p99, values.p999, values.max);
  return text + fmt::format(" {} {} {}", end.missed, static_cast<int>(end.fault), end.early);
}

class FlippedRecording : public testing::Test {
 protected:
  // The line with which it is refused; empty: it is read as it was.
  std::string line_of(std::size_t at) {
    std::string bytes = whole_;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << random_() % 8);
    write_file(path_, bytes);
    std::string found;
    const std::string line = refusal_line([&] { found = content_of(read_recording(path_)); });
    if (line.empty()) {
      EXPECT_EQ(found, expected_) << "another content without a word, byte " << at;
    }
    return line;
  }
  void take(const std::string& path) {
    whole_ = file_text(path);
    expected_ = content_of(read_recording(path));
    header_ = classic::parse_header(whole_, whole_.size());
  }

  std::mt19937 random_{5};
  TemporaryFolder folder_;
  std::string path_ = folder_ / "flipped.nc", whole_, expected_;
  classic::Header header_;
};

TEST_F(FlippedRecording, AnyBitOfAFinishedOneIsNoticed) {
  take(record_session(folder_, RandomTicks(12).some(6, 2)));
  std::size_t refused = 0;
  for (std::size_t at = 0; at < header_.record_begin; at += 3) refused += !line_of(at).empty();
  EXPECT_GT(refused, header_.bytes / 3 * 9 / 10) << "but what pads the names";
  for (const classic::Variable& variable : header_.variables) {
    if (!variable.is_record) continue;
    const std::size_t record = random_() % 6, size = variable.values * classic::type_size(variable.type);
    EXPECT_EQ(line_of(variable.begin + record * header_.record_size + random_() % size),
              fmt::format("{}: record {} is damaged: its checksum is wrong; use a copy that is not damaged", path_, record))
        << variable.name;
  }
}

TEST_F(FlippedRecording, FewerOrMoreTicksThanWereCountedAreNoticed) {
  take(record_session(folder_, RandomTicks(13).some(5, 1), 1));
  for (std::size_t at = classic::RECORD_COUNT_PLACE; at < classic::RECORD_COUNT_PLACE + 4; ++at)
    EXPECT_NE(line_of(at).find("is damaged: the number of its ticks is not the one that the session wrote"), std::string::npos);
  // two whole records that change places
  const std::size_t second = header_.record_begin + header_.record_size;
  const std::string swapped =
      whole_.substr(second + header_.record_size, header_.record_size) + whole_.substr(second, header_.record_size);
  write_file(path_, std::string(whole_).replace(second, swapped.size(), swapped));
  EXPECT_NE(refusal_line([&] { read_recording(path_); }).find("record 1 is damaged"), std::string::npos);
}

// A session that was killed: as far as the records are whole, whatever the count says.
TEST_F(FlippedRecording, AnyBitOfAnUnfinishedOneIsNoticed) {
  {
    RecordingWriter writer(folder_ / "a.nc", recorded_info(2));
    EXPECT_TRUE(writer.append(RandomTicks(14).some(6, 2)));
  }
  take(folder_ / "a.nc.partial");
  for (std::size_t at = 0; at < header_.bytes; at += 5) line_of(at);
  for (std::size_t at = header_.record_begin; at < whole_.size(); at += 61) line_of(at);
  std::string bytes = whole_;
  bytes[classic::RECORD_COUNT_PLACE + 3] = 4;  // the last two were not counted yet
  write_file(path_, bytes);
  EXPECT_EQ(read_recording(path_).ticks.size(), 6u);
  bytes[header_.record_begin + 5 * header_.record_size + 8] ^= 1;
  write_file(path_, bytes);
  EXPECT_EQ(read_recording(path_).ticks.size(), 5u) << "and one of them is not whole";
}

// Another program may lay the file out anew, and pad it otherwise.
TEST_F(FlippedRecording, WhereValuesLieDoesNotCount) {
  take(record_session(folder_, RandomTicks(15).some(3, 2)));
  classic::Header moved = header_;
  classic::lay_out(moved, 12);
  std::string bytes = classic::encode_header(moved);
  bytes.resize(moved.bytes + 12, 'x');
  bytes += whole_.substr(header_.record_begin - (moved.record_begin - moved.bytes - 12));
  write_file(path_, bytes);
  EXPECT_EQ(content_of(read_recording(path_)), expected_);
}

}  // namespace
}  // namespace wholehand::device
