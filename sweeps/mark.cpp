#include "sweeps/mark.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "sweeps/files.h"

namespace wholehand {
namespace {

using nlohmann::json;

constexpr int FORMAT = 1;

json to_json(const VesselProgress& vessel) {
  json best = json::array();
  for (const Candidate& candidate : vessel.best) best.push_back({candidate.score, candidate.index});
  const GripCounts& counts = vessel.counts;
  return {{"done", vessel.done},
          {"best", best},
          {"grips", counts.grips},
          {"by_reason", counts.by_reason},
          {"implausible", counts.implausible},
          {"antipodal", counts.antipodal},
          {"blocked", counts.blocked},
          {"heat_map", vessel.heat_map}};  // NaN becomes null
}

VesselProgress vessel_from(const json& text) {
  VesselProgress vessel;
  vessel.done = text.at("done");
  for (const json& candidate : text.at("best")) vessel.best.push_back({candidate.at(0), candidate.at(1)});
  GripCounts& counts = vessel.counts;
  counts.grips = text.at("grips");
  counts.by_reason = text.at("by_reason");
  counts.implausible = text.at("implausible");
  counts.antipodal = text.at("antipodal");
  counts.blocked = text.at("blocked");
  for (const json& cell : text.at("heat_map")) {
    vessel.heat_map.push_back(cell.is_null() ? std::numeric_limits<double>::quiet_NaN() : cell.get<double>());
  }
  return vessel;
}

}  // namespace

void save_mark(const std::string& path, const SweepMark& mark) {
  json vessels = json::array();
  for (const VesselProgress& vessel : mark.vessels) vessels.push_back(to_json(vessel));
  const json text{{"format", FORMAT},
                  {"identity", mark.identity},
                  {"wall_seconds", mark.wall_seconds},
                  {"kernel_seconds", mark.kernel_seconds},
                  {"vessels", vessels}};
  // a scene's text may hold any bytes
  write_whole_file(path, text.dump(-1, ' ', false, json::error_handler_t::replace), true);
}

bool load_mark(const std::string& path, SweepMark& mark) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  try {
    const json text = json::parse(file);
    if (text.at("format") != FORMAT) throw std::runtime_error("another format");
    mark.identity = text.at("identity").get<std::map<std::string, std::string>>();
    mark.wall_seconds = text.at("wall_seconds");
    mark.kernel_seconds = text.at("kernel_seconds");
    mark.vessels.clear();
    for (const json& vessel : text.at("vessels")) mark.vessels.push_back(vessel_from(vessel));
  } catch (const std::exception& error) {
    throw failure_error(fmt::format("{}: not a progress mark of this program; start again without --resume", path));
  }
  return true;
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

}  // namespace wholehand
