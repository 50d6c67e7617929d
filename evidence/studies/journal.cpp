// SPDX-License-Identifier: MIT
#include "evidence/studies/journal.h"

#include <bit>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "evidence/studies/output.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

constexpr JournalKind STUDY_JOURNAL{
    STUDY_JOURNAL_START, "1", "this study was begun", STUDY_REMEDY, STUDY_REMEDY, "leave --resume out to begin again", true};

}  // namespace

StudyJournal::StudyJournal(const std::string& path, const StudyIdentity& identity, bool resumes) {
  if (!resumes || !std::filesystem::exists(path)) {
    lines_.emplace(path, STUDY_JOURNAL, identity);
    return;
  }
  const auto take = [this](const Json& part) {
    if (!part.is_object()) return false;
    std::vector<double> numbers;
    for (const Json& bits : part.at("numbers")) numbers.push_back(std::bit_cast<double>(bits.get<std::uint64_t>()));
    done_[{part.at("experiment").get<std::string>(), part.at("person").get<std::uint64_t>()}] = std::move(numbers);
    return true;
  };
  lines_.emplace(path, STUDY_JOURNAL, identity, take, damaged_);
}

const std::vector<double>* StudyJournal::find(const std::string& experiment, std::uint64_t person) const {
  const auto found = done_.find({experiment, person});
  return found == done_.end() ? nullptr : &found->second;
}

std::size_t StudyJournal::people_done(const std::string& experiment, std::uint64_t people) const {
  std::size_t count = 0;
  for (const auto& [part, numbers] : done_) count += part.first == experiment && part.second < people ? 1 : 0;
  return count;
}

std::size_t StudyJournal::done_beside(std::uint64_t forces, std::uint64_t sessions, std::uint64_t advice) const {
  std::size_t others = 0;
  for (const auto& [part, numbers] : done_) {
    const std::uint64_t asked = part.first == "forces" ? forces : part.first == "advice" ? advice : sessions;
    others += part.second >= asked ? 1 : 0;
  }
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
  lines_->add({{"experiment", experiment}, {"person", person}, {"numbers", bits}});
}

}  // namespace wholehand
