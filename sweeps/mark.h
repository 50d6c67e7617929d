// How far a sweep is, kept beside its partial result file, so that an interrupted one goes on where it stood.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/backend.h"

namespace wholehand {

// Counts over the grips of one vessel.
struct GripCounts {
  std::uint64_t grips = 0;
  std::array<std::uint64_t, 7> by_reason{};  // by_reason[0]: feasible
  std::uint64_t implausible = 0;             // of the feasible
  std::uint64_t antipodal = 0;
  std::uint64_t blocked = 0;  // with a blocked finger
};

// What is known of one vessel's first `done` grips.
struct VesselProgress {
  std::uint64_t done = 0;
  std::vector<Candidate> best;  // the best first
  GripCounts counts;
  std::vector<double> heat_map;  // HeatMap::scores(); empty without one
};

// The state of a sweep at a moment when everything up to it is on the disk. `identity` says what must be the same in the sweep that
// goes on: with it equal, the values are equal bit for bit.
struct SweepMark {
  std::map<std::string, std::string> identity;
  std::vector<VesselProgress> vessels;
  double wall_seconds = 0;  // of all sessions so far
  double kernel_seconds = 0;
};

// Replaces the mark's file as a whole, synced. Throws Error (failure).
void save_mark(const std::string& path, const SweepMark& mark);

// Reads a mark. False where there is none. Throws Error (failure) where it cannot be read as one.
bool load_mark(const std::string& path, SweepMark& mark);

// Throws Error (usage) that names the first difference between what was begun and what is asked for.
void check_identity(const std::string& partial, const SweepMark& mark, const std::map<std::string, std::string>& identity);

}  // namespace wholehand
