// SPDX-License-Identifier: MIT
// Recordings of live sessions: every tick, and what is needed to understand or repeat it, in one NetCDF file (classic, 64-bit offsets).
// docs/session.md describes its variables.
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

namespace wholehand::device {

struct RecordedVessel {
  std::string name;
  std::string liquid;               // name of its liquid; empty: none
  double force_range = Tick::NONE;  // F_range, N
};

// An amount that a task wants in its target.
struct RecordedAmount {
  std::string liquid;
  double volume = 0;  // m3
};

// The gripper used: name, address and the largest forces that could be written to it.
struct RecordedDevice {
  std::string name, address;
  double force = 0;             // at the arm, N
  double grip = 0;              // at the fingers, N
  std::array<double, 2> gap{};  // closed, open, m
  double rate = 0;              // Hz
  bool has_rotation = true;
  bool is_left_handed = false;
  bool pushes_each_tip = false;
};

// What is known when a recording starts.
struct RecordingInfo {
  std::string scene_name, scene_file, scene_text;
  std::string version;  // of the program
  std::string start;    // ISO 8601, with its offset from UTC
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> person;  // number of the virtual person, drawn by `seed`, who grips with their own hand
  double rate = 1000;                   // of the force loop, Hz
  bool has_clock = true;                // false: simulated time, in which no tick is late
  RecordedDevice device;
  std::vector<RecordedVessel> vessels;  // 1 to LIVE_VESSELS
  double force_base = Tick::NONE;       // F_base, N
  double force_max = Tick::NONE;        // F_max, N
  std::vector<RecordedAmount> amounts;  // of the task; empty: no task
  double tolerance = Tick::NONE;        // of the amounts, m3
};

// The same vessels by name, with the same liquids.
bool has_same_vessels(const RecordingInfo& a, const RecordingInfo& b);

// s: median, 99th and 99.9th percentile, largest.
struct Percentiles {
  double p50 = 0, p99 = 0, p999 = 0, max = 0;
};

// What is known when it ends.
struct RecordingEnd {
  Percentiles period, step;   // of the loop, over all of the session
  std::int64_t missed = 0;    // periods
  Fault fault = Fault::none;  // at the session's end
  std::string early;          // why the recording ended before the session; empty: it did not. The writer sets it, too
};

// Throws Error (usage) if no recording can be made at `path`: a nonempty file exists (a session cannot be repeated, so recordings are never
// overwritten), or a partial one of a session that was killed or still runs. `option` is the option's name for the message.
void check_recording_path(const std::string& path, const char* option = "recording");

// A recording in progress. It lies at PATH.partial, and at PATH once finished. However the process ends, the partial file is a whole recording of all
// appended blocks: records are only added, and the file counts them once they are in it.
class RecordingWriter {
 public:
  // Throws Error: (usage) as check_recording_path; (failure) the file cannot be made, with the remedy. From here on, a file that grows past the
  // process's limit makes the write fail instead of ending the process.
  RecordingWriter(const std::string& path, const RecordingInfo& info, const char* option = "recording",
                  const char* remedy = "name another file");
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Adds ticks with ascending numbers. False: not all could be written (the disk is full, the file too large, a disk error). Then last_error() says
  // why, what was written stays readable, and further ticks are refused.
  bool append(std::span<const Tick> ticks);

  // Writes the end, syncs, and renames the file; also after an error. False: it could not, and last_error() says why and where the recording is. Call
  // it once.
  bool finish(RecordingEnd end);

  // Whether it has all appended ticks, and where it is: at PATH once finished, else at PATH.partial; empty: it was removed.
  bool is_whole() const { return is_whole_; }
  const std::string& place() const { return place_; }
  // What went wrong, in one line for the user; empty: nothing.
  const std::string& last_error() const { return last_error_; }
  // Only the reason, as "No space left on device".
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
  std::optional<RecordingEnd> end;  // absent: the process ended before the end was written
  std::string note;                 // one line, if the file holds less than it says, or is not finished; empty: it is whole
};

// Reads a recording. Values come back to the bit; a vessel that the recording does not have is as in a new Tick. Throws Error (usage), one line with
// the file: it cannot be read, is not a recording, lacks something, or holds an impossible value.
Recording read_recording(const std::string& path);

// The scene of a recording, as its session had it: parses the recorded text, and replaces the hand by the virtual person's, if one made the
// recording. Throws Error (usage) as parse_scene does. Meshes are not loaded.
Scene scene_of_recording(const RecordingInfo& info);

// Gives a scene the hand of a virtual person, drawn by the scene's own [people].
void take_hand_of(Scene& scene, std::uint64_t seed, std::uint64_t person);

}  // namespace wholehand::device
