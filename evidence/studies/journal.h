// SPDX-License-Identifier: MIT
// The finished part of a study: a file that gains a line with each person, so that an interrupted study can resume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/files/line_journal.h"

namespace wholehand {

using StudyIdentity = JournalIdentity;

// Stores numbers exactly, to the bit.
class StudyJournal {
 public:
  // Starts anew, or continues if `resumes` and the file exists. Throws Error: (usage) the journal is another study's (the message says what differs);
  // (failure) it cannot be read or written, or its head is damaged.
  StudyJournal(const std::string& path, const StudyIdentity& identity, bool resumes);

  // The results of a person's part of an experiment; null: it is not done.
  const std::vector<double>* find(const std::string& experiment, std::uint64_t person) const;
  std::size_t done() const { return done_.size(); }
  // How many of people 0, 1, .. below `people` are done.
  std::size_t people_done(const std::string& experiment, std::uint64_t people) const;
  // How many stored parts people 0, 1, .. of these experiments do not need.
  std::size_t done_beside(std::uint64_t forces, std::uint64_t sessions, std::uint64_t advice) const;
  // Number of altered lines. Their people are computed again.
  std::size_t damaged() const { return damaged_; }

  // Adds a line. Thread-safe. Throws Error (failure) if it cannot be written.
  void add(const std::string& experiment, std::uint64_t person, std::span<const double> numbers);

 private:
  std::map<std::pair<std::string, std::uint64_t>, std::vector<double>> done_;
  std::size_t damaged_ = 0;
  std::optional<LineJournal> lines_;
};

// How many parts a journal has; 0 if it does not exist, or is not a journal.
std::size_t parts_in_journal(const std::string& path);

}  // namespace wholehand
