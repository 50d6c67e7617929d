// SPDX-License-Identifier: MIT
#include "evidence/report/grips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/core_backend.h"
#include "evidence/report/holding.h"
#include "evidence/report/margins.h"
#include "sweeps/grips/forces.h"
#include "sweeps/grips/hand_nodes.h"
#include "sweeps/grips/svg.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand {
namespace {

// The number in `name="1.5"` after `from`; NaN if there is none.
double attribute_after(const std::string& svg, std::size_t from, const std::string& name) {
  const std::size_t at = svg.find(" " + name + "=\"", from);
  return at == std::string::npos ? std::nan("") : std::strtod(svg.c_str() + at + name.size() + 3, nullptr);
}

void erase_group(std::string& svg, const std::string& id) {
  const std::size_t begin = svg.find("<g id=\"" + id + "\">");
  const std::size_t end = begin == std::string::npos ? begin : svg.find("</g>", begin);
  if (end != std::string::npos) svg.erase(begin, end + 4 - begin);
}

// Which fingers touch, in words for screen readers.
std::string touching_text(const GripResult& result) {
  std::string text;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const int touching = std::popcount(result.touch_mask >> finger_start(f) & ((1u << finger_joints(f)) - 1));
    text += fmt::format("{}{} {} of {}", f == 0 ? "" : ", ", FINGER_NAMES[f], touching, finger_joints(f));
  }
  return text;
}

bool is_refined(const sweeps::BestGrip& grip) { return !std::isnan(grip.refined_score); }
bool has_refined(const ReportedGrips& best) { return std::any_of(best.grips.begin(), best.grips.end(), is_refined); }
bool has_robust(const ReportedGrips& best) {
  return std::any_of(best.grips.begin(), best.grips.end(),
                     [](const sweeps::BestGrip& grip) { return !std::isnan(grip.robust.mean); });
}

// With a plus if it is the largest tilt of the scene.
std::string safe_tilt_text(const sweeps::BestGrip& grip) {
  return std::isnan(grip.safe_tilt) ? shown_number(grip.safe_tilt, 0) : range_text(degrees(grip.safe_tilt), grip.is_safe_to_end);
}

using GripText = std::function<std::string(const sweeps::BestGrip&)>;
// A column of the table, and a grip's cell in it.
struct GripColumn {
  std::string title;
  GripText cell;
};
using GripColumns = std::vector<GripColumn>;

// The axes that the plan varies.
void add_axes(const sweeps::Plan& plan, GripColumns& columns) {
  const auto add = [&](int place, const char* title, const GripText& cell) {
    if (plan.varies(place) && !(place == sweeps::PLACE_HAND_SCALE && plan.hand_scales() > 1)) columns.push_back({title, cell});
  };
  add(sweeps::PLACE_ROLL, "roll (°)", [](const sweeps::BestGrip& b) { return shown_number(degrees(b.grip.roll), 1); });
  add(sweeps::PLACE_OBLIQUITY, "obliquity (°)",
      [](const sweeps::BestGrip& b) { return shown_number(degrees(b.grip.obliquity), 1); });
  add(sweeps::PLACE_AZIMUTH, "azimuth (°)", [](const sweeps::BestGrip& b) { return shown_number(degrees(b.grip.azimuth), 1); });
  add(sweeps::PLACE_OFFSET, "offset (mm)", [](const sweeps::BestGrip& b) { return shown_number(b.grip.offset * 1e3, 1); });
  add(sweeps::PLACE_HAND_SCALE, "hand scale", [](const sweeps::BestGrip& b) { return shown_number(b.grip.hand_scale, 3); });
}

// What the core computed of whole grips.
void add_results(bool has_tilts, GripColumns& columns) {
  const auto add = [&](const char* title, const GripText& cell) { columns.push_back({title, cell}); };
  add("fingers", [](const sweeps::BestGrip& b) { return std::to_string(b.fingers_used); });
  add("points", [](const sweeps::BestGrip& b) { return std::to_string(b.points_touching); });
  add("depth (mm)", [](const sweeps::BestGrip& b) { return shown_number(std::max(b.phalanx_depth, b.palm_depth) * 1e3, 1); });
  add("closure", [](const sweeps::BestGrip& b) { return shown_number(b.closure, 2); });
  add("gap (mm)", [](const sweeps::BestGrip& b) { return shown_number(b.gap * 1e3, 1); });
  if (!has_tilts) return add("antipodal", [](const sweeps::BestGrip& b) { return std::string(b.antipodal ? "yes" : "no"); });
  add("peak force (N)", [](const sweeps::BestGrip& b) { return shown_number(b.peak_force, 2); });
  add("at tilt (°)", [](const sweeps::BestGrip& b) { return plain_number(degrees(b.peak_tilt)); });
  add("hold force (N)", [](const sweeps::BestGrip& b) { return shown_number(b.largest_hold, 1); });
  add("safe tilt (°)", safe_tilt_text);
}

GripColumns columns_of(const ReportSource& source, const ReportedGrips& best) {
  const sweeps::Plan& plan = source.plan;
  GripColumns columns{{"rank", [](const sweeps::BestGrip& b) { return std::to_string(b.rank); }},
                      {"score", [](const sweeps::BestGrip& b) { return shown_number(b.score, 3); }},
                      {"height (mm)", [](const sweeps::BestGrip& b) { return shown_number(b.grip.height * 1e3, 1); }}};
  add_axes(plan, columns);
  if (best.is_whole) add_results(!source.scene.tilts.empty(), columns);
  if (has_refined(best)) {
    columns.push_back({"refined score", [](const sweeps::BestGrip& b) { return shown_number(b.refined_score, 3); }});
    columns.push_back({"refined grip", [&](const sweeps::BestGrip& b) { return is_refined(b) ? grip_text(plan, b.refined) : ""; }});
  }
  if (has_robust(best)) {
    columns.push_back({"robust low", [](const sweeps::BestGrip& b) { return shown_number(b.robust.low, 3); }});
    columns.push_back({"robust mean", [](const sweeps::BestGrip& b) { return shown_number(b.robust.mean, 3); }});
    columns.push_back({"share that holds", [](const sweeps::BestGrip& b) { return shown_number(b.robust.share, 2); }});
  }
  return columns;
}

void write_table(MarkupWriter& html, const ReportSource& source, std::size_t list, const ReportedGrips& best) {
  const GripColumns columns = columns_of(source, best);
  std::vector<std::string> texts;  // of a row
  for (const GripColumn& column : columns) texts.push_back(column.title);
  HtmlTable table(html,
                  fmt::format("The best {} of {}", best.grips.size() == 1 ? "grip" : counted(best.grips.size(), "grip"),
                              sweeps::list_name(source.scene, source.plan, list)),
                  texts);
  for (const sweeps::BestGrip& grip : best.grips) {
    std::ranges::transform(columns, texts.begin(), [&](const GripColumn& column) { return column.cell(grip); });
    table.row(texts);
  }
  table.end();
}

// One grip's drawing with its content in words; throws Error if it cannot be drawn.
void draw_grip(MarkupWriter& html, const ReportSource& source, std::size_t list, const sweeps::BestGrip& best,
               const std::vector<RankedReport>& reports, std::size_t k) {
  const sweeps::GripReport& report = reports[k].report;
  const std::string svg = front_and_side(sweeps::grip_svg(source.scene, list / source.plan.hand_scales(), report));
  const sweeps::DrawnForces forces(report);
  const std::string arrows = forces.empty() ? "" : fmt::format(" Arrows show the forces of the hand: {}.", forces.words());
  const std::string alt =
      fmt::format("Front and side view of the hand on {}, grip {} of the best: {}. Points touching by finger: {}.{}",
                  sweeps::list_name(source.scene, source.plan, list), best.rank, grip_text(source.plan, best.grip),
                  touching_text(report.answer.result), arrows);
  html.open("div", {{"class", "drawing"}});
  html.empty("img", {{"src", svg_address(svg)}, {"alt", alt}});
  html.element("p", fmt::format("{}: score {}; {}{}", best.rank, shown_number(best.score, 3), grip_text(source.plan, best.grip),
                                forces.empty() ? "" : "; " + forces.words()));
  if (const std::string text = verdict(source.scene, report, reports); !text.empty()) html.element("p", text);
  html.close();
}

void write_drawings(MarkupWriter& html, const ReportSource& source, std::size_t list, const ReportedGrips& best,
                    const std::vector<RankedReport>& reports) {
  const std::string name = sweeps::list_name(source.scene, source.plan, list);
  MarkupWriter drawings;
  std::string refusal;
  std::size_t drawn = 0;
  bool has_forces = false;
  for (std::size_t rank = 0; rank < std::min(DRAWN_GRIPS, best.grips.size()); ++rank) {
    try {
      draw_grip(drawings, source, list, best.grips[rank], reports, rank);
    } catch (const Error& error) {
      refusal = error.what();
      continue;
    }
    ++drawn;
    has_forces = has_forces || !sweeps::DrawnForces(reports[rank].report).empty();
  }
  if (drawn > 0) {
    html.open("figure").open("div", {{"class", "drawings"}}).markup(drawings.written()).close();
    html.element(
        "figcaption",
        fmt::format("The best {} of {}, seen from the side of the hand and from its right. Discs are points that touch "
                    "where they were. Diamonds are points that were brought to the glass. Rings are points that do not "
                    "touch. T: thumb, I: index, M: middle, R: ring, L: little finger.{}",
                    drawn == 1 ? "grip" : fmt::format("{} grips", drawn), name,
                    has_forces ? " Arrows show the forces of the hand on the vessel in the state that takes most effort." : ""));
    html.close();
  }
  if (!refusal.empty())
    html.element("p", fmt::format("{} of the best grips cannot be drawn: {}.", drawn == 0 ? "The first" : "Some", refusal));
}

// How the grips hold and what limits them, by the core. Nothing without reports_efforts.
void write_limits(MarkupWriter& html, const ReportSource& source, std::size_t list, const std::vector<RankedReport>& reports) {
  const std::string name = sweeps::list_name(source.scene, source.plan, list);
  const std::size_t drawn = std::min(DRAWN_GRIPS, reports.size());
  if (!reports_efforts(source.scene)) return;
  write_digits(html, source.scene, {reports.begin(), reports.begin() + static_cast<std::ptrdiff_t>(drawn)}, name);
  write_margins(html, source.scene, reports, name);
  if (reports.size() == drawn) return;
  html.open("details").element("summary", "Why each of the other grips is good, and what would fail first").open("ul");
  for (std::size_t k = drawn; k < reports.size(); ++k) {
    const std::string text = verdict(source.scene, reports[k].report, reports);
    html.element("li", fmt::format("{}: {}", reports[k].rank, text.empty() ? "The core finds that it is not feasible." : text));
  }
  html.close().close();
}

const char* no_best_grips(const Scene& scene) {
  return has_effort(scene) ? "There are no best grips: no grip is feasible and plausible and holds."
                           : "There are no best grips: no grip is feasible and plausible.";
}

}  // namespace

std::string front_and_side(const std::string& drawing) {
  constexpr double LARGER = 1.9;  // letters, times those of the whole drawing
  const std::size_t head = drawing.find(">front</text>"), text = head == std::string::npos ? head : drawing.rfind("<text", head);
  const std::size_t box = drawing.find(" viewBox=\"0 0 "), style = drawing.find("</style>"), font = drawing.find("font-size: ");
  if (text == std::string::npos || box == std::string::npos || style == std::string::npos || font == std::string::npos)
    return drawing;
  const double letter = std::strtod(drawing.c_str() + font + 11, nullptr), head_y = attribute_after(drawing, text, "y");
  char* next = nullptr;
  const double width = std::strtod(drawing.c_str() + box + 14, &next), height = std::strtod(next, nullptr);
  const double top = head_y - LARGER * letter;
  if (!(letter > 0 && width > 0 && top > 0 && height > top)) return drawing;
  std::string part = drawing;
  part.insert(style, fmt::format("text {{ font-size: {:.2f}px }}\n", LARGER * letter));
  for (const char* gone : {"top", "legend"}) erase_group(part, gone);
  // the picture's own size does not matter: the page gives it one
  const std::size_t size = part.find(" width=\""), box_end = part.find('"', part.find(" viewBox=\"") + 10);
  // room at the right and below, into which the larger letters grow
  const double wider = width + 2.2 * LARGER * letter, taller = height - top + LARGER * letter;
  part.replace(size, box_end + 1 - size,
               fmt::format(" width=\"{0:.2f}\" height=\"{1:.2f}\" viewBox=\"0 {2:.2f} {0:.2f} {1:.2f}\"", wider, taller, top));
  const std::size_t ground = part.find("<rect ");
  if (ground != std::string::npos)
    part.replace(ground, part.find("/>", ground) + 2 - ground,
                 fmt::format("<rect y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#ffffff\"/>", top, wider, taller));
  return part;
}

ReportedGrips read_grips(const ReportSource& source, std::size_t list) {
  const std::size_t scales = source.plan.hand_scales(), vessel = list / scales;
  std::vector<sweeps::RankedCandidate> ranked;
  // only the sweep's own list has them
  std::vector<std::optional<sweeps::RefinedGrip>> refined;
  std::vector<sweeps::RobustScore> robust;
  if (source.lists) {
    ranked = (*source.lists)[list];
  } else {
    for (const Candidate& candidate : source.result.best(vessel, list % scales)) ranked.push_back({ranked.size() + 1, candidate});
    refined = source.result.refined(vessel, list % scales);
    robust = source.result.robust(vessel, list % scales);
  }
  ReportedGrips best;
  best.listed = ranked.size();
  ranked.resize(std::min(ranked.size(), TABLED_GRIPS));
  std::vector<Candidate> candidates;
  for (const sweeps::RankedCandidate& grip : ranked) candidates.push_back(grip.candidate);
  if (source.core) {
    CoreBackend backend(source.core, source.scene, make_field_set(sweeps::best_fields(source.scene), source.scene), Precision::full,
                        0);
    best.grips = sweeps::evaluate_best(backend, source.scene, source.plan, vessel, candidates);
    best.is_whole = true;
  }
  best.grips.resize(ranked.size());
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    best.grips[k].candidate = candidates[k];
    best.grips[k].grip = source.plan.grip(vessel, candidates[k].index);
    best.grips[k].score = candidates[k].score;
    best.grips[k].rank = ranked[k].rank;
    if (k < robust.size()) best.grips[k].robust = robust[k];
    if (k >= refined.size() || !refined[k]) continue;
    best.grips[k].refined = refined[k]->grip;
    best.grips[k].refined_score = refined[k]->score;
  }
  return best;
}

void write_grips(MarkupWriter& html, const ReportSource& source, std::size_t list, const ReportedGrips& best,
                 const std::string& id) {
  const std::size_t scales = source.plan.hand_scales();
  const std::string of_hand =
      scales == 1 ? "" : fmt::format(" at hand scale {}", plain_number(source.plan.hand_scale(list % scales)));
  html.element("h3", "The best grips" + of_hand, {{"id", id + "-best"}});
  if (best.grips.empty()) {
    html.element("p", source.lists                 ? fmt::format("{} lists no grips.", source.lists_file)
                      : source.result.lists_best() ? no_best_grips(source.scene)
                                                   : "The sweep was not asked to list grips.");
    return;
  }
  std::vector<RankedReport> reports;
  if (source.core) {
    // with efforts all are reported, otherwise only the drawn ones
    const std::size_t asked = reports_efforts(source.scene) ? best.grips.size() : std::min(DRAWN_GRIPS, best.grips.size());
    for (std::size_t k = 0; k < asked; ++k) {
      reports.push_back({best.grips[k].rank, grip_with_holding(source, list / scales, best.grips[k].grip)});
      if (!std::isnan(best.grips[k].robust.share)) reports.back().report.held_share = best.grips[k].robust.share;
    }
    write_drawings(html, source, list, best, reports);
  }
  write_table(html, source, list, best);
  const std::string whose = source.lists ? fmt::format("Places and scores come from {}", source.lists_file)
                                         : std::string("Places and scores come from the sweep");
  std::string note = best.is_whole ? whose +
                                         ". The core computed the rest in double precision. The forces are the largest over all "
                                         "fills, and the safe tilt is the smallest."
                                   : fmt::format("Fingers, forces and drawings are left out: {}.", source.no_core);
  if (best.listed > best.grips.size())
    note += fmt::format(" {} listed {}.", source.lists ? source.lists_file : "The sweep", counted(best.listed, "grip"));
  if (has_refined(best))
    note +=
        " The refined grip is the best one that the core found within half a step of the axes. Everything else, the drawings "
        "included, describes the grip as it was swept.";
  if (has_robust(best))
    note += fmt::format(
        " The sweep ranked the grips by their scores at {} random deviations by [robust]: robust low is the 10th percentile of "
        "these "
        "scores, robust mean their mean, and the share that holds that of deviations which are feasible, plausible and held.",
        source.scene.robust->count);
  html.element("p", note, {{"class", "note"}});
  write_limits(html, source, list, reports);
}

}  // namespace wholehand
