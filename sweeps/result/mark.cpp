// SPDX-License-Identifier: MIT
#include "sweeps/result/mark.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <system_error>
#include <utility>

#include "base/files/files.h"
#include "base/files/json.h"
#include "base/system/version.h"
#include "base/text/error.h"
#include "base/text/readable.h"

namespace wholehand::sweeps {
namespace {

using nlohmann::json;

constexpr int FORMAT = 8;

Error unusable(const std::string& path, const std::string& why, const char* remedy = BEGIN_AGAIN) {
  return failure_error(fmt::format("{}: {}; {}", path, why, remedy));
}

json to_json(const std::vector<Candidate>& candidates) {
  json all = json::array();
  for (const Candidate& candidate : candidates) all.push_back({candidate.score, candidate.index});
  return all;
}

std::vector<Candidate> candidates_from(const json& text) {
  std::vector<Candidate> all;
  for (const json& candidate : text) all.push_back({candidate.at(0), candidate.at(1)});
  return all;
}

json to_json(const ListProgress& list) {
  const auto decided = list.decided ? std::vector<Candidate>{*list.decided} : std::vector<Candidate>{};
  return {{"chosen", to_json(list.chosen)}, {"decided", to_json(decided)}, {"is_complete", list.is_complete}};
}

ListProgress list_from(const json& text) {
  ListProgress list{candidates_from(text.at("chosen")), {}, text.at("is_complete")};
  for (const Candidate& decided : candidates_from(text.at("decided"))) list.decided = decided;
  return list;
}

json to_json(const VesselProgress& vessel) {
  json lists = json::array();
  for (const ListProgress& list : vessel.lists) lists.push_back(to_json(list));
  const GripCounts& counts = vessel.counts;
  json stretches = json::array();
  for (const Stretch& stretch : vessel.stretches) {
    json& numbers = stretches.emplace_back(json{stretch.first, stretch.last, stretch.checksum});
    if (!stretch.shard.empty()) numbers.push_back(stretch.shard);
  }
  return {{"done", vessel.done},
          {"stretches", stretches},
          {"best", to_json(vessel.best)},
          {"grips", counts.grips},
          {"by_reason", counts.by_reason},
          {"implausible", counts.implausible},
          {"antipodal", counts.antipodal},
          {"blocked", counts.blocked},
          {"through_table", counts.through_table},
          {"self_overlap", counts.self_overlap},
          {"beyond_wrist", counts.beyond_wrist},
          {"only_deep", counts.only_deep},
          {"not_held", counts.not_held},
          {"unjudged", counts.unjudged},
          {"at_gate", counts.at_gate},
          {"least_bad", {counts.least_bad.effort, counts.least_bad.friction, counts.least_bad.grip}},
          {"heat_map", vessel.heat_map},
          {"lists", lists}};  // NaN and infinity become null
}

LeastBad least_bad_from(const json& text) {
  const auto number = [](const json& value) { return value.is_null() ? LeastBad::ENDLESS : value.get<double>(); };
  return {number(text.at(0)), number(text.at(1)), text.at(2)};
}

VesselProgress vessel_from(const json& text) {
  VesselProgress vessel;
  vessel.done = text.at("done");
  for (const json& stretch : text.at("stretches"))
    vessel.stretches.push_back({stretch.at(0), stretch.at(1), stretch.at(2), stretch.size() > 3 ? stretch.at(3) : ""});
  vessel.best = candidates_from(text.at("best"));
  for (const json& list : text.at("lists")) vessel.lists.push_back(list_from(list));
  GripCounts& counts = vessel.counts;
  counts.grips = text.at("grips");
  counts.by_reason = text.at("by_reason");
  counts.implausible = text.at("implausible");
  counts.antipodal = text.at("antipodal");
  counts.blocked = text.at("blocked");
  counts.through_table = text.at("through_table");
  counts.self_overlap = text.at("self_overlap");
  counts.beyond_wrist = text.at("beyond_wrist");
  counts.only_deep = text.at("only_deep");
  counts.not_held = text.at("not_held");
  counts.unjudged = text.at("unjudged");
  counts.at_gate = text.at("at_gate");
  counts.least_bad = least_bad_from(text.at("least_bad"));
  for (const json& cell : text.at("heat_map")) {
    vessel.heat_map.push_back(cell.is_null() ? std::numeric_limits<double>::quiet_NaN() : cell.get<double>());
  }
  return vessel;
}

json to_json(const ShardMark& shards) {
  json blocks = json::array();
  for (const LayoutBlock& block : shards.layout.blocks) blocks.push_back({block.offset, block.planes, block.size});
  const RunLayout& layout = shards.layout;
  json content{{"id", shards.id},  {"is_ended", shards.is_ended}, {"grips", layout.grips}, {"copies", layout.copies},
               {"blocks", blocks}, {"axes", layout.axes}};
  if (layout.height) content["height"] = *layout.height;
  return content;
}

ShardMark shards_from(const json& text) {
  ShardMark shards{text.at("id"), {text.at("grips"), text.at("copies"), {}, {}, text.at("axes")}, text.at("is_ended")};
  for (const json& block : text.at("blocks")) shards.layout.blocks.push_back({block.at(0), block.at(1), block.at(2)});
  if (text.contains("height")) shards.layout.height = text.at("height").get<std::uint64_t>();
  return shards;
}

}  // namespace

GripCounts& GripCounts::operator+=(const GripCounts& other) {
  grips += other.grips;
  for (std::size_t k = 0; k < by_reason.size(); ++k) by_reason[k] += other.by_reason[k];
  implausible += other.implausible;
  antipodal += other.antipodal;
  blocked += other.blocked;
  through_table += other.through_table;
  self_overlap += other.self_overlap;
  beyond_wrist += other.beyond_wrist;
  only_deep += other.only_deep;
  not_held += other.not_held;
  unjudged += other.unjudged;
  at_gate += other.at_gate;
  least_bad = std::min(least_bad, other.least_bad);
  return *this;
}

void keep_stretch(std::vector<Stretch>& stretches, const Stretch& stretch) {
  if (!stretches.empty() && stretches.back().first == stretch.first) {
    stretches.back() = stretch;
  } else {
    stretches.push_back(stretch);
  }
}

void save_mark(const std::string& path, const SweepMark& mark) {
  json vessels = json::array();
  for (const VesselProgress& vessel : mark.vessels) vessels.push_back(to_json(vessel));
  json in_place = json::array();
  for (const FileRange& range : mark.in_place) in_place.push_back({range.offset, range.size});
  json content{{"identity", mark.identity}, {"wall_seconds", mark.wall_seconds}, {"kernel_seconds", mark.kernel_seconds},
               {"in_place", in_place},      {"structure", mark.structure},       {"vessels", vessels}};
  if (mark.shards) content["shards"] = to_json(*mark.shards);
  const std::string text = json_text(content);
  write_whole_file(path, fmt::format("{}{} {}\n{}", MARK_START, FORMAT, checksum_text(text.data(), text.size()), text), true,
                   "make room and go on with --resume, or name another file with -o");
}

bool load_mark(const std::string& path, SweepMark& mark, const char* remedy) {
  std::error_code absent;
  if (!std::filesystem::exists(path, absent)) return false;
  if (!std::filesystem::is_regular_file(path, absent)) throw unusable(path, "not a progress mark of this program", remedy);
  std::ifstream file(path, std::ios::binary);
  std::string start, text;
  std::getline(file, start);
  text.assign(std::istreambuf_iterator<char>(file), {});
  if (!start.starts_with(MARK_START)) throw unusable(path, "not a progress mark of this program", remedy);
  if (!start.starts_with(fmt::format("{}{} ", MARK_START, FORMAT)))
    throw unusable(path, "the progress mark of another version of this program", remedy);
  if (!start.ends_with(" " + checksum_text(text.data(), text.size())))
    throw unusable(path, "is damaged: its checksum is wrong", remedy);
  try {
    const json content = parse_json(text);
    mark.identity = content.at("identity").get<std::map<std::string, std::string>>();
    mark.wall_seconds = content.at("wall_seconds");
    mark.kernel_seconds = content.at("kernel_seconds");
    mark.in_place.clear();
    for (const json& range : content.at("in_place")) mark.in_place.push_back({range.at(0), range.at(1)});
    mark.structure = content.at("structure");
    mark.vessels.clear();
    for (const json& vessel : content.at("vessels")) mark.vessels.push_back(vessel_from(vessel));
    mark.shards.reset();
    if (content.contains("shards")) mark.shards = shards_from(content.at("shards"));
  } catch (const std::exception&) {
    throw unusable(path, "not a progress mark of this program", remedy);
  }
  if (const auto written_by = mark.identity.find("version"); written_by != mark.identity.end())
    check_version(path + ": ", written_by->second, remedy);
  return true;
}

namespace {

// What is wrong with one vessel's progress; empty: nothing.
std::string contradiction(const VesselProgress& vessel, const MarkBounds& bounds) {
  if (vessel.done > bounds.grips)
    return fmt::format("{} are done of {}", counted(vessel.done, "grip"), readable_number(bounds.grips));
  if (vessel.counts.grips != vessel.done)
    return fmt::format("{} are done and {} counted", counted(vessel.done, "grip"), readable_number(vessel.counts.grips));
  const auto& reasons = vessel.counts.by_reason;
  const std::uint64_t reasoned = std::accumulate(reasons.begin(), reasons.end(), std::uint64_t{0});
  if (bounds.has_reasons && reasoned != vessel.done)
    return fmt::format("{} are done and {} sorted", counted(vessel.done, "grip"), readable_number(reasoned));
  const GripCounts& counts = vessel.counts;
  for (const auto& [part, what] : {std::pair{counts.through_table, "through the table"},
                                   {counts.self_overlap, "with fingers in each other"},
                                   {counts.beyond_wrist, "beyond the wrist"},
                                   {counts.only_deep, "only deep"}})
    if (part > counts.implausible) return fmt::format("{} implausible grips and {} {}", counts.implausible, part, what);
  if (counts.implausible > counts.by_reason[0] || std::max(counts.not_held, counts.at_gate) + counts.unjudged > counts.plausible())
    return fmt::format("{} feasible grips, {} implausible, {} not held, {} at the gate and {} not judged", counts.by_reason[0],
                       counts.implausible, counts.not_held, counts.at_gate, counts.unjudged);
  if (counts.least_bad.is_known() && counts.least_bad.grip >= vessel.done)
    return fmt::format("grip {} is nearest to holding of {}", counts.least_bad.grip, vessel.done);
  if (vessel.best.size() > bounds.best) return fmt::format("{} best grips are kept of {}", vessel.best.size(), bounds.best);
  for (const Candidate& candidate : vessel.best) {
    if (candidate.index >= vessel.done)
      return fmt::format("grip {} is one of the best of {}", readable_number(candidate.index), readable_number(vessel.done));
  }
  if (!vessel.lists.empty() && (vessel.lists.size() != bounds.lists || vessel.done < bounds.grips))
    return fmt::format("{} of {} lists are begun at {} grips", vessel.lists.size(), bounds.lists, readable_number(vessel.done));
  for (const ListProgress& list : vessel.lists) {
    if (list.chosen.size() > bounds.listed) return fmt::format("{} grips are chosen of {}", list.chosen.size(), bounds.listed);
    for (const Candidate& candidate : list.chosen)
      if (candidate.index >= vessel.done)
        return fmt::format("grip {} is chosen of {}", readable_number(candidate.index), readable_number(vessel.done));
  }
  std::uint64_t end = 0;
  for (const Stretch& stretch : vessel.stretches) {
    if (stretch.first != end || stretch.last <= stretch.first)
      return fmt::format("a stretch from {} follows {}", readable_number(stretch.first), readable_number(end));
    end = stretch.last;
  }
  if (bounds.has_stretches && end != vessel.done)
    return fmt::format("{} are done and {} have a checksum", counted(vessel.done, "grip"), readable_number(end));
  return "";
}

}  // namespace

void check_progress(const std::string& path, const SweepMark& mark, const MarkBounds& bounds) {
  if (mark.vessels.size() != bounds.vessels)
    throw unusable(path, fmt::format("contradicts itself: {} vessels of {}", mark.vessels.size(), bounds.vessels));
  for (std::size_t v = 0; v < mark.vessels.size(); ++v) {
    const std::string wrong = contradiction(mark.vessels[v], bounds);
    if (!wrong.empty()) throw unusable(path, fmt::format("contradicts itself: of vessel {}, {}", v + 1, wrong));
  }
}

bool has_structure(const std::string& partial, const SweepMark& mark) {
  const int file = open(partial.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return false;
  const std::optional<std::string> structure = checksum_without(file, mark.in_place);
  close(file);
  return structure == mark.structure;
}

void check_identity(const std::string& partial, const SweepMark& mark, const std::map<std::string, std::string>& identity) {
  for (const auto& [key, now] : identity) {
    const auto before = mark.identity.find(key);
    if (before != mark.identity.end() && before->second == now) continue;
    const bool fits_a_line = before != mark.identity.end() && (now + before->second).size() < 200 &&
                             (now + before->second).find('\n') == std::string::npos;
    const std::string both = fits_a_line ? fmt::format(" (\"{}\", now \"{}\")", before->second, now) : "";
    throw usage_error(fmt::format("--resume: {} was begun with another {}{}; ask for the same, or start again without --resume",
                                  partial, key, both));
  }
}

}  // namespace wholehand::sweeps
