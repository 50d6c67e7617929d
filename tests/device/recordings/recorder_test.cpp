// SPDX-License-Identifier: MIT
// The thread that writes down what goes through the ring.
// sanitizers: thread
#include "device/recordings/recorder.h"

#include "device/recordings/recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/recorded_ticks.h"

namespace wholehand::device {
namespace {

TEST(Recorder, WritesDownWhatGoesThroughTheRing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  TickRing ring(4096);
  std::vector<std::int64_t> seen;  // by the recorder's thread until it has stopped
  Recorder recorder(ring, std::make_unique<RecordingWriter>(path, recorded_info(2)), [&seen](std::span<const Tick> batch) {
    for (const Tick& tick : batch) seen.push_back(tick.number);
  });
  const auto ticks = RandomTicks(2).some(20000, 2);
  for (const Tick& tick : ticks) {
    while (!ring.push(tick)) usleep(100);
  }
  EXPECT_TRUE(recorder.stop(recorded_end()));
  EXPECT_TRUE(recorder.stop({}));
  EXPECT_FALSE(recorder.take_error());
  const Recording recording = read_recording(path);
  expect_same_ticks(recording.ticks, ticks);
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
  Recorder recorder(ring, std::make_unique<RecordingWriter>(path, recorded_info(2)));
  std::optional<std::string> error;
  std::size_t reports = 0;
  Tick tick;
  for (; tick.number < 10000; ++tick.number) {
    while (!ring.push(tick)) usleep(1000);
    if (auto taken = recorder.take_error()) {
      error = taken;
      ++reports;
    }
  }
  EXPECT_FALSE(recorder.stop(recorded_end()));
  if (recorder.take_error()) ++reports;
  EXPECT_EQ(reports, 1u) << "once, and while the session goes on";
  ASSERT_TRUE(error);
  EXPECT_EQ(*error, path + ": recording ended: File too large; it is complete up to here");
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
    Recorder recorder(ring, std::make_unique<RecordingWriter>(folder / "a.nc", recorded_info(1)));
    for (Tick tick; tick.number < 50; ++tick.number) ring.push(tick);
  }
  const Recording recording = read_recording(folder / "a.nc");
  EXPECT_EQ(recording.ticks.size(), 50u);
  EXPECT_TRUE(recording.end);
}

}  // namespace
}  // namespace wholehand::device
