// SPDX-License-Identifier: MIT
// The finished part of a long run: a file that gains a line with each part, so that an interrupted run can resume.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace wholehand {

// What must match for a run to resume: a name, for the message, and a value.
using JournalIdentity = std::map<std::string, std::string>;

// The name whose value begins with the program's version.
inline constexpr const char* JOURNAL_BUILD = "build of the program";

struct JournalKind {
  std::string_view start, format;                // first line: the kind of journal and its format version
  std::string_view begun;                        // "this study was begun"
  const char *remedy_at_begin, *remedy_of_line;  // message if the file or a line cannot be written
  const char* remedy_anew;                       // message if the file is another run's: how to start again
  bool keeps_damaged = false;                    // damaged lines stay in the file when a run resumes
};

// The first line has the kind, the second the identity, each further line a part. Each line from the second on has its own checksum (XXH3, 128 bits).
class LineJournal {
 public:
  // Receives a part. Returns false if the part is not this run's; it then counts as damaged.
  using Take = std::function<bool(const nlohmann::json&)>;

  // Starts a new journal. Throws Error (failure) if the file cannot be written.
  LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity);
  // Resumes: passes the finished parts to `take` in file order, and counts altered lines in `damaged`. Throws Error: (usage) a version before 0.4
  // wrote the journal, or it is another run's (the message says what differs); (failure) it cannot be read or written, or its head is damaged.
  LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity, const Take& take,
              std::size_t& damaged);
  ~LineJournal();
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;

  // Adds a part. Thread-safe. Throws Error (failure) if it cannot be written.
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
