// SPDX-License-Identifier: MIT
// The thread that takes ticks from the haptic thread and writes them down.
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

namespace wholehand {

constexpr std::chrono::milliseconds DRAIN_INTERVAL{
    50};  // at most this much is lost with the process, and some 400 ticks at 8 kHz wait

// Drains a ring from construction until stop(), so that the thread that pushes never waits and, as long as the disk keeps up or refuses, never
// finds it full. The ring must outlive it and hold what comes during a pause of the disk: a few seconds.
class Recorder {
 public:
  // Called on the recorder's thread with each batch of ticks, all of them in their order (a status line, say). Must not throw.
  using Observer = std::function<void(std::span<const Tick>)>;

  // Without a writer it only drains and shows. `interval`: between two looks into the ring; shorter with a display.
  Recorder(TickRing& ring, std::unique_ptr<RecordingWriter> writer, Observer observer = {},
           std::chrono::microseconds interval = DRAIN_INTERVAL);
  // Stops; a recording that was not stopped before gets an end without timing.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Why the recording ended early or did not get its name, once, as soon as it is known; nothing otherwise. From any thread but the one that pushes.
  std::optional<std::string> take_error();

  // Takes what is still in the ring (nothing may be pushed any more), finishes the recording and ends the thread. False: the recording is
  // not all there; take_error() says why. Calls after the first do nothing and give the same answer.
  bool stop(const RecordingEnd& end);
  // Where it is then (RecordingWriter::place); empty without a writer.
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
  std::string reported_;  // the latest trouble of the writer that was passed on
  bool is_whole_ = true;

  std::mutex mutex_;  // of the next three; the thread that pushes knows nothing of it
  std::condition_variable wake_;
  bool is_stopping_ = false;
  std::optional<std::string> last_error_;  // until it is read

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace wholehand
