// SPDX-License-Identifier: MIT
#include "evidence/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/charts/page_style.h"
#include "base/charts/style.h"
#include "base/files/files.h"
#include "base/system/version.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/candidates.h"
#include "evidence/report/agreement.h"
#include "evidence/report/forces.h"
#include "evidence/report/grips.h"
#include "evidence/report/guidance.h"
#include "evidence/report/holding.h"
#include "evidence/report/maps.h"
#include "evidence/report/scene.h"
#include "sweeps/plan/edge.h"
#include "sweeps/rank/unheld.h"
#include "sweeps/result/tally.h"

namespace wholehand {
namespace {

constexpr std::string_view PAGE_MARK = "content=\"wholehand\"";

// Ids are by number: a vessel's name may be anything.
std::string vessel_id(std::size_t vessel) { return fmt::format("vessel{}", vessel + 1); }

std::string page_title(const Scene& scene) { return scene.name.empty() ? "Grips of a scene" : "Grips of " + scene.name; }

// A list keeps its order, which need not be that of the scores; of several the first grips come first, the better score before.
std::vector<Candidate> best_first(const std::vector<ReportedGrips>& lists) {
  std::vector<std::pair<std::size_t, Candidate>> placed;
  for (const ReportedGrips& best : lists)
    for (std::size_t k = 0; k < best.grips.size(); ++k) placed.emplace_back(k, best.grips[k].candidate);
  std::sort(placed.begin(), placed.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : is_better(a.second, b.second); });
  std::vector<Candidate> candidates;
  for (const auto& [place, candidate] : placed) candidates.push_back(candidate);
  return candidates;
}

// With a capital.
std::string sentence(std::string line) {
  line[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(line[0])));
  return line;
}

void write_contents(MarkupWriter& html, const Scene& scene) {
  html.open("nav", {{"aria-label", "Contents"}}).open("ul");
  const auto link = [&html](const std::string& id, const std::string& text) {
    html.open("li").element("a", text, {{"href", "#" + id}}).close();
  };
  link("asked", "What was asked");
  link("ran", "How it ran");
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) link(vessel_id(v), scene.vessels[v].name);
  link("words", "The words");
  html.close().close();
}

void write_words(MarkupWriter& html, const Scene& scene, bool has_efforts) {
  html.open("section", {{"aria-labelledby", "words"}}).element("h2", "The words", {{"id", "words"}}).open("dl");
  const auto word = [&html](const char* name, const char* meaning) {
    html.open("div").element("dt", name).element("dd", meaning).close();
  };
  word("thumb-index line", "line from the tip of the thumb to the tip of the index finger");
  word("height",
       "height at which the thumb-index line crosses the vessel's axis, or passes it if there is an offset; above the vessel's "
       "base, or above the origin of a mesh that keeps its own origin");
  word("roll", "turn of the hand about the thumb-index line; at 0 the hand is beside the vessel, at \u221290° above it");
  word("obliquity", "angle of the thumb-index line to the horizontal; above 0 the index finger is higher than the thumb");
  word("feasible", "both tips find the vessel, at a gap that the hand can make");
  word("implausible",
       fmt::format("a point or a bone of the hand would be deeper in the vessel, or a finger in another, than the scene "
                   "allows{}{}",
                   scene.table ? ", or the hand would go through the table" : "",
                   scene.arm ? ", or wrist and forearm do not reach the hand within their ranges" : "")
           .c_str());
  word("antipodal", "both contacts lie within the friction cone");
  word("fingers, points", "number of fingers used, of 5; number of points of the hand that touch, of 24");
  word("depth", "how deep the deepest point of the hand or its bones is inside the vessel");
  word("closure", "posture of thumb and index finger as one number: 0 is open, 1 is closed");
  word("peak force", "largest force that the gripper renders over all tilts and fills");
  word("hold force", "force with which each of two soft fingers must press, if they alone hold the vessel");
  word("safe tilt", has_efforts
                        ? "largest tilt up to which the normal force is under the device's limit and the effort is at most 1; with "
                          "a plus, every tilt of the scene is"
                        : "largest tilt up to which the normal force is under the device's limit and the hold force is at most the "
                          "user's grip strength; with a plus, every tilt of the scene is");
  if (has_efforts) {
    word("effort",
         "least share of its strength that the digit nearest to its limit must give so that all contacts of the hand hold the "
         "vessel; up to 1 the hand holds; infinite where no force does");
    word("worst effort", "largest effort over all tilts and fills; the state that has it is the hardest");
    word("not held", "plausible, but the worst effort is above 1: the hand is too weak, or friction is too small");
    word("margin", "how many times over a grip keeps to a limit; below 1 it does not");
  }
  word("score",
       "sum of six terms from 0 to 1, each times its weight: fingers used, points touching, depth, posture, feedback force, and "
       "what holding takes; an infeasible or implausible grip, and one that is not held, scores 0");
  html.close().close();
}

class Page {
 public:
  explicit Page(const ReportSource& source) : source_(source), scene_(source.scene) {}

  std::string write() {
    begin_page(html_, page_title(scene_));
    html_.open("body").open("header").element("h1", page_title(scene_));
    html_.element(
        "p",
        fmt::format("{} of {}, scored by wholehand.", counted(source_.plan.stored_grips() * scene_.vessels.size(), "grip"),
                    counted(scene_.vessels.size(), "vessel")),
        {{"class", "lead"}});
    write_contents(html_, scene_);
    html_.close().open("main");
    write_scene(html_, source_);
    write_origin(html_, source_);
    if (has_map(source_))
      for (std::size_t v = 0; v < scene_.vessels.size(); ++v) maps_.push_back(read_map(source_, v));
    scales_ = map_scales(maps_);
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) write_vessel(v);
    const bool has_efforts = reports_efforts(scene_);
    if (has_efforts) write_protocols(html_);
    write_words(html_, scene_, has_efforts);
    html_.close();
    html_.element("footer", fmt::format("Written by wholehand {} from {}.", version(),
                                        source_.result.path().substr(source_.result.path().rfind('/') + 1)));
    html_.close().close();
    return html_.written();
  }

 private:
  void write_vessel(std::size_t v) {
    const std::string id = vessel_id(v);
    html_.open("section", {{"aria-labelledby", id}}).element("h2", scene_.vessels[v].name, {{"id", id}});
    const std::size_t scales = source_.plan.hand_scales();
    std::vector<ReportedGrips> lists;
    for (std::size_t s = 0; s < scales; ++s) lists.push_back(read_grips(source_, v * scales + s));
    write_summary(v, lists);
    const bool has_efforts = !maps_.empty() && maps_[v].has_efforts;
    html_.element(
        "h3",
        has_efforts ? "Score, fingers, force and effort over height and roll" : "Score, fingers and force over height and roll",
        {{"id", id + "-maps"}});
    if (maps_.empty()) {
      html_.element("p", "The file does not have the score of each grip ([output] keep), so there is no map.");
    } else {
      write_maps(html_, source_, v, maps_[v], scales_, best_first(lists), id);
    }
    for (std::size_t s = 0; s < scales; ++s)
      write_grips(html_, source_, v * scales + s, lists[s], scales == 1 ? id : fmt::format("{}-hand{}", id, s + 1));
    if (const std::optional<GripInput> grip = best_grip(v, lists)) {
      write_forces(html_, source_, v, *grip, id);
      write_efforts(html_, source_, v, *grip, id);
    }
    write_pouring(html_, source_, v, id);
    write_agreement(html_, source_, v, id);
    write_guidance(html_, source_, v, id);
    html_.close();
  }

  // How many grips are what, the best of each hand, and whether it lies at an end of an axis.
  void write_summary(std::size_t v, const std::vector<ReportedGrips>& lists) {
    sweeps::GripCounts counts;
    const bool knows_reasons = read_counts(source_, v, counts);
    if (!knows_reasons) counts.grips = source_.plan.grips();
    html_.open("p").text(sweeps::counts_line(counts, knows_reasons, source_.plan.copies()) + ".");
    if (counts.none_holds() && counts.least_bad.is_known() && source_.core)
      html_.text(" " + sentence(sweeps::unheld_line(*source_.core, scene_, source_.plan, v, counts.least_bad)) + ".");
    for (const ReportedGrips& best : lists) {
      if (best.grips.empty()) continue;
      const sweeps::BestGrip& first = best.grips[0];
      html_.text(fmt::format(" The best grip scores {}: {}.", shown_number(first.score, 3), grip_text(source_.plan, first.grip)));
    }
    html_.close();
    std::set<std::string> noted;  // once for all hands
    for (const ReportedGrips& best : lists) {
      const std::string edge = sweeps::edge_line(sweeps::edge_axes(scene_, source_.plan, v, best_first({best})));
      if (!edge.empty() && noted.insert(edge).second) html_.element("p", sentence(edge));
    }
  }

  // The first grip of the list that begins best; where nothing is listed, that of the map.
  std::optional<GripInput> best_grip(std::size_t v, const std::vector<ReportedGrips>& lists) const {
    const std::vector<Candidate> listed = best_first(lists);
    if (!listed.empty()) return source_.plan.grip(v, listed[0].index);
    const MapCell* cell = maps_.empty() ? nullptr : maps_[v].best();
    return cell ? std::optional(source_.plan.grip(v, cell->grip)) : std::nullopt;
  }

  const ReportSource& source_;
  const Scene& scene_;
  MarkupWriter html_;
  std::vector<GripMap> maps_;
  MapScales scales_;
};

}  // namespace

std::string report_page(sweeps::SweepResult& result, const Scene& given, const std::string& mesh_error,
                        const std::string& lists_file) {
  Scene scene = given;
  sweeps::set_heights(result, scene);
  const sweeps::Plan plan(scene, sweeps::keeps_vectors(result.variables()));
  result.use(scene, plan);
  ReportSource source{result, scene, plan, nullptr, mesh_error, std::nullopt, lists_file.substr(lists_file.rfind('/') + 1)};
  if (!lists_file.empty()) source.lists = sweeps::read_grip_lists(lists_file, result, scene, plan);
  if (mesh_error.empty()) {
    try {
      source.core = make_core_evaluator(scene);
    } catch (const Error& error) {
      source.no_core = error.what();
    }
  }
  return Page(source).write();
}

void begin_page(MarkupWriter& html, const std::string& title) {
  html.markup("<!DOCTYPE html>\n").open("html", {{"lang", "en"}, {"xmlns", "http://www.w3.org/1999/xhtml"}});
  html.open("head");
  html.empty("meta", {{"charset", "utf-8"}});
  html.empty("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.empty("meta", {{"name", "generator"}, {"content", "wholehand"}});
  html.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.element("title", title);
  html.open("style").markup(REPORT_STYLE).markup(CHART_RULES).markup(LINE_RULES).close();
  html.close();
}

void check_overwrites_page(const std::string& path, const std::string& result) {
  if (is_same_file(path, result))
    throw usage_error(fmt::format("-o {}: this is the result file itself; name another file for the page", path));
  check_overwrites_marked(path, PAGE_MARK, "page of wholehand's", "-o");
}

}  // namespace wholehand
