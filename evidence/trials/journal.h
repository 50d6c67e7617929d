// SPDX-License-Identifier: MIT
// The finished part of trials: a file that gains a line with each grip, so that interrupted trials can resume.
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

// Stores numbers exactly, to the bit.
class TrialJournal {
 public:
  using Found = std::map<std::size_t, GripFinding>;  // by the number of the grip among those to be tried

  // Starts anew. Throws Error (failure) if the file cannot be written.
  TrialJournal(const std::string& path, const TrialIdentity& identity);
  // Continues: `found` gets the finished grips; altered lines are left out and counted in `damaged`. `counts`: cases of each grip. Throws Error:
  // (usage) the journal is of other trials (the message says what differs); (failure) it cannot be read, or its head is damaged.
  TrialJournal(const std::string& path, const TrialIdentity& identity, const std::vector<std::size_t>& counts, Found& found,
               std::size_t& damaged);

  // Adds a grip; details of its outcomes are UTF-8. Thread-safe. Throws Error (failure) if it cannot be written.
  void add(std::size_t grip, const GripFinding& found);

 private:
  LineJournal lines_;
};

}  // namespace wholehand
