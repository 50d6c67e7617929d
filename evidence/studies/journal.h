// SPDX-License-Identifier: MIT
// The done part of a study: a file that grows by a line with each person, so that an interrupted study resumes where it ended.
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

// Numbers are kept to the bit.
class StudyJournal {
 public:
  // Begins anew, or goes on where `resumes` and the file is there. Throws Error: (usage) the journal is of another study, and in
  // what; (failure) it cannot be read or written, or its head is damaged.
  StudyJournal(const std::string& path, const StudyIdentity& identity, bool resumes);

  // What a person's part of an experiment gave; null: it is not done.
  const std::vector<double>* find(const std::string& experiment, std::uint64_t person) const;
  std::size_t done() const { return done_.size(); }
  // How many of people 0, 1, .. below `people` are done.
  std::size_t people_done(const std::string& experiment, std::uint64_t people) const;
  // How many parts were there that people 0, 1, .. of these experiments do not need.
  std::size_t done_beside(std::uint64_t forces, std::uint64_t sessions, std::uint64_t advice) const;
  // Lines that are not as they were written. Their people are done again.
  std::size_t damaged() const { return damaged_; }

  // Adds a line. Thread-safe. Throws Error (failure) where it cannot be written.
  void add(const std::string& experiment, std::uint64_t person, std::span<const double> numbers);

 private:
  std::map<std::pair<std::string, std::uint64_t>, std::vector<double>> done_;
  std::size_t damaged_ = 0;
  std::optional<LineJournal> lines_;
};

// How many parts a journal has; 0 where it is not there, or is none.
std::size_t parts_in_journal(const std::string& path);

}  // namespace wholehand
