#include "sweeps/report_page.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>

#include "core/error.h"
#include "sweeps/readable.h"
#include "sweeps/report_agreement.h"
#include "sweeps/report_forces.h"
#include "sweeps/report_grips.h"
#include "sweeps/report_guidance.h"
#include "sweeps/report_maps.h"
#include "sweeps/report_scene.h"
#include "sweeps/report_style.h"
#include "sweeps/tally.h"

namespace wholehand {
namespace {

// Ids are by number: a vessel's name may be anything.
std::string vessel_id(std::size_t vessel) { return fmt::format("vessel{}", vessel + 1); }

std::string page_title(const Scene& scene) { return scene.name.empty() ? "Grips of a scene" : "Grips of " + scene.name; }

void write_head(HtmlWriter& html, const Scene& scene) {
  html.open("head");
  html.empty("meta", {{"charset", "utf-8"}});
  html.empty("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.element("title", page_title(scene));
  html.open("style").markup(REPORT_STYLE).close();
  html.close();
}

void write_contents(HtmlWriter& html, const Scene& scene) {
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

void write_words(HtmlWriter& html) {
  html.open("section", {{"aria-labelledby", "words"}}).element("h2", "The words", {{"id", "words"}}).open("dl");
  const auto word = [&html](const char* name, const char* meaning) {
    html.open("div").element("dt", name).element("dd", meaning).close();
  };
  word("height",
       "where the line between the tips of thumb and index finger crosses the vessel's axis: above its base, or above the origin "
       "of a mesh that keeps its own");
  word("roll", "turn of the hand about that line; 0: beside the vessel, \u221290°: above");
  word("obliquity", "angle of that line to the horizontal, the index finger above");
  word("feasible", "both tips find the vessel, at a gap that the hand can make");
  word("implausible", "a point of the hand would be deeper in the vessel than the scene allows");
  word("antipodal", "both contacts lie within the cone of friction");
  word("fingers, points", "fingers used of 5, points of the hand touching of 24");
  word("depth", "of the deepest point of the hand inside");
  word("closure", "of thumb and index finger; 0 open, 1 closed");
  word("peak force", "largest force that the gripper renders over all tilts and fills");
  word("hold force", "grip force per finger that physics asks for");
  word("safe tilt", "up to it the force stays under the device's and the hold force under the user's");
  word("score",
       "weighted sum of terms from 0 to 1: fingers used, points touching, depth, posture, feedback force, hold force; 0 for an "
       "implausible grip");
  html.close().close();
}

class Page {
 public:
  explicit Page(const ReportSource& source) : source_(source), scene_(source.scene) {}

  std::string write() {
    html_.markup("<!DOCTYPE html>\n").open("html", {{"lang", "en"}, {"xmlns", "http://www.w3.org/1999/xhtml"}});
    write_head(html_, scene_);
    html_.open("body").open("header").element("h1", page_title(scene_));
    html_.element("p",
                  fmt::format("{} of {} vessel{}, scored by wholehand.",
                              readable_count(static_cast<double>(source_.plan.stored_grips() * scene_.vessels.size())) + " grips",
                              scene_.vessels.size(), scene_.vessels.size() == 1 ? "" : "s"),
                  {{"class", "lead"}});
    write_contents(html_, scene_);
    html_.close().open("main");
    write_scene(html_, source_);
    write_origin(html_, source_);
    if (has_map(source_))
      for (std::size_t v = 0; v < scene_.vessels.size(); ++v) maps_.push_back(read_map(source_, v));
    scales_ = map_scales(maps_);
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) write_vessel(v);
    write_words(html_);
    html_.close();
    html_.element("footer", fmt::format("Written by wholehand {} from {}.", WHOLEHAND_VERSION,
                                        source_.result.path().substr(source_.result.path().rfind('/') + 1)));
    html_.close().close();
    return html_.html();
  }

 private:
  void write_vessel(std::size_t v) {
    const std::string id = vessel_id(v);
    html_.open("section", {{"aria-labelledby", id}}).element("h2", scene_.vessels[v].name, {{"id", id}});
    GripCounts counts;
    const bool knows_reasons = read_counts(source_, v, counts);
    if (!knows_reasons) counts.grips = source_.plan.grips();
    const ReportedGrips best = read_grips(source_, v);
    std::string summary = counts_line(counts, knows_reasons, source_.plan.copies()) + ".";
    if (!best.grips.empty())
      summary +=
          fmt::format(" The best scores {}: {}.", html_number(best.grips[0].score, 3), grip_text(source_.plan, best.grips[0].grip));
    html_.element("p", summary);
    html_.element("h3", "Score, fingers and force over height and roll", {{"id", id + "-maps"}});
    if (maps_.empty()) {
      html_.element("p", "The file does not have the score of each grip ([output] keep), so there is no map.");
    } else {
      std::vector<Candidate> marked;
      for (const BestGrip& grip : best.grips) marked.push_back(grip.candidate);
      write_maps(html_, source_, v, maps_[v], scales_, marked, id);
    }
    write_grips(html_, source_, v, best, id);
    if (const std::optional<GripInput> grip = best_grip(v, best)) write_forces(html_, source_, v, *grip, id);
    write_pouring(html_, source_, v, id);
    write_agreement(html_, source_, v, id);
    write_guidance(html_, source_, v, id);
    html_.close();
  }

  // The listed one; of a sweep that listed none, that of the map.
  std::optional<GripInput> best_grip(std::size_t v, const ReportedGrips& best) const {
    if (!best.grips.empty()) return best.grips[0].grip;
    const MapCell* cell = maps_.empty() ? nullptr : maps_[v].best();
    return cell ? std::optional(source_.plan.grip(v, cell->grip)) : std::nullopt;
  }

  const ReportSource& source_;
  const Scene& scene_;
  HtmlWriter html_;
  std::vector<GripMap> maps_;
  MapScales scales_;
};

}  // namespace

std::string report_page(SweepResult& result, const Scene& given, const std::string& trouble) {
  Scene scene = given;
  // of a mesh that is not there the file alone knows the height
  const std::vector<double> heights = result.vessel_heights(), bases = result.vessel_bases();
  for (std::size_t v = 0; v < std::min({heights.size(), bases.size(), scene.vessels.size()}); ++v) {
    if (!scene.vessels[v].mesh || scene.vessels[v].mesh->body) continue;
    scene.vessels[v].height = heights[v];
    scene.vessels[v].base = bases[v];
  }
  const Plan plan(scene, keeps_vectors(result.variables()));
  result.use(scene, plan);
  ReportSource source{result, scene, plan, nullptr, trouble};
  if (trouble.empty()) {
    try {
      source.core = make_core_evaluator(scene);
    } catch (const Error& error) {
      source.no_core = error.what();
    }
  }
  return Page(source).write();
}

void check_overwrites_page(const std::string& path, const std::string& result) {
  struct stat written {
  }, read{};
  if (stat(path.c_str(), &written) != 0) return;
  if (stat(result.c_str(), &read) == 0 && written.st_dev == read.st_dev && written.st_ino == read.st_ino)
    throw usage_error(fmt::format("-o {}: this is the result file itself; name another file for the page", path));
  std::ifstream file(path, std::ios::binary);
  std::string head(15, ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  std::transform(head.begin(), head.end(), head.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (file.gcount() != 0 && !head.starts_with("<!doctype html"))
    throw usage_error(fmt::format("-o {}: is there and is no HTML page; name another, or remove it", path));
}

}  // namespace wholehand
