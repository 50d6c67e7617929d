// SPDX-License-Identifier: MIT
// The progress of a sweep, kept beside its partial result file, so that an interrupted sweep can resume.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/checksum.h"
#include "core/backend.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/result/run_layout.h"

namespace wholehand::sweeps {

// The plausible grip nearest to holding: the least worst effort, then the least friction needed, then the first grip.
struct LeastBad {
  static constexpr double ENDLESS = std::numeric_limits<double>::infinity();

  double effort = ENDLESS, friction = ENDLESS;  // also infinite if unknown
  std::uint64_t grip = std::numeric_limits<std::uint64_t>::max();

  auto operator<=>(const LeastBad&) const = default;
  bool is_known() const { return grip != LeastBad().grip; }
};

// Counts over the grips of one vessel.
struct GripCounts {
  std::uint64_t grips = 0;
  std::array<std::uint64_t, 7> by_reason{};  // by_reason[0]: feasible
  std::uint64_t implausible = 0;             // of the feasible
  std::uint64_t antipodal = 0;
  std::uint64_t blocked = 0;  // with a blocked finger
  // Parts of the implausible: a grip through the table may also have overlapping fingers or be beyond the wrist, and then counts twice. All 0 if they
  // were not distinguished.
  std::uint64_t through_table = 0, self_overlap = 0, beyond_wrist = 0;
  std::uint64_t only_deep = 0;  // deep in the vessel, and none of the three
  std::uint64_t not_held = 0;   // of the plausible
  std::uint64_t unjudged = 0;   // of the plausible: efforts not needed for the lists (RunRequest::least_score)
  std::uint64_t at_gate = 0;    // of the plausible: their worst effort is within the tolerances of `check` of 1 (core/tolerances.h)
  LeastBad least_bad;           // unknown if worst efforts are not kept

  std::uint64_t plausible() const { return by_reason[0] - implausible; }
  bool none_holds() const { return not_held > 0 && not_held == plausible(); }
  GripCounts& operator+=(const GripCounts& other);
};

// Grips [first, last) of a vessel, and the checksum of all that the result file holds of them (base/files/checksum.h).
struct Stretch {
  std::uint64_t first = 0, last = 0;
  std::string checksum;
  std::string shard = {};  // whose shard holds them (sweeps/result/shard.h); empty: the result file itself
};

// What is known of one vessel's first `done` grips.
struct VesselProgress {
  std::uint64_t done = 0;
  std::vector<Stretch> stretches;   // consecutive, from 0 to `done`; none if the file holds nothing of the grips
  std::vector<Candidate> best;      // the best first; if the vessel's lists are chosen in passes, the listed ones
  std::vector<ListProgress> lists;  // after the first pass over its grips, if the lists take several (sweeps/lists/list_chooser.h)
  GripCounts counts;
  std::vector<double> heat_map;  // HeatMap::scores(); empty without one
};

// For a sweep whose grips lie in several files.
struct ShardMark {
  std::string id;         // of all its shards
  RunLayout layout;       // of the grips in all of them
  bool is_ended = false;  // whether only their grips are missing in the result file
};

// The state of a sweep when everything up to it is on the disk. `identity` says what must be the same in the resumed sweep: if it is equal, the
// values are equal bit for bit.
struct SweepMark {
  std::map<std::string, std::string> identity;
  std::vector<VesselProgress> vessels;
  double wall_seconds = 0;  // of all sessions so far
  double kernel_seconds = 0;
  std::vector<FileRange> in_place;  // of the partial file: where the values of grips and of the best grips lie, in its order
  std::string structure;            // checksum_without of all else
  std::optional<ShardMark> shards;
};

// The most that a sweep can have done.
struct MarkBounds {
  std::size_t vessels = 0;
  std::uint64_t grips = 0;  // of a vessel
  std::size_t best = 0;     // grips kept
  std::size_t lists = 0;    // with progress of their own, each of
  std::size_t listed = 0;   // grips at most
  bool has_stretches = true;
  bool has_reasons = true;  // of infeasible grips
};

// Adds a stretch after the others, or in place of the last one if it has grown from it.
void keep_stretch(std::vector<Stretch>& stretches, const Stretch& stretch);

// Replaces the mark's file as a whole, synced, with its own checksum. Throws Error (failure).
void save_mark(const std::string& path, const SweepMark& mark);

// How a mark begins.
inline constexpr std::string_view MARK_START = "wholehand mark ";

inline constexpr const char* BEGIN_AGAIN = "start again without --resume";

// Reads a mark. False if there is none. Throws Error (failure) if it cannot be parsed, or is not as it was written; `remedy` ends its line.
bool load_mark(const std::string& path, SweepMark& mark, const char* remedy = BEGIN_AGAIN);

// Throws Error (failure) if a mark claims what no sweep within these bounds can have done.
void check_progress(const std::string& path, const SweepMark& mark, const MarkBounds& bounds);

// Whether the partial file still has the mark's structure, bit for bit. Nothing else may open it, because HDF5 trusts what it reads.
bool has_structure(const std::string& partial, const SweepMark& mark);

// Throws Error (usage) that names the first difference between the begun sweep and the requested one.
void check_identity(const std::string& partial, const SweepMark& mark, const std::map<std::string, std::string>& identity);

}  // namespace wholehand::sweeps
