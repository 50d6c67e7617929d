// SPDX-License-Identifier: MIT
#include "sweeps/run_times.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "system/checksum.h"
#include "system/files.h"
#include "system/json.h"

namespace wholehand {
namespace {

// The file: this with the checksum of the rest, then JSON.
constexpr std::string_view START = "wholehand run times 1 ";
constexpr std::uintmax_t LARGEST = 1 << 20;  // bytes; more is not ours

nlohmann::json to_json(const RunTime& run) {
  return {run.machine, run.kind, run.device, run.number, run.grips, run.fixed, run.growing};
}

RunTime from_json(const nlohmann::json& row) {
  RunTime run;
  row.at(0).get_to(run.machine);
  row.at(1).get_to(run.kind);
  row.at(2).get_to(run.device);
  row.at(3).get_to(run.number);
  row.at(4).get_to(run.grips);
  row.at(5).get_to(run.fixed);
  row.at(6).get_to(run.growing);
  const bool is_time = std::isfinite(run.fixed) && run.fixed >= 0 && std::isfinite(run.growing) && run.growing >= 0;
  if (!is_time || run.grips == 0) throw std::out_of_range("no time of a run");
  return run;
}

std::string whole_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string run_times_file(const std::string& folder) { return folder + "/run-times"; }

std::vector<RunTime> read_run_times(const std::string& file, std::string& why) try {
  namespace fs = std::filesystem;
  std::error_code absent;
  if (!fs::exists(file, absent)) return {};
  if (!fs::is_regular_file(file, absent) || fs::file_size(file) > LARGEST) {  // a pipe would be waited for
    why = "it is none of this program's files";
    return {};
  }
  const std::string text = whole_text(file);
  const std::size_t end = text.find('\n');
  const std::string body = end == text.npos ? "" : text.substr(end + 1);
  if (text.substr(0, end) != std::string(START) + checksum_text(body.data(), body.size())) {
    why = "it is damaged, or of another version";
    return {};
  }
  std::vector<RunTime> history;
  for (const nlohmann::json& row : parse_json(body)) history.push_back(from_json(row));
  return history;
} catch (const std::exception&) {
  why = "it is damaged, or of another version";
  return {};
}

bool write_run_times(const std::string& file, const std::vector<RunTime>& history) noexcept try {
  nlohmann::json rows = nlohmann::json::array();
  for (const RunTime& run : history) rows.push_back(to_json(run));
  const std::string body = json_text(rows) + "\n";
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  write_whole_file(file, std::string(START) + checksum_text(body.data(), body.size()) + "\n" + body, false);
  return true;
} catch (const std::exception&) {
  return false;
}

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace wholehand
