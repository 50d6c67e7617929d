// SPDX-License-Identifier: MIT
#include "evidence/report/maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "shaders/layout.h"
#include "sweeps/result/heat_map_plot.h"

namespace wholehand {
namespace {

constexpr std::size_t CHUNK_OF_GRIPS = 1 << 16;

// Some variables of a vessel's grips at the plan's own places, chunk after chunk: columns[i] is the i-th variable's plane.
struct ColumnOf {
  const sweeps::Variable* variable;
  std::size_t plane;
};

void read_columns(
    const ReportSource& source, std::size_t vessel, const std::vector<ColumnOf>& wanted,
    const std::function<void(std::uint64_t first, std::size_t count, const std::vector<std::vector<double>>&)>& take) {
  std::vector<std::vector<double>> columns(wanted.size());
  for (std::uint64_t first = 0; first < source.plan.grips(); first += CHUNK_OF_GRIPS) {
    const std::size_t count = std::min<std::uint64_t>(CHUNK_OF_GRIPS, source.plan.grips() - first);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      columns[i].resize(count);
      source.result.read(*wanted[i].variable, vessel, wanted[i].plane, first, count, columns[i].data());
    }
    take(first, count, columns);
  }
}

// Computes the values of each cell's best grip that the file lacks.
void fill_by_core(const ReportSource& source, std::size_t vessel, GripMap& map) {
  std::vector<GripInput> grips;
  std::vector<MapCell*> cells;
  for (MapCell& cell : map.cells) {
    if (cell.kind != CellKind::filled) continue;
    grips.push_back(source.plan.grip(vessel, cell.grip));
    cells.push_back(&cell);
  }
  if (grips.empty()) return;
  const bool has_tilts = !source.scene.tilts.empty();
  std::vector<int> fields{FIELD_USED_MASK};
  if (has_tilts) fields.push_back(FIELD_PEAK_FORCE);
  const GatheredPlanes planes = planes_by_core(source, vessel, grips, fields);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!map.has_fingers) cells[i]->fingers = std::popcount(planes.uint(FIELD_USED_MASK, i));
    if (map.has_forces || !has_tilts) continue;
    for (std::size_t fill = 0; fill < scene_fills(source.scene); ++fill) {
      const double force = planes.real(planes.fields.plane[FIELD_PEAK_FORCE] + static_cast<int>(fill), i);
      if (!(cells[i]->peak_force >= force)) cells[i]->peak_force = force;
    }
  }
  map.is_by_core = !map.has_fingers || (has_tilts && !map.has_forces);
  map.has_fingers = true;
  map.has_forces = has_tilts;
}

// Edges in what people read: degrees; mm, of fractions of a vessel's height too.
std::vector<double> map_edges(const sweeps::MapAxis& axis, double scale, double from = 0) {
  std::vector<double> edges;
  for (std::size_t i = 0; i <= axis.cells(); ++i) edges.push_back(from + axis.edge(i) * scale);
  return edges;
}

// The axes that vary beside height and roll: "obliquity and offset".
std::string other_axes(const sweeps::Plan& plan) {
  std::vector<std::string> names;
  for (const int place : {sweeps::PLACE_AZIMUTH, sweeps::PLACE_OBLIQUITY, sweeps::PLACE_OFFSET, sweeps::PLACE_HAND_SCALE}) {
    if (!plan.varies(place)) continue;
    names.push_back(plan.axes()[place].name);
    std::replace(names.back().begin(), names.back().end(), '_', ' ');
  }
  return joined(names, names.size() == 2 ? " and " : ", ");
}

// Lowest and highest of a value over the filled cells of all maps; false: there is none.
bool value_range(const std::vector<GripMap>& maps, double MapCell::*value, double& low, double& high) {
  low = INFINITY;
  high = -INFINITY;
  for (const GripMap& map : maps) {
    for (const MapCell& cell : map.cells) {
      if ((value != &MapCell::effort && cell.kind != CellKind::filled) || !std::isfinite(cell.*value)) continue;
      low = std::min(low, cell.*value);
      high = std::max(high, cell.*value);
    }
  }
  return low <= high;
}

std::string cell_text(const ReportSource& source, std::size_t vessel, const MapCell& cell) {
  return grip_text(source.plan, source.plan.grip(vessel, cell.grip));
}

// What all maps of a vessel have in common: edges, grays and marks.
FieldChart map_frame(const ReportSource& source, std::size_t vessel, const GripMap& map, const std::vector<Candidate>& best) {
  FieldChart chart;
  chart.x_label = "roll (°)";
  chart.y_label = "height (mm)";
  chart.x_is_angle = true;
  const VesselData& data = source.scene.vessels[vessel];
  const bool is_fraction = source.scene.grips.height_is_fraction;
  chart.x_edges = map_edges(map.rolls, degrees(1));
  chart.y_edges = map_edges(map.heights, 1e3 * (is_fraction ? data.height - data.base : 1), is_fraction ? 1e3 * data.base : 0);
  for (const MapCell& cell : map.cells) chart.kinds.push_back(cell.kind);
  const auto has = [&chart](CellKind kind) { return std::find(chart.kinds.begin(), chart.kinds.end(), kind) != chart.kinds.end(); };
  const bool may_fail = has_effort(source.scene);
  if (has(CellKind::hollow)) chart.hollow = may_fail ? "none holds" : map.knows_reasons ? "only implausible" : "none plausible";
  if (has(CellKind::absent)) chart.absent = "none feasible";
  for (const Candidate& candidate : best) {
    const GripInput grip = source.plan.grip(vessel, candidate.index);
    chart.marks.push_back({degrees(grip.roll), grip.height * 1e3, chart.marks.empty()});
  }
  chart.mark = best.size() > 1 ? fmt::format("best {}", best.size()) : "best";
  return chart;
}

void write_map(MarkupWriter& html, FieldChart& frame, const GripMap& map, double MapCell::*value, const ColorScale& scale,
               const ChartName& name) {
  frame.name = name;
  frame.scale = scale;
  frame.values.clear();
  for (const MapCell& cell : map.cells) frame.values.push_back(cell.*value);
  html.open("div", {{"class", "chart"}});
  write_chart(html, frame);
  html.close();
}

// No effort (NaN) and a damaged one are passed over.
void take_effort(MapCell& cell, double effort, std::uint64_t grip) {
  if (!(effort >= 0) || cell.effort <= effort) return;
  cell.effort = effort;
  cell.effort_grip = grip;
}

// "0.41 to 0.87": lowest and highest over the filled cells.
std::string extent_text(const GripMap& map, double MapCell::*value, int digits) {
  double low = 0, high = 0;
  value_range({map}, value, low, high);
  return fmt::format("{} to {}", shown_number(low, digits), shown_number(high, digits));
}

// The map of the least worst effort has grays of its own: dark where a grip is plausible and nothing holds the vessel.
void write_effort_map(MarkupWriter& html, const ReportSource& source, std::size_t vessel, FieldChart frame, const GripMap& map,
                      const ColorScale& scale, ChartName name) {
  frame.kinds.clear();
  frame.hollow.clear();
  frame.absent.clear();
  const MapCell* least = nullptr;
  std::size_t infinite = 0;
  for (const MapCell& cell : map.cells) {
    frame.kinds.push_back(std::isfinite(cell.effort) ? CellKind::filled
                          : std::isinf(cell.effort)  ? CellKind::hollow
                                                     : CellKind::absent);
    infinite += std::isinf(cell.effort);
    if (frame.kinds.back() == CellKind::hollow) frame.hollow = "nothing holds";
    if (frame.kinds.back() == CellKind::absent) frame.absent = "none plausible";
    if (std::isfinite(cell.effort) && (!least || cell.effort < least->effort)) least = &cell;
  }
  name.description = "Heat map of the least worst effort over height and roll";
  if (least) {
    name.description += fmt::format(": {}. The least is at {}.", extent_text(map, &MapCell::effort, 2),
                                    grip_text(source.plan, source.plan.grip(vessel, least->effort_grip)));
  } else {
    name.description += ": no grip holds the vessel.";
  }
  if (infinite > 0)
    name.description += fmt::format(" In {} of {} cells no force of the hand holds the vessel.", readable_number(infinite),
                                    readable_number(map.cells.size()));
  write_map(html, frame, map, &MapCell::effort, scale, name);
}

std::string maps_caption(const ReportSource& source, const GripMap& map) {
  std::string caption;
  const std::string others = other_axes(source.plan);
  if (source.plan.is_sobol()) {
    caption = "Each cell shows the best of the points that lie in it, as the sweep has points and no grid. ";
  } else if (!others.empty()) {
    caption = fmt::format("Each cell shows the best grip over {}. ", others);
  }
  caption += map.has_efforts ? "The maps of the score, the fingers and the force show the same grips; colors mean the same for all "
                               "vessels."
                             : "All maps of a vessel show the same grips; colors mean the same for all vessels.";
  if (map.is_by_core) caption += " The file lacks some of the fingers and forces; the core computed them in double precision.";
  if (map.has_efforts) {
    caption +=
        " The map of the effort shows the least worst effort, which another grip may have. Where it is above 1, the hand is too "
        "weak.";
    double low = 0, high = 0;
    if (value_range({map}, &MapCell::effort, low, high) && high > MOST_MAPPED_EFFORT)
      caption += fmt::format(" Efforts above {} have the color of {}.", plain_number(MOST_MAPPED_EFFORT),
                             plain_number(MOST_MAPPED_EFFORT));
  }
  if (!map.has_fingers) caption += " The file does not have the fingers used.";
  if (source.scene.tilts.empty()) {
    caption += " The scene has no tilts, so there are no forces.";
  } else if (!map.has_forces) {
    caption += " The file does not have the forces.";
  }
  return caption;
}

}  // namespace

const MapCell* GripMap::best() const {
  const MapCell* found = nullptr;
  for (const MapCell& cell : cells) {
    if (cell.kind != CellKind::filled) continue;
    if (!found || cell.score > found->score || (cell.score == found->score && cell.grip < found->grip)) found = &cell;
  }
  return found;
}

bool read_counts(const ReportSource& source, std::size_t vessel, sweeps::GripCounts& counts) {
  const sweeps::Variable *reason = source.result.find("reason"), *plausible = source.result.find("plausible"),
                         *antipodal = source.result.find("antipodal"), *blocked = source.result.find("blocked_mask");
  if (!reason || !plausible || !antipodal) return false;
  std::vector<ColumnOf> wanted{{reason, 0}, {plausible, 0}, {antipodal, 0}};
  if (blocked) wanted.push_back({blocked, 0});
  // kept on request alone: the reasons of implausible grips are shown only where all of them are known
  const sweeps::Variable *table = source.result.find("through_table"), *overlap = source.result.find("self_overlap");
  const sweeps::Variable* wrist = source.result.find("beyond_wrist");
  const bool knows_parts =
      (table || !source.scene.table) && (overlap || source.scene.hand.between == 0) && (wrist || !source.scene.arm);
  const std::size_t table_at = wanted.size();
  if (table) wanted.push_back({table, 0});
  const std::size_t overlap_at = wanted.size();
  if (overlap) wanted.push_back({overlap, 0});
  const std::size_t wrist_at = wanted.size();
  if (wrist) wanted.push_back({wrist, 0});
  const sweeps::Variable *not_held = source.result.find("not_held"), *effort = effort_variable(source);
  const std::size_t not_held_at = wanted.size();
  if (not_held) wanted.push_back({not_held, 0});
  const std::size_t effort_at = wanted.size();
  if (effort) wanted.push_back({effort, 0});
  read_columns(source, vessel, wanted,
               [&](std::uint64_t first, std::size_t count, const std::vector<std::vector<double>>& columns) {
                 counts.grips += count;
                 for (std::size_t i = 0; i < count; ++i) {
                   const double why = columns[0][i];
                   if (!(why >= 0 && why < static_cast<double>(counts.by_reason.size()))) continue;
                   ++counts.by_reason[static_cast<std::size_t>(why)];
                   if (why != 0) continue;
                   if (columns[1][i] == 0) {
                     const bool is_through = table && columns[table_at][i] == 1,
                                is_overlap = overlap && columns[overlap_at][i] == 1, is_beyond = wrist && columns[wrist_at][i] == 1;
                     ++counts.implausible;
                     counts.through_table += knows_parts && is_through ? 1 : 0;
                     counts.self_overlap += knows_parts && is_overlap ? 1 : 0;
                     counts.beyond_wrist += knows_parts && is_beyond ? 1 : 0;
                     counts.only_deep += knows_parts && !is_through && !is_overlap && !is_beyond ? 1 : 0;
                   }
                   counts.not_held += not_held && columns[not_held_at][i] == 1 ? 1 : 0;
                   if (effort && columns[effort_at][i] >= 0)
                     counts.least_bad = std::min(counts.least_bad, {columns[effort_at][i], sweeps::LeastBad::ENDLESS, first + i});
                   counts.antipodal += columns[2][i] == 1 ? 1 : 0;
                   counts.blocked += blocked && columns[3][i] > 0 ? 1 : 0;
                 }
               });
  return true;
}

bool has_map(const ReportSource& source) { return source.result.find("score") != nullptr; }

const sweeps::Variable* effort_variable(const ReportSource& source) { return source.result.find("worst_effort"); }

GripMap read_map(const ReportSource& source, std::size_t vessel, const sweeps::Variable* effort) {
  const auto& axes = source.plan.axes();
  const std::uint64_t points = source.plan.grips();
  GripMap map{sweeps::MapAxis(axes[sweeps::PLACE_HEIGHT], points), sweeps::MapAxis(axes[sweeps::PLACE_ROLL], points), {}};
  map.cells.resize(map.heights.cells() * map.rolls.cells());
  const sweeps::Variable *score = source.result.find("score"), *reason = source.result.find("reason"),
                         *fingers = source.result.find("fingers_used"), *force = source.result.find("peak_feedback_force");
  std::vector<ColumnOf> wanted{{score, 0}};
  const auto add = [&wanted](const sweeps::Variable* variable, std::size_t planes) {
    const std::size_t place = wanted.size();
    for (std::size_t plane = 0; variable && plane < planes; ++plane) wanted.push_back({variable, plane});
    return place;
  };
  const std::size_t reason_at = add(reason, 1), fingers_at = add(fingers, 1), effort_at = add(effort, 1),
                    force_at = add(force, scene_fills(source.scene));
  map.knows_reasons = reason != nullptr;
  map.has_fingers = fingers != nullptr;
  map.has_forces = force != nullptr;
  map.has_efforts = effort != nullptr;
  std::vector<double> heights(CHUNK_OF_GRIPS), rolls(CHUNK_OF_GRIPS);
  read_columns(source, vessel, wanted,
               [&](std::uint64_t first, std::size_t count, const std::vector<std::vector<double>>& columns) {
                 source.plan.coordinates(sweeps::PLACE_HEIGHT, first, count, heights.data());
                 source.plan.coordinates(sweeps::PLACE_ROLL, first, count, rolls.data());
                 for (std::size_t i = 0; i < count; ++i) {
                   if (reason && columns[reason_at][i] != 0) continue;
                   MapCell& cell = map.cells[map.heights.cell(heights[i]) * map.rolls.cells() + map.rolls.cell(rolls[i])];
                   if (effort) take_effort(cell, columns[effort_at][i], first + i);
                   const double value = columns[0][i];
                   if (!(value > 0 && std::isfinite(value))) {  // implausible, or not held
                     if (cell.kind == CellKind::absent) cell.kind = CellKind::hollow;
                     continue;
                   }
                   if (cell.kind == CellKind::filled && cell.score >= value) continue;
                   cell.kind = CellKind::filled;
                   cell.score = value;
                   cell.grip = first + i;
                   if (fingers) cell.fingers = columns[fingers_at][i];
                   if (!force) continue;
                   cell.peak_force = columns[force_at][i];
                   for (std::size_t k = force_at + 1; k < columns.size(); ++k)
                     cell.peak_force = std::max(cell.peak_force, columns[k][i]);
                 }
               });
  if (source.core && (!map.has_fingers || (!map.has_forces && !source.scene.tilts.empty()))) fill_by_core(source, vessel, map);
  return map;
}

MapScales map_scales(const std::vector<GripMap>& maps) {
  MapScales scales{{"best score", 0, 1, 2, 0},
                   {"fingers used", 0, FINGER_COUNT, 0, FINGER_COUNT + 1},
                   {"peak force (N)", 0, 1, 1, 0},
                   {"worst effort", 0, 1, 2, 0}};
  double low = 0, high = 0;
  if (value_range(maps, &MapCell::score, low, high)) scales.score = sweeps::score_scale(low, high);
  if (value_range(maps, &MapCell::peak_force, low, high)) {
    scales.peak_force.low = std::floor(low * 2) / 2;
    scales.peak_force.high = std::max(std::ceil(high * 2) / 2, scales.peak_force.low + 0.5);
  }
  if (value_range(maps, &MapCell::effort, low, high)) {
    scales.effort.low = std::min(std::floor(low * 20) / 20, MOST_MAPPED_EFFORT - 0.05);
    scales.effort.high = std::max(std::min(std::ceil(high * 20) / 20, MOST_MAPPED_EFFORT), scales.effort.low + 0.05);
  }
  return scales;
}

void write_maps(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripMap& map, const MapScales& scales,
                const std::vector<Candidate>& best, const std::string& id) {
  const MapCell* top = map.best();
  const std::string& name = source.scene.vessels[vessel].name;
  if (!top) {
    html.element("p", has_effort(source.scene)
                          ? "No grip of this vessel is feasible and plausible and holds, so there is nothing to map."
                          : "No grip of this vessel is feasible and plausible, so there is nothing to map.");
    return;
  }
  if (map.cells.size() == 1) {
    html.element("p", fmt::format("The sweep has one height and one roll, so there is no map: its best score is {} ({}).",
                                  shown_number(top->score, 3), cell_text(source, vessel, *top)));
    return;
  }
  FieldChart frame = map_frame(source, vessel, map, best);
  html.open("figure").open("div", {{"class", "charts"}});
  write_map(html, frame, map, &MapCell::score, scales.score,
            {id + "-score", name + ": best score over height and roll",
             fmt::format("Heat map of the best score over height and roll: {}. The highest is at {}.",
                         extent_text(map, &MapCell::score, 3), cell_text(source, vessel, *top))});
  if (map.has_fingers) {
    write_map(
        html, frame, map, &MapCell::fingers, scales.fingers,
        {id + "-fingers", name + ": fingers used over height and roll",
         fmt::format(
             "Heat map of the number of fingers that the best grip of each height and roll uses: {}; the best grip of all uses {}.",
             extent_text(map, &MapCell::fingers, 0), shown_number(top->fingers, 0))});
  }
  if (map.has_forces) {
    write_map(html, frame, map, &MapCell::peak_force, scales.peak_force,
              {id + "-force", name + ": peak feedback force over height and roll",
               fmt::format("Heat map of the largest feedback force over all tilts and fills of the best grip of each height and "
                           "roll: {} N; the best grip of all has {} N.",
                           extent_text(map, &MapCell::peak_force, 2), shown_number(top->peak_force, 2))});
  }
  if (map.has_efforts) {
    write_effort_map(html, source, vessel, frame, map, scales.effort,
                     {id + "-worst-effort", name + ": least worst effort over height and roll", ""});
  }
  html.close().element("figcaption", maps_caption(source, map)).close();
}

}  // namespace wholehand
