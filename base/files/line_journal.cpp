// SPDX-License-Identifier: MIT
#include "base/files/line_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/files/checksum.h"
#include "base/files/file_set.h"
#include "base/files/json.h"
#include "base/system/version.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

std::string json_line(const Json& content) {
  const std::string text = json_text(content);
  return checksum_text(text.data(), text.size()) + " " + text + "\n";
}

// Nothing if the line was altered.
std::optional<Json> content_of(const std::string& line) {
  const std::size_t space = line.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string text = line.substr(space + 1);
  if (checksum_text(text.data(), text.size()) != line.substr(0, space)) return std::nullopt;
  Json content = try_json(text);
  if (content.is_discarded()) return std::nullopt;
  return content;
}

std::string head_of(const JournalKind& kind, const JournalIdentity& identity) {
  return fmt::format("{}{}\n{}", kind.start, kind.format, json_line(Json(identity)));
}

// Unlike write_whole_file, uses a fixed name, so that the next process finds what a killed one left.
void write_whole(const std::string& path, const std::string& text, const char* remedy) {
  FileSet set;
  set.write(path, text, remedy);
  set.commit(remedy);
}

Error unwritten(const std::string& path, const char* remedy) {
  return failure_error(fmt::format("{}: cannot be written: {}; {}", path, std::strerror(errno), remedy));
}

// Reads the first two lines.
void check_head(std::ifstream& file, const std::string& path, const JournalKind& kind, const JournalIdentity& identity) {
  std::string format, head;
  std::getline(file, format);
  std::getline(file, head);
  const auto known = content_of(head);
  if (known && known->is_object()) check_version(path + ": ", known->value(JOURNAL_BUILD, std::string()), kind.remedy_anew);
  if (format != fmt::format("{}{}", kind.start, kind.format) || !known || !known->is_object())
    throw failure_error(fmt::format("{}: is damaged, or of another version; {}", path, kind.remedy_anew));
  std::string unlike;
  for (const auto& [name, value] : identity)
    if (known->value(name, std::string()) != value) unlike += (unlike.empty() ? "another " : ", another ") + name;
  if (!unlike.empty())
    throw usage_error(fmt::format("{}: {} with {}; ask for the same, or {}", path, kind.begun, unlike, kind.remedy_anew));
}

}  // namespace

LineJournal::LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity)
    : LineJournal(path, kind) {
  write_whole(path, head_of(kind, identity), kind.remedy_at_begin);
  open();
}

LineJournal::LineJournal(const std::string& path, const JournalKind& kind, const JournalIdentity& identity, const Take& take,
                         std::size_t& damaged)
    : LineJournal(path, kind) {
  std::ifstream file(path, std::ios::binary);
  check_head(file, path, kind, identity);
  damaged = 0;
  bool is_cut = false;
  std::string line, whole = head_of(kind, identity);
  while (std::getline(file, line)) {
    is_cut = file.eof();  // a line without its end comes from a killed run
    const auto part = content_of(line);
    if (!part || !take(*part))
      ++damaged;
    else if (!kind.keeps_damaged)
      whole += line + "\n";
  }
  file.close();
  if (!kind.keeps_damaged) write_whole(path, whole, kind.remedy_at_begin);
  open();
  if (kind.keeps_damaged && is_cut) write("\n");  // the next addition begins its own line
}

LineJournal::~LineJournal() {
  if (file_ >= 0) ::close(file_);
}

void LineJournal::open() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) throw unwritten(path_, kind_.remedy_at_begin);
}

void LineJournal::add(const Json& part) { write(json_line(part)); }

void LineJournal::write(const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw unwritten(path_, kind_.remedy_of_line);
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace wholehand
