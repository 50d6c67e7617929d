// SPDX-License-Identifier: MIT
// The thread that takes ticks from the haptic thread and writes them to disk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "device/recordings/recording.h"
#include "device/session/tick_ring.h"

namespace wholehand::device {

constexpr std::chrono::milliseconds DRAIN_INTERVAL{
    50};  // a killed process loses at most this much, and some 400 ticks at 8 kHz wait

// Drains a ring from construction until stop(), so that the pushing thread never waits and, as long as the disk keeps up or refuses, never finds it
// full. The ring must outlive this and hold what comes during a pause of the disk: a few seconds.
class Recorder {
 public:
  // Called on the recorder's thread with each batch of ticks, all in order (for a status line, say). Must not throw.
  using Observer = std::function<void(std::span<const Tick>)>;

  // Without a writer it only drains and shows. `interval`: between two looks into the ring; shorter with a display.
  Recorder(TickRing& ring, std::unique_ptr<RecordingWriter> writer, Observer observer = {},
           std::chrono::microseconds interval = DRAIN_INTERVAL);
  // Stops; if stop() was not called before, the recording gets an end without timing.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Why the recording ended early or was not renamed, once, as soon as it is known; otherwise nothing. From any thread but the pushing one.
  std::optional<std::string> take_error();

  // Takes the rest of the ring (nothing may be pushed any more), finishes the recording and ends the thread. False: the recording is incomplete;
  // take_error() says why. Later calls do nothing and return the same.
  bool stop(const RecordingEnd& end);
  // The recording's place then (RecordingWriter::place); empty without a writer.
  std::string place() const { return writer_ ? writer_->place() : ""; }

 private:
  void run();
  bool drain();
  void keep_error();

  TickRing& ring_;
  std::unique_ptr<RecordingWriter> writer_;
  Observer observer_;
  std::chrono::microseconds interval_;
  std::vector<Tick> block_;
  std::string reported_;  // the latest error of the writer that was passed on
  bool is_whole_ = true;

  std::mutex mutex_;  // of the next three; the pushing thread does not use it
  std::condition_variable wake_;
  bool is_stopping_ = false;
  std::optional<std::string> last_error_;  // until it is read

  std::thread thread_;  // declared last: it uses all of the above
};

}  // namespace wholehand::device
