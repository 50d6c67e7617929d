// SPDX-License-Identifier: MIT
#include "studies/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "studies/output.h"
#include "system/checksum.h"
#include "system/file_set.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

constexpr const char* STUDY_JOURNAL_FORMAT = "1";

std::string line_of(const Json& content) {
  const std::string text = content.dump();
  return checksum_text(text.data(), text.size()) + " " + text + "\n";
}

// Nothing where the line is not as it was written.
std::optional<Json> content_of(const std::string& line) {
  const std::size_t space = line.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string text = line.substr(space + 1);
  if (checksum_text(text.data(), text.size()) != line.substr(0, space)) return std::nullopt;
  Json content = Json::parse(text, nullptr, false);
  if (content.is_discarded()) return std::nullopt;
  return content;
}

Error unwritten(const std::string& path) {
  return failure_error(fmt::format("{}: cannot be written: {}; {}", path, std::strerror(errno), STUDY_REMEDY));
}

}  // namespace

StudyJournal::StudyJournal(const std::string& path, const StudyIdentity& identity, bool resumes) : path_(path) {
  if (resumes && std::filesystem::exists(path)) {
    read(identity);
  } else {
    FileSet set;
    set.write(path, fmt::format("{}{}\n{}", STUDY_JOURNAL_START, STUDY_JOURNAL_FORMAT, line_of(Json(identity))), STUDY_REMEDY);
    set.give_names(STUDY_REMEDY);
  }
  file_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) throw unwritten(path);
}

StudyJournal::~StudyJournal() {
  if (file_ >= 0) ::close(file_);
}

void StudyJournal::read(const StudyIdentity& identity) {
  std::ifstream file(path_, std::ios::binary);
  std::string format, head, line;
  std::getline(file, format);
  std::getline(file, head);
  const auto known = content_of(head);
  if (format != std::string(STUDY_JOURNAL_START) + STUDY_JOURNAL_FORMAT || !known || !known->is_object())
    throw failure_error(path_ + ": is damaged, or of another version; leave --resume out to begin again");
  std::string unlike;
  for (const auto& [name, value] : identity)
    if (known->value(name, std::string()) != value) unlike += (unlike.empty() ? "another " : ", another ") + name;
  if (!unlike.empty())
    throw usage_error(
        fmt::format("{}: this study was begun with {}; ask for the same, or leave --resume out to begin again", path_, unlike));
  bool is_cut = false;
  while (std::getline(file, line)) {
    is_cut = file.eof();  // a line without its end is of a run that was killed
    const auto content = content_of(line);
    if (!content || !content->is_object()) {
      ++damaged_;
      continue;
    }
    std::vector<double> numbers;
    for (const Json& bits : content->at("numbers")) numbers.push_back(std::bit_cast<double>(bits.get<std::uint64_t>()));
    done_[{content->at("experiment").get<std::string>(), content->at("person").get<std::uint64_t>()}] = std::move(numbers);
  }
  if (!is_cut) return;
  // what is added next begins a line of its own
  std::ofstream end(path_, std::ios::binary | std::ios::app);
  if (!(end << '\n').flush()) throw unwritten(path_);
}

const std::vector<double>* StudyJournal::find(const std::string& experiment, std::uint64_t person) const {
  const auto found = done_.find({experiment, person});
  return found == done_.end() ? nullptr : &found->second;
}

std::size_t StudyJournal::done_of(const std::string& experiment, std::uint64_t people) const {
  std::size_t count = 0;
  for (const auto& [part, numbers] : done_) count += part.first == experiment && part.second < people ? 1 : 0;
  return count;
}

std::size_t StudyJournal::done_beside(std::uint64_t forces, std::uint64_t sessions) const {
  std::size_t others = 0;
  for (const auto& [part, numbers] : done_) others += part.second >= (part.first == "forces" ? forces : sessions) ? 1 : 0;
  return others;
}

std::size_t parts_in_journal(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t lines = 0;
  while (std::getline(file, line)) ++lines;
  constexpr std::size_t HEAD = 2;
  return lines > HEAD ? lines - HEAD : 0;
}

void StudyJournal::add(const std::string& experiment, std::uint64_t person, std::span<const double> numbers) {
  Json bits = Json::array();
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  const std::string line = line_of({{"experiment", experiment}, {"person", person}, {"numbers", bits}});
  const std::lock_guard lock(mutex_);
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t size = ::write(file_, line.data() + written, line.size() - written);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) throw unwritten(path_);
    written += static_cast<std::size_t>(size);
  }
}

}  // namespace wholehand
