// SPDX-License-Identifier: MIT
#include "evidence/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "base/charts/html.h"
#include "base/system/version.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/planes.h"
#include "evidence/report/page.h"
#include "evidence/report/source.h"
#include "sweeps/plan/rules.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand {
namespace {

constexpr std::size_t GRIPS_AT_ONCE = 1 << 16;
constexpr std::size_t MOST_CHANGES = 20, FIRST_GRIPS = 10, LONGEST_LINE = 120;
constexpr double SAME_PLACE = 1e-9;  // m, rad or 1

// A result in use with its scene. It has a list for each vessel and hand scale.
struct Side {
  Side(const char* letter, sweeps::SweepResult& opened, const Scene& given)
      : name(letter), result(opened), scene(with_heights(opened, given)), plan(scene, sweeps::keeps_vectors(opened.variables())) {
    result.use(scene, plan);
    lists = sweeps::lists_of_sweep(result, scene, plan);
  }
  static Scene with_heights(const sweeps::SweepResult& result, Scene scene) {
    sweeps::set_heights(result, scene);
    return scene;
  }
  double value(const char* name, std::size_t vessel, std::uint64_t grip) const {
    const sweeps::Variable* variable = result.find(name);
    return variable ? result.pick(*variable, vessel, 0, {grip})[0] : std::nan("");
  }

  const char* name;  // "A" or "B"
  sweeps::SweepResult& result;
  Scene scene;
  sweeps::Plan plan;
  sweeps::GripLists lists;
};

struct ListedGrip {
  std::size_t rank = 1;
  Candidate candidate;
  GripInput grip;
  double robust = std::numeric_limits<double>::quiet_NaN();  // the 10th percentile by which it is ranked
};

// The compared numbers of a vessel, and their decimals.
enum : std::size_t { GRIPS, FEASIBLE, PLAUSIBLE, NOT_HELD, BEST_SCORE, LEAST_EFFORT, FIRST_EFFORT };
constexpr std::array<std::pair<const char*, int>, 7> SUM_ROWS{{{"grips", 0},
                                                               {"feasible", 0},
                                                               {"plausible", 0},
                                                               {"not held", 0},
                                                               {"best score", 3},
                                                               {"least worst effort", 3},
                                                               {"worst effort of the first grip", 3}}};

struct VesselSums {
  std::array<double, SUM_ROWS.size()> sums{};    // NaN: the file does not have it
  std::vector<ListedGrip> listed;                // of all hand scales, by rank
  std::multimap<double, std::size_t> by_height;  // places in `listed`
};

VesselSums sums_of(const Side& side, std::size_t vessel) {
  const std::array<const char*, 5> names{"reason", "plausible", "not_held", "score", "worst_effort"};
  std::array<const sweeps::Variable*, 5> variables{};
  for (std::size_t k = 0; k < names.size(); ++k) variables[k] = side.result.find(names[k]);
  const auto start = [&](std::size_t k) { return variables[k] ? 0 : std::nan(""); };
  const double none = std::nan("");
  VesselSums vessel_sums{{static_cast<double>(side.plan.grips()), start(0), start(1), start(2), none, none, none}, {}, {}};
  auto& sums = vessel_sums.sums;
  std::array<std::vector<double>, 5> values;
  for (std::uint64_t first = 0; first < side.plan.grips(); first += GRIPS_AT_ONCE) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(GRIPS_AT_ONCE, side.plan.grips() - first));
    for (std::size_t k = 0; k < names.size(); ++k) {
      values[k].assign(count, none);
      if (variables[k]) side.result.read(*variables[k], vessel, 0, first, count, values[k].data());
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_plausible = values[1][i] == 1, is_not_held = values[2][i] == 1;
      sums[FEASIBLE] += values[0][i] == 0 ? 1 : 0;
      sums[PLAUSIBLE] += is_plausible ? 1 : 0;
      sums[NOT_HELD] += is_not_held ? 1 : 0;
      if (is_plausible) sums[BEST_SCORE] = std::fmax(sums[BEST_SCORE], values[3][i]);
      if (is_plausible || is_not_held) sums[LEAST_EFFORT] = std::fmin(sums[LEAST_EFFORT], values[4][i]);
    }
  }
  auto& listed = vessel_sums.listed;
  const std::size_t scales = side.plan.hand_scales();
  for (std::size_t list = vessel * scales; list < (vessel + 1) * scales; ++list) {
    const std::vector<sweeps::RobustScore> robust = side.result.robust(vessel, list % scales);
    for (const sweeps::RankedCandidate& ranked : side.lists[list]) {
      listed.push_back({ranked.rank, ranked.candidate, side.plan.grip(vessel, ranked.candidate.index)});
      if (ranked.rank <= robust.size()) listed.back().robust = robust[ranked.rank - 1].low;
    }
  }
  std::stable_sort(listed.begin(), listed.end(), [](const auto& x, const auto& y) { return x.rank < y.rank; });
  for (std::size_t k = 0; k < listed.size(); ++k) {
    sums[BEST_SCORE] = std::fmax(sums[BEST_SCORE], listed[k].candidate.score);
    vessel_sums.by_height.emplace(listed[k].grip.height, k);
  }
  if (!listed.empty()) sums[FIRST_EFFORT] = side.value("worst_effort", vessel, listed[0].candidate.index);
  return vessel_sums;
}

bool is_same_place(const GripInput& a, const GripInput& b) {
  const std::array<double, 6> differences{a.height - b.height, a.azimuth - b.azimuth, a.obliquity - b.obliquity,
                                          a.roll - b.roll,     a.offset - b.offset,   a.hand_scale - b.hand_scale};
  return std::all_of(differences.begin(), differences.end(), [](double d) { return std::abs(d) <= SAME_PLACE; });
}

// The listed grip at the place of another; null if there is none.
const ListedGrip* find_listed(const VesselSums& sums, const GripInput& grip) {
  const auto end = sums.by_height.upper_bound(grip.height + SAME_PLACE);
  for (auto at = sums.by_height.lower_bound(grip.height - SAME_PLACE); at != end; ++at)
    if (is_same_place(sums.listed[at->second].grip, grip)) return &sums.listed[at->second];
  return nullptr;
}

// The fate of a grip that is not listed.
std::string status_of(const Side& side, std::size_t vessel, std::uint64_t grip) {
  const auto is = [&](const char* name, double wanted) { return side.value(name, vessel, grip) == wanted; };
  for (std::size_t reason = 1; reason < REASON_NAMES.size(); ++reason) {
    if (!is("reason", static_cast<double>(reason))) continue;
    std::string words = REASON_NAMES[reason];
    std::replace(words.begin(), words.end(), '_', ' ');
    return "infeasible: " + words;
  }
  if (is("not_held", 1)) return "not held";
  if (!is("plausible", 0)) return "not listed";
  return is("beyond_wrist", 1)    ? "implausible: beyond the wrist"
         : is("through_table", 1) ? "implausible: through the table"
         : is("self_overlap", 1)  ? "implausible: fingers in each other"
                                  : "implausible";
}

// Lines of a scene's text without blank lines and comments, each after the header of its table; a vessel's header has its name.
std::vector<std::string> scene_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string header;
  std::size_t first = 0;  // line of the table
  std::istringstream stream(text);
  const auto end_table = [&] {
    for (std::size_t k = first; k < lines.size(); ++k) lines[k] = header.empty() ? lines[k] : header + " " + lines[k];
    first = lines.size();
  };
  for (std::string line; std::getline(stream, line);) {
    line.erase(0, line.find_first_not_of(" \t"));
    line.erase(line.find_last_not_of(" \t\r") + 1);
    if (line.empty() || line[0] == '#') continue;
    const std::size_t name = line.find_first_not_of('[');
    if ((name == 1 || name == 2) && std::isalpha(static_cast<unsigned char>(line[name]))) {
      end_table();
      header = line.substr(0, line.find(']') + name);
      lines.push_back(line);  // a table without keys has a meaning too
      first = lines.size();
      continue;
    }
    if (header == "[[vessel]]" && line.substr(0, line.find_first_of(" \t=")) == "name") {
      const std::size_t quote = line.find_first_of("\"'");
      if (quote != std::string::npos) header += " " + line.substr(quote, line.find(line[quote], quote + 1) + 1 - quote);
    }
    lines.push_back(line);
  }
  end_table();
  return lines;
}

// "- line" for lines only in the first text and "+ line" for the second; a key's old and new value stand together.
std::vector<std::string> changed_lines(const std::string& a, const std::string& b) {
  const std::vector<std::string> lines_a = scene_lines(a), lines_b = scene_lines(b);
  std::vector<std::array<std::string, 3>> found;  // key, sign, line
  const auto add_missing = [&found](const std::vector<std::string>& lines, const std::vector<std::string>& others,
                                    const char* sign) {
    std::multiset<std::string> there(others.begin(), others.end());
    for (const std::string& line : lines) {
      const auto same = there.find(line);
      if (same == there.end()) {
        found.push_back({line.substr(0, line.find('=')), sign, line});
      } else {
        there.erase(same);
      }
    }
  };
  add_missing(lines_a, lines_b, "- ");
  add_missing(lines_b, lines_a, "+ ");
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& x, const auto& y) { return std::tie(x[0], y[1]) < std::tie(y[0], x[1]); });  // "-" after "+"
  std::vector<std::string> changes;
  for (const auto& [key, sign, line] : found) {
    if (changes.size() == MOST_CHANGES) {
      changes.push_back(fmt::format("and {} more", counted(found.size() - MOST_CHANGES, "line")));
      break;
    }
    std::size_t length = std::min(line.size(), LONGEST_LINE);
    while (length < line.size() && (static_cast<unsigned char>(line[length]) & 0xC0) == 0x80) --length;  // whole characters
    changes.push_back(sign + line.substr(0, length) + (length < line.size() ? " .." : ""));
  }
  return changes;
}

// How both judge: the differences, and first whether scores follow one rule. Returns whether anything differs.
bool add_judging(const Side& a, const Side& b, ComparePart& part) {
  const sweeps::SweepOrigin &from_a = a.result.origin(), &from_b = b.result.origin();
  part.changes = changed_lines(from_a.scene, from_b.scene);
  CompareTable table{"How they judge", {"what", "A", "B"}, {}};
  std::vector<std::string> rules;
  const auto add = [&](const char* name, bool is_same, std::string text_a, std::string text_b, bool is_rule) {
    if (is_same) return;
    if (text_a == text_b) text_b += ", with other details";
    table.rows.push_back({name, std::move(text_a), std::move(text_b)});
    if (is_rule) rules.emplace_back(name);
  };
  const auto meshes = [](const sweeps::SweepOrigin& from) { return from.mesh_keys.empty() ? "none" : "files"; };
  const auto precision = [](const sweeps::SweepOrigin& from) { return from.precision == Precision::single ? "float" : "double"; };
  const auto rules_a = sweeps::scene_rules(a.scene), rules_b = sweeps::scene_rules(b.scene);
  const auto is_shared = sweeps::shared_rules(a.scene, b.scene);
  for (std::size_t k = 0; k < sweeps::RULE_COUNT; ++k) add(rules_a[k].name, is_shared[k], rules_a[k].text, rules_b[k].text, true);
  add("meshes", from_a.mesh_keys == from_b.mesh_keys, meshes(from_a), meshes(from_b), false);
  add("device", from_a.device == from_b.device, from_a.device, from_b.device, false);
  add("driver", from_a.driver == from_b.driver, from_a.driver, from_b.driver, false);
  add("precision", from_a.precision == from_b.precision, precision(from_a), precision(from_b), false);
  add("version", from_a.version == from_b.version, from_a.version, from_b.version, false);
  if (!rules.empty()) part.sentences.push_back(fmt::format("Scores are not of one rule: other {}.", joined(rules, ", other ")));
  if (table.rows.empty()) {
    std::string names = sweeps::rule_names();
    names[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(names[0])));
    part.sentences.push_back(names + ", device, precision and version are the same.");
  } else {
    part.tables.push_back(std::move(table));
  }
  return !part.changes.empty() || !part.tables.empty();
}

CompareTable sums_table(const VesselSums& a, const VesselSums& b) {
  CompareTable table{"Counts, scores and worst efforts", {"what", "A", "B", "change"}, {}};
  for (std::size_t k = 0; k < SUM_ROWS.size(); ++k) {
    if (std::isnan(a.sums[k]) && std::isnan(b.sums[k])) continue;
    const auto text = [digits = SUM_ROWS[k].second](double value) { return fixed_text(value, digits); };
    const std::string change = text(b.sums[k] - a.sums[k]);
    const bool is_more = b.sums[k] > a.sums[k] && change != text(0);
    table.rows.push_back({SUM_ROWS[k].first, text(a.sums[k]), text(b.sums[k]), (is_more ? "+" : "") + change});
  }
  return table;
}

// The first grips of side a, and their values in b.
CompareTable first_grips(const Side& a, std::size_t vessel_a, const VesselSums& sums_a, const Side& b, std::size_t vessel_b,
                         const VesselSums& sums_b) {
  CompareTable table{fmt::format("The first grips of {}, and what they are in {}", a.name, b.name),
                     {"grip", fmt::format("rank in {}", a.name), fmt::format("in {}", b.name)},
                     {}};
  const auto add_pair = [&](const char* what) {
    for (const Side* side : {&a, &b}) table.columns.push_back(fmt::format("{} {}", what, side->name));
  };
  add_pair("score");
  add_pair("effort");
  const bool is_robust = a.scene.robust && b.scene.robust;  // both lists are ranked by these scores
  if (is_robust) add_pair("robust");
  for (std::size_t k = 0; k < std::min(FIRST_GRIPS, sums_a.listed.size()); ++k) {
    const ListedGrip& grip = sums_a.listed[k];
    const ListedGrip* now = find_listed(sums_b, grip.grip);
    const std::uint64_t number = now ? now->candidate.index : grip.candidate.index;  // of B, where it asks for this grip
    const bool is_asked = now || (number < b.plan.grips() && is_same_place(b.plan.grip(vessel_b, number), grip.grip));
    const auto value_b = [&](const char* name) { return is_asked ? b.value(name, vessel_b, number) : std::nan(""); };
    table.rows.push_back({grip_text(a.plan, grip.grip, fixed_text, " deg"), std::to_string(grip.rank),
                          now        ? fmt::format("rank {}", now->rank)
                          : is_asked ? status_of(b, vessel_b, number)
                                     : "not listed",
                          fixed_text(grip.candidate.score, 3), fixed_text(now ? now->candidate.score : value_b("score"), 3),
                          fixed_text(a.value("worst_effort", vessel_a, grip.candidate.index), 3),
                          fixed_text(value_b("worst_effort"), 3)});
    if (is_robust)
      for (const double robust : {grip.robust, now ? now->robust : std::nan("")})
        table.rows.back().push_back(fixed_text(robust, 3));
  }
  return table;
}

// Whether anything differs.
bool add_vessel(const Side& a, std::size_t vessel_a, const Side& b, std::size_t vessel_b, ComparePart& part) {
  const VesselSums sums_a = sums_of(a, vessel_a), sums_b = sums_of(b, vessel_b);
  part.tables.push_back(sums_table(sums_a, sums_b));
  std::size_t common = 0;
  bool is_same_list = sums_a.listed.size() == sums_b.listed.size();
  for (std::size_t k = 0; k < sums_a.listed.size(); ++k) {
    const ListedGrip* now = find_listed(sums_b, sums_a.listed[k].grip);
    common += now ? 1 : 0;
    is_same_list = is_same_list && now && now->rank == sums_a.listed[k].rank;
  }
  if (sums_a.listed.empty() || sums_b.listed.empty()) {
    part.sentences.emplace_back(sums_a.listed.empty() ? "A lists no grip of it." : "B lists no grip of it.");
  } else {
    part.sentences.push_back(is_same_list ? fmt::format("Both list the same {} in the same order.", counted(common, "grip"))
                                          : fmt::format("{} of A's {} {} in B's list.", readable_number(common),
                                                        counted(sums_a.listed.size(), "grip"), common == 1 ? "is" : "are"));
  }
  if (!sums_a.listed.empty()) part.tables.push_back(first_grips(a, vessel_a, sums_a, b, vessel_b, sums_b));
  if (!sums_b.listed.empty() && !is_same_list) part.tables.push_back(first_grips(b, vessel_b, sums_b, a, vessel_a, sums_a));
  const auto is_same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return !is_same_list || !std::equal(sums_a.sums.begin(), sums_a.sums.end(), sums_b.sums.begin(), is_same);
}

// Columns as wide as their widest cell: words are left-aligned; in tables of numbers all columns but the first are right-aligned.
std::string table_text(const CompareTable& table, bool is_of_words) {
  std::vector<std::vector<std::string>> rows{table.columns};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::string> lines(rows.size());
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    std::size_t widest = 0;
    for (const auto& row : rows) widest = std::max(widest, row[k].size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string gap(widest - rows[i][k].size(), ' ');
      lines[i] += "  " + (k == 0 || is_of_words ? rows[i][k] + gap : gap + rows[i][k]);
    }
  }
  for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
  return joined(lines, "\n") + "\n";
}

}  // namespace

std::vector<ComparePart> compare_results(sweeps::SweepResult& a, const Scene& scene_a, sweeps::SweepResult& b,
                                         const Scene& scene_b) {
  const Side side_a("A", a, scene_a), side_b("B", b, scene_b);
  std::vector<ComparePart> parts(1);
  parts[0].title = fmt::format("A: {}, B: {}", a.path().substr(a.path().rfind('/') + 1), b.path().substr(b.path().rfind('/') + 1));
  bool has_changed = add_judging(side_a, side_b, parts[0]);
  const auto place_in = [](const Scene& scene, const std::string& name) {
    const auto found =
        std::find_if(scene.vessels.begin(), scene.vessels.end(), [&](const VesselData& v) { return v.name == name; });
    return static_cast<std::size_t>(found - scene.vessels.begin());
  };
  const auto add_alone = [&](const char* name, const Scene& scene, const Scene& other) {
    std::vector<std::string> alone;
    for (const VesselData& vessel : scene.vessels)
      if (place_in(other, vessel.name) == other.vessels.size()) alone.push_back(vessel.name);
    has_changed = has_changed || !alone.empty();
    if (!alone.empty()) parts[0].sentences.push_back(fmt::format("Only {} has {}.", name, joined(alone, ", ")));
  };
  add_alone("A", scene_a, scene_b);
  add_alone("B", scene_b, scene_a);
  for (std::size_t v = 0; v < scene_a.vessels.size(); ++v) {
    const std::size_t there = place_in(scene_b, scene_a.vessels[v].name);
    if (there == scene_b.vessels.size()) continue;
    parts.emplace_back().title = scene_a.vessels[v].name;
    has_changed = add_vessel(side_a, v, side_b, there, parts.back()) || has_changed;
  }
  if (!has_changed) parts[0].sentences.insert(parts[0].sentences.begin(), "Nothing that is compared differs.");
  return parts;
}

std::string comparison_text(const std::vector<ComparePart>& parts) {
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    text += fmt::format("{}{}\n", k == 0 ? "" : "\n", parts[k].title);
    for (const std::string& sentence : parts[k].sentences) text += "  " + sentence + "\n";
    for (const std::string& line : parts[k].changes) text += "  " + line + "\n";
    for (const CompareTable& table : parts[k].tables) text += "\n" + table_text(table, k == 0);
  }
  return text;
}

std::string comparison_page(const std::vector<ComparePart>& parts) {
  MarkupWriter html;
  begin_page(html, "Comparison of two sweeps");
  html.open("body").open("header").element("h1", "Comparison of two sweeps").close().open("main");
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string id = fmt::format("part{}", k + 1);
    html.open("section", {{"aria-labelledby", id}}).element("h2", parts[k].title, {{"id", id}});
    for (const std::string& sentence : parts[k].sentences) html.element("p", sentence);
    if (!parts[k].changes.empty()) html.element("pre", joined(parts[k].changes, "\n"), {{"tabindex", "0"}});
    for (const CompareTable& table : parts[k].tables) {
      HtmlTable written(html, table.caption, table.columns, k == 0 ? std::vector<std::size_t>{1, 2} : std::vector<std::size_t>{});
      for (auto row : table.rows) {
        for (std::string& cell : row)
          if (cell == "inf" || cell == "+inf" || cell == "-inf") cell.replace(cell.size() - 3, 3, "\u221e");
        written.row(row);
      }
      written.end();
    }
    html.close();
  }
  html.close().element("footer", fmt::format("Written by wholehand {}.", version())).close().close();
  return html.written();
}

}  // namespace wholehand
