// SPDX-License-Identifier: MIT
#include "sweeps/result/grip_lists.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "base/files/csv.h"
#include "base/text/error.h"
#include "core/file_kind.h"
#include "core/meshes/vessel.h"
#include "sweeps/result/heat_map_plot.h"

namespace wholehand::sweeps {
namespace {

constexpr double LARGEST_LIST = 1 << 28;  // bytes: a million rows

std::string list_text(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0)
    throw usage_error(fmt::format("{}: cannot be read: {}{}", path, std::strerror(errno), backslash_note(path)));
  if (!S_ISREG(status.st_mode)) throw usage_error(fmt::format("{}: is not a file; name a list of wholehand rank", path));
  if (static_cast<double>(status.st_size) > LARGEST_LIST)
    throw usage_error(fmt::format("{}: is larger than any list of grips", path));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  return {std::istreambuf_iterator<char>(file), {}};
}

class ListReader {
 public:
  ListReader(const std::string& path, const SweepResult& result, const Scene& scene, const Plan& plan)
      : path_(path), result_(result), scene_(scene), plan_(plan), rows_(parse_csv(list_text(path))) {}

  GripLists read() {
    if (rows_.empty()) throw usage_error(path_ + ": is empty, and not a list of wholehand rank");
    const std::size_t vessel = column("vessel"), rank = column("rank"), score = column("score"), grip = column("grip"),
                      sweep = column("sweep");
    const std::string id = sweep_id(result_.origin());
    GripLists lists(scene_.vessels.size() * plan_.hand_scales());
    for (std::size_t k = 1; k < rows_.size(); ++k) {
      const CsvRow& row = rows_[k];
      if (row.cells.size() != rows_[0].cells.size())
        refuse(row, fmt::format("the row has {} cells and the header has {}", row.cells.size(), rows_[0].cells.size()));
      if (row.cells[sweep] != id) {
        refuse(row, fmt::format("the row is from another sweep ({}) than {} ({}); rank this result again",
                                row.cells[sweep].substr(0, 60), result_.path(), id));
      }
      const auto number = whole(row, grip, plan_.grips() - 1, "grip");
      RankedCandidate ranked{whole(row, rank, MOST_BEST, "rank"), {real(row, score), number}};
      if (ranked.rank == 0) refuse(row, "rank 0; ranks begin with 1");
      put(lists[place_of(row, vessel) * plan_.hand_scales() + plan_.hand_scale_of(number)], ranked, row);
    }
    for (auto& list : lists) std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
    return lists;
  }

 private:
  [[noreturn]] void refuse(const CsvRow& row, const std::string& what) const {
    throw usage_error(fmt::format("{}:{}: {}", path_, row.line, what));
  }

  std::size_t column(const char* name) const {
    const auto& head = rows_[0].cells;
    const auto found = std::find(head.begin(), head.end(), name);
    if (found == head.end())
      throw usage_error(
          fmt::format("{}: is not a list of wholehand rank: it has no column {} (commas must separate the columns)", path_, name));
    return static_cast<std::size_t>(found - head.begin());
  }

  std::uint64_t whole(const CsvRow& row, std::size_t column, std::uint64_t most, const char* what) const {
    const std::string& text = row.cells[column];
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > most)
      refuse(row, fmt::format("{} '{}'; allowed: a whole number up to {}", what, text.substr(0, 60), most));
    return value;
  }

  double real(const CsvRow& row, std::size_t column) const {
    const std::string& text = row.cells[column];
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      refuse(row, fmt::format("score '{}' is not a number", text.substr(0, 60)));
    return value;
  }

  std::size_t place_of(const CsvRow& row, std::size_t column) const {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v)
      if (scene_.vessels[v].name == row.cells[column]) return v;
    refuse(row, fmt::format("the sweep has no vessel '{}'", row.cells[column].substr(0, 60)));
  }

  void put(std::vector<RankedCandidate>& list, const RankedCandidate& ranked, const CsvRow& row) {
    if (!ranks_.insert({&list, ranked.rank}).second) refuse(row, fmt::format("rank {} appears twice", ranked.rank));
    if (!grips_.insert({&list, ranked.candidate.index}).second)
      refuse(row, fmt::format("grip {} appears twice", ranked.candidate.index));
    list.push_back(ranked);
  }

  const std::string& path_;
  const SweepResult& result_;
  const Scene& scene_;
  const Plan& plan_;
  std::vector<CsvRow> rows_;
  std::set<std::pair<const void*, std::size_t>> ranks_;
  std::set<std::pair<const void*, std::uint64_t>> grips_;
};

}  // namespace

std::string sweep_id(const SweepOrigin& origin) {
  const std::string precision = origin.precision == Precision::single ? "float" : "double";
  const std::string device = origin.backend == "core" ? "core" : origin.device;  // the same on any number of threads
  std::string all;
  for (const std::string& part : {origin.scene, origin.mesh_keys, origin.version, origin.backend, device, origin.driver, precision})
    all += fmt::format("{} {}\n", part.size(), part);
  return fmt::format("sweep-{:016x}", XXH3_64bits(all.data(), all.size()));
}

SweepOrigin origin_of(const Scene& scene, const std::string& version, const BackendInfo& info) {
  SweepOrigin origin;
  origin.scene = scene.text;
  origin.version = version;
  origin.backend = info.backend;
  origin.device = info.device;
  origin.driver = info.driver;
  origin.precision = info.precision;
  if (has_meshes(scene)) origin.mesh_keys = mesh_keys(scene);
  return origin;
}

ListOrigin list_origin(const std::string& result, const SweepOrigin& origin) {
  return {result.substr(result.rfind('/') + 1), sweep_id(origin)};
}

std::string list_name(const Scene& scene, const Plan& plan, std::size_t list) {
  const std::size_t scales = plan.hand_scales();
  const std::string& vessel = scene.vessels[list / scales].name;
  return scales == 1 ? vessel : fmt::format("{}, hand scale {:.6g}", vessel, plan.hand_scale(list % scales));
}

std::vector<std::string> list_file_parts(const Scene& scene, const Plan& plan) {
  std::vector<std::string> vessels = file_name_parts(scene);
  const std::size_t scales = plan.hand_scales();
  if (scales == 1) return vessels;
  std::vector<std::string> hands;
  for (std::size_t s = 0; s < scales; ++s) hands.push_back(fmt::format("{:.6g}", plan.hand_scale(s)));
  if (std::set<std::string>(hands.begin(), hands.end()).size() < scales) {
    for (std::size_t s = 0; s < scales; ++s) hands[s] = fmt::format("{}", plan.hand_scale(s));
  }
  std::vector<std::string> parts;
  for (const std::string& vessel : vessels) {
    for (const std::string& hand : hands) parts.push_back(vessel + ".hand" + hand);
  }
  return parts;
}

GripLists lists_of_sweep(const SweepResult& result, const Scene& scene, const Plan& plan) {
  GripLists lists(scene.vessels.size() * plan.hand_scales());
  for (std::size_t list = 0; list < lists.size(); ++list) {
    std::size_t rank = 0;
    for (const Candidate& candidate : result.best(list / plan.hand_scales(), list % plan.hand_scales()))
      lists[list].push_back({++rank, candidate});
  }
  return lists;
}

GripLists read_grip_lists(const std::string& path, const SweepResult& result, const Scene& scene, const Plan& plan) {
  return ListReader(path, result, scene, plan).read();
}

}  // namespace wholehand::sweeps
