// SPDX-License-Identifier: MIT
// The done part of a long run: a file that grows by a line with each part, so that an interrupted run resumes where it ended.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace wholehand {

// What must be the same for a run to go on: a name, for the message, and its value.
using JournalIdentity = std::map<std::string, std::string>;

// The name in it whose value begins with the version of the program.
inline constexpr const char* JOURNAL_BUILD = "build of the program";

struct JournalKind {
  std::string_view start, format;                // what the first line has: a journal of what, and the version of its lines
  std::string_view begun;                        // "this study was begun"
  const char *remedy_at_begin, *remedy_of_line;  // where the file, or a line of it, cannot be written
  const char* remedy_anew;                       // where the file is of another run: how to begin again
  bool keeps_damaged = false;                    // in the file, where a run goes on
};

// The first line has the kind, the second the identity, each further one a part. From the second on each has a checksum of its own
// (XXH3, 128 bits).
class LineJournal {
 public:
  // Gets a part; false: it is none of this run, and counts as damaged.
  using Take = std::function<bool(const nlohmann::json&)>;

  // Begins anew. Throws Error (failure) where the file cannot be written.
  LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity);
  // Goes on: `take` gets what is done, in the file's order, and lines that are not as they were written are counted in `damaged`.
  // Throws Error: (usage) a version before 0.4 wrote the journal, or it is of another run, and in what; (failure) it cannot be read or written, or
  // its head is
  // damaged.
  LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity, const Take& take,
              std::size_t& damaged);
  ~LineJournal();
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;

  // Adds a part. Thread-safe. Throws Error (failure) where it cannot be written.
  void add(const nlohmann::json& part);

 private:
  LineJournal(const std::string& path, const JournalKind& kind) : path_(path), kind_(kind) {}
  void open();
  void write(const std::string& text);

  std::string path_;
  JournalKind kind_;
  std::mutex mutex_;
  int file_ = -1;
};

}  // namespace wholehand
