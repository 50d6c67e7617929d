// SPDX-License-Identifier: MIT
// The done part of trials: a file that grows by a line with each grip, so that interrupted trials resume where they ended.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/line_journal.h"
#include "evidence/trials/tried.h"

namespace wholehand {

// How a journal begins.
inline constexpr std::string_view JOURNAL_START = "wholehand trials journal ";

using TrialIdentity = JournalIdentity;
// One checksum of it.
std::string identity_text(const TrialIdentity& identity);

// Numbers are kept to the bit.
class TrialJournal {
 public:
  using Found = std::map<std::size_t, GripFinding>;  // by the number of the grip among those to be tried

  // Begins anew. Throws Error (failure) where the file cannot be written.
  TrialJournal(const std::string& path, const TrialIdentity& identity);
  // Goes on: `found` gets what is done, and lines that are not as they were written are left out and counted in `damaged`.
  // `counts`: cases of each grip. Throws Error: (usage) the journal is of other trials, and in what; (failure) it cannot be read,
  // or its head is damaged.
  TrialJournal(const std::string& path, const TrialIdentity& identity, const std::vector<std::size_t>& counts, Found& found,
               std::size_t& damaged);

  // Adds a grip; details of its outcomes are UTF-8. Thread-safe. Throws Error (failure) where it cannot be written.
  void add(std::size_t grip, const GripFinding& found);

 private:
  LineJournal lines_;
};

}  // namespace wholehand
