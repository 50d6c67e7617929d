// SPDX-License-Identifier: MIT
#include "trials/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "system/checksum.h"
#include "system/file_set.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

constexpr const char* JOURNAL_FORMAT = "2";

// Exactly, NaN and infinity too.
std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }
double number_at(const Json& array, std::size_t k) { return std::bit_cast<double>(array.at(k).get<std::uint64_t>()); }

std::string journal_line(const Json& content) {
  const std::string text = content.dump();
  return checksum_text(text.data(), text.size()) + " " + text + "\n";
}

// The content of a line; nothing where it is not as it was written.
std::optional<Json> content_of(const std::string& line) {
  const std::size_t space = line.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string text = line.substr(space + 1);
  if (checksum_text(text.data(), text.size()) != line.substr(0, space)) return std::nullopt;
  Json content = Json::parse(text, nullptr, false);
  if (content.is_discarded()) return std::nullopt;
  return content;
}

Json prediction_json(const GripPrediction& said) {
  Json numbers = Json::array();
  for (const double value : {said.worst_effort, said.tips_worst_effort, said.scene_worst_effort, said.push, said.friction_needed,
                             said.epsilon, said.score, said.score_0_1})
    numbers.push_back(bits_of(value));
  for (const double term : said.terms) numbers.push_back(bits_of(term));
  for (const CasePrediction& one : said.cases) {
    for (const double value : {one.effort, one.tips, one.leg_effort, one.leg_tips}) numbers.push_back(bits_of(value));
  }
  return numbers;
}

GripPrediction prediction_of(const Json& numbers, std::size_t cases) {
  GripPrediction said;
  std::size_t next = 0;
  for (double* value : {&said.worst_effort, &said.tips_worst_effort, &said.scene_worst_effort, &said.push, &said.friction_needed,
                        &said.epsilon, &said.score, &said.score_0_1})
    *value = number_at(numbers, next++);
  for (double& term : said.terms) term = number_at(numbers, next++);
  said.cases.resize(cases);
  for (CasePrediction& one : said.cases)
    for (double* value : {&one.effort, &one.tips, &one.leg_effort, &one.leg_tips}) *value = number_at(numbers, next++);
  return said;
}

Json outcome_json(const TrialOutcome& outcome) {
  return {outcome.held,          outcome.discarded,     static_cast<int>(outcome.reason),
          outcome.detail,        bits_of(outcome.slip), bits_of(outcome.move),
          bits_of(outcome.turn), bits_of(outcome.when), bits_of(outcome.tilt_lost)};
}

TrialOutcome outcome_of(const Json& content) {
  TrialOutcome outcome;
  outcome.held = content.at(0).get<bool>();
  outcome.discarded = content.at(1).get<bool>();
  outcome.reason = static_cast<TrialReason>(content.at(2).get<int>());
  outcome.detail = content.at(3).get<std::string>();
  std::size_t next = 4;
  for (double* value : {&outcome.slip, &outcome.move, &outcome.turn, &outcome.when, &outcome.tilt_lost})
    *value = number_at(content, next++);
  return outcome;
}

// A line whose checksum is right was written here: what does not fit it is of a number of grips or cases that is not asked for.
std::optional<std::pair<std::size_t, GripFinding>> finding_of(const std::string& line, const std::vector<std::size_t>& counts) {
  const auto content = content_of(line);
  if (!content) return std::nullopt;
  try {
    const auto grip = content->at("grip").get<std::size_t>();
    const Json& outcomes = content->at("outcomes");
    if (grip >= counts.size() || outcomes.size() != counts[grip]) return std::nullopt;
    GripFinding found;
    found.prediction = prediction_of(content->at("said"), counts[grip]);
    for (const Json& one : outcomes) found.outcomes.push_back(outcome_of(one));
    return std::pair(grip, found);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string head_text(const TrialIdentity& identity) {
  return fmt::format("{}{}\n{}", JOURNAL_START, JOURNAL_FORMAT, journal_line(identity));
}

// Not as write_whole_file does: what is left of a process that was killed has a name that the next one knows.
void write_journal(const std::string& path, const std::string& text) {
  constexpr const char* REMEDY = "make room, or name another folder";
  FileSet set;
  set.write(path, text, REMEDY);
  set.give_names(REMEDY);
}

}  // namespace

std::string identity_text(const TrialIdentity& identity) {
  const std::string text = Json(identity).dump();
  return checksum_text(text.data(), text.size());
}

TrialJournal::TrialJournal(const std::string& path, const TrialIdentity& identity) : path_(path) {
  write_journal(path, head_text(identity));
  open();
}

TrialJournal::TrialJournal(const std::string& path, const TrialIdentity& identity, const std::vector<std::size_t>& counts,
                           Found& found, std::size_t& damaged)
    : path_(path) {
  std::ifstream file(path, std::ios::binary);
  std::string format, head, line, whole = head_text(identity);
  std::getline(file, format);
  std::getline(file, head);
  const auto known = content_of(head);
  if (format != std::string(JOURNAL_START) + JOURNAL_FORMAT || !known || !known->is_object())
    throw failure_error(path + ": is damaged, or of another version; leave --resume out to begin again");
  std::string unlike;
  for (const auto& [name, value] : identity)
    if (known->value(name, std::string()) != value) unlike += (unlike.empty() ? "another " : ", another ") + name;
  if (!unlike.empty())
    throw usage_error(
        fmt::format("{}: these trials were begun with {}; ask for the same, or leave --resume out to begin again", path, unlike));
  damaged = 0;
  while (std::getline(file, line)) {
    const auto one = finding_of(line, counts);
    damaged += one ? 0 : 1;
    if (!one) continue;
    found.insert_or_assign(one->first, one->second);
    whole += line + "\n";
  }
  file.close();
  write_journal(path, whole);  // the last line may lack its end
  open();
}

TrialJournal::~TrialJournal() {
  if (file_ >= 0) close(file_);
}

void TrialJournal::open() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) throw failure_error(fmt::format("{}: cannot be written: {}; name another folder", path_, std::strerror(errno)));
}

void TrialJournal::add(std::size_t grip, const GripFinding& found) {
  Json outcomes = Json::array();
  for (const TrialOutcome& outcome : found.outcomes) outcomes.push_back(outcome_json(outcome));
  write(journal_line({{"grip", grip}, {"said", prediction_json(found.prediction)}, {"outcomes", outcomes}}));
}

void TrialJournal::write(const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      throw failure_error(
          fmt::format("{}: cannot be written: {}; make room, then go on with --resume", path_, std::strerror(errno)));
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace wholehand
