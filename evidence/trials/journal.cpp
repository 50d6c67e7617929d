// SPDX-License-Identifier: MIT
#include "evidence/trials/journal.h"

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/files/checksum.h"
#include "base/files/json.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

constexpr JournalKind TRIAL_JOURNAL{JOURNAL_START,
                                    "4",
                                    "these trials were begun",
                                    "make room, or name another folder",
                                    "make room, then go on with --resume",
                                    "leave --resume out to begin again"};

// Exactly, NaN and infinity too.
std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }
double number_at(const Json& array, std::size_t k) { return std::bit_cast<double>(array.at(k).get<std::uint64_t>()); }

Json prediction_json(const GripPrediction& said) {
  Json numbers = Json::array();
  for (const double value : {said.worst_effort, said.tips_worst_effort, said.scene_worst_effort, said.push, said.friction_needed,
                             said.epsilon, said.score})
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
                        &said.epsilon, &said.score})
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

Json placements_json(const std::vector<Placement>& placements) {
  Json content = Json::array();
  for (const Placement& one : placements) content.push_back({one.is_possible, one.held, static_cast<int>(one.reason)});
  return content;
}

std::vector<Placement> placements_of(const Json& content) {
  std::vector<Placement> placements;
  for (const Json& one : content)
    placements.push_back({one.at(0).get<bool>(), one.at(1).get<bool>(), static_cast<TrialReason>(one.at(2).get<int>())});
  return placements;
}

// A line with a correct checksum was written here; if it does not fit, it has another number of grips or cases than requested.
std::optional<std::pair<std::size_t, GripFinding>> finding_of(const Json& content, const std::vector<std::size_t>& counts) {
  try {
    const auto grip = content.at("grip").get<std::size_t>();
    const Json& outcomes = content.at("outcomes");
    if (grip >= counts.size() || outcomes.size() != counts[grip]) return std::nullopt;
    GripFinding found;
    found.prediction = prediction_of(content.at("said"), counts[grip]);
    for (const Json& one : outcomes) found.outcomes.push_back(outcome_of(one));
    found.placements = placements_of(content.at("placements"));
    const Json& robust = content.at("robust");
    found.robust = {number_at(robust, 0), number_at(robust, 1), number_at(robust, 2)};
    return std::pair(grip, found);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::string identity_text(const TrialIdentity& identity) {
  const std::string text = json_text(Json(identity));
  return checksum_text(text.data(), text.size());
}

TrialJournal::TrialJournal(const std::string& path, const TrialIdentity& identity) : lines_(path, TRIAL_JOURNAL, identity) {}

TrialJournal::TrialJournal(const std::string& path, const TrialIdentity& identity, const std::vector<std::size_t>& counts,
                           Found& found, std::size_t& damaged)
    : lines_(
          path, TRIAL_JOURNAL, identity,
          [&](const Json& part) {
            const auto one = finding_of(part, counts);
            if (one) found.insert_or_assign(one->first, one->second);
            return one.has_value();
          },
          damaged) {}

void TrialJournal::add(std::size_t grip, const GripFinding& found) {
  Json outcomes = Json::array();
  for (const TrialOutcome& outcome : found.outcomes) outcomes.push_back(outcome_json(outcome));
  const sweeps::RobustScore& robust = found.robust;
  lines_.add({{"grip", grip},
              {"said", prediction_json(found.prediction)},
              {"outcomes", outcomes},
              {"placements", placements_json(found.placements)},
              {"robust", {bits_of(robust.mean), bits_of(robust.low), bits_of(robust.share)}}});
}

}  // namespace wholehand
