// SPDX-License-Identifier: MIT
// Recordings of live sessions: every tick, and what is needed to understand or repeat it, in one NetCDF file (classic, 64-bit
// offsets). docs/session.md describes its variables.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "device/recordings/checksums.h"
#include "device/recordings/classic_netcdf.h"
#include "device/session/tick.h"

namespace wholehand {

struct RecordedVessel {
  std::string name;
  std::string liquid;               // name of what is in it; empty: nothing
  double force_range = Tick::NONE;  // F_range, N
};

// What a task wants in its target.
struct RecordedAmount {
  std::string liquid;
  double volume = 0;  // m3
};

// The gripper that was used: name, address and the largest forces that could be written to it.
struct RecordedDevice {
  std::string name, address;
  double force = 0;             // at the arm, N
  double grip = 0;              // at the fingers, N
  std::array<double, 2> gap{};  // closed, open, m
  double rate = 0;              // Hz
  bool has_rotation = true;
  bool is_left_handed = false;
};

// What is known when a recording starts.
struct RecordingInfo {
  std::string scene_name, scene_file, scene_text;
  std::string version;  // of the program
  std::string start;    // ISO 8601, with its offset from UTC
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> person;  // number of the virtual person who grips with a hand of their own, drawn by `seed`
  double rate = 1000;                   // of the force loop, Hz
  bool has_clock = true;                // false: simulated time, in which no tick is late
  RecordedDevice device;
  std::vector<RecordedVessel> vessels;  // 1 to LIVE_VESSELS
  double force_base = Tick::NONE;       // F_base, N
  double force_max = Tick::NONE;        // F_max, N
  std::vector<RecordedAmount> amounts;  // of the task; empty: no task
  double tolerance = Tick::NONE;        // of the amounts, m3
};

// s: median, 99th and 99.9th percentile, largest.
struct Percentiles {
  double p50 = 0, p99 = 0, p999 = 0, max = 0;
};

// What is known when it ends.
struct RecordingEnd {
  Percentiles period, step;   // of the loop, over all of the session
  std::int64_t missed = 0;    // periods
  Fault fault = Fault::none;  // with which the session ended
  std::string early;          // why the recording ended before the session; empty: it did not. Set by the writer, too
};

// Throws Error (usage) where no recording can be made at `path`: there is a file with something in it already (a recording cannot
// be made again, so none is ever overwritten), or a partial one of a session that was killed or is still running. `option` is the
// one that named it, for the message.
void check_recording_path(const std::string& path, const char* option = "recording");

// A recording that is being made. It lies at PATH.partial, and at PATH once it is finished. Whatever becomes of the process, the
// partial file is a whole recording of all blocks that were appended: records are only added, and counted in the file once they are
// in it.
class RecordingWriter {
 public:
  // Throws Error: (usage) as check_recording_path, (failure) the file cannot be made, with the remedy. A file that grows past the
  // process's limit is an error of the write from here on, not the end of the process.
  RecordingWriter(const std::string& path, const RecordingInfo& info, const char* option = "recording",
                  const char* remedy = "name another file");
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Adds ticks, of ascending numbers. False: not all of them could be written (the disk is full, the file too large, an error of
  // the disk); last_error() says why, what was written so far stays readable, and nothing is taken any more.
  bool append(std::span<const Tick> ticks);

  // Writes the ends, syncs, and gives the file its name; also after trouble. False: it could not, and last_error() says why and where
  // the recording is. Once.
  bool finish(RecordingEnd end);

  // Whether it has all ticks that were appended, and where it is: at PATH once it is finished, else at PATH.partial; empty: it was taken away.
  bool is_whole() const { return is_whole_; }
  const std::string& place() const { return place_; }
  // What went wrong, in one line for the user; empty: nothing.
  const std::string& last_error() const { return last_error_; }
  // The reason for that alone, as "No space left on device".
  const std::string& reason() const { return reason_; }
  std::uint64_t records() const { return header_.records; }
  std::uint64_t bytes() const;  // of the file
  std::uint64_t record_size() const { return header_.record_size; }

 private:
  std::uint64_t put(const char* data, std::uint64_t size, std::uint64_t place, int& error);
  void append_block();
  bool is_in_place() const;
  bool is_all_there();
  bool publish();
  void give_up(int error);

  std::string path_, partial_, place_;
  int file_ = -1;
  double rate_;
  std::size_t vessels_;
  classic::Header header_;
  std::string fixed_;                         // what its fixed variables hold
  std::optional<RecordChecksums> checksums_;  // of the records so far
  std::string block_;                         // records on their way into the file
  std::string last_error_, reason_;
  bool is_whole_ = true;
};

struct Recording {
  RecordingInfo info;
  std::vector<Tick> ticks;          // in the order of their numbers; may be empty
  std::optional<RecordingEnd> end;  // absent: the process ended before it
  std::string note;                 // one line, where the file holds less than it says, or is not finished; empty: it is whole
};

// Reads a recording. Values come back to the bit; a vessel that the recording does not have is as in a new Tick. Throws Error
// (usage), one line with the file: it cannot be read, is no recording, lacks something, or holds what cannot be.
Recording read_recording(const std::string& path);

// The scene of a recording, as its session had it: parses the recorded text, and gives the scene the hand of the virtual person who made the
// recording, if one did. Throws Error
// (usage) as parse_scene does. Meshes are not loaded.
Scene scene_of_recording(const RecordingInfo& info);

// Gives a scene the hand of a virtual person, by the scene's own [people].
void take_hand_of(Scene& scene, std::uint64_t seed, std::uint64_t person);

}  // namespace wholehand
