// SPDX-License-Identifier: MIT
#include "evidence/check/error_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/files/csv.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "evidence/check/convergence.h"

namespace wholehand {
namespace {

constexpr const char* ERROR_NAMES[ERROR_QUANTITIES] = {"separation_um",   "posed_um",      "proxy_um",     "closure",     "gap_um",
                                                       "volume_ml",       "com_um",        "torque_Nm",    "feedback_N",  "hold_N",
                                                       "table_depth_um",  "self_depth_um", "worst_effort", "tips_effort", "push",
                                                       "friction_needed", "effort_bracket"};

std::string error_number_cell(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

template <class Count>
std::string error_count_cell(const Count& count) {
  return count ? fmt::format("{}", *count) : "";
}

std::string grip_time_text(double seconds) { return fmt::format("{:.3g} us", seconds * 1e6); }

// "3.2 um", "0.41 nm": three digits in the unit that suits.
std::string length_error_text(double um) {
  if (um == 0) return "0";
  if (um < 0.1) return fmt::format("{:.3g} nm", um * 1e3);
  if (um < 1000) return fmt::format("{:.3g} um", um);
  return fmt::format("{:.3g} mm", um * 1e-3);
}

std::string force_error_text(double newtons) {
  if (newtons == 0) return "0";
  if (newtons < 1e-4) return fmt::format("{:.3g} uN", newtons * 1e6);
  if (newtons < 1) return fmt::format("{:.3g} mN", newtons * 1e3);
  return fmt::format("{:.3g} N", newtons);
}

using ErrorOf = double (ErrorRow::*)() const;
using ErrorText = std::string (*)(double);

// The fastest, or the first of the table that is equally fast within the spread of the runs, because variants come after what they vary.
const ErrorRow* fastest_under(const std::vector<ErrorRow>& rows, ErrorOf error, double limit) {
  const ErrorRow* best = nullptr;
  for (const ErrorRow& row : rows)
    if (!row.flips_too_often() && (row.*error)() < limit && (!best || row.seconds_per_grip < best->seconds_per_grip)) best = &row;
  if (!best) return nullptr;
  for (const ErrorRow& row : rows)
    if (!row.flips_too_often() && (row.*error)() < limit &&
        row.seconds_per_grip - best->seconds_per_grip <= std::max(row.spread, best->spread))
      return &row;
  return best;
}

void add_fastest(std::string& text, const std::vector<ErrorRow>& rows, ErrorOf error, const std::vector<double>& limits,
                 ErrorText show) {
  for (const double limit : limits) {
    const ErrorRow* row = fastest_under(rows, error, limit);
    text += row ? fmt::format("| {} | {} | {} | {} |\n", show(limit), row->variant.name, grip_time_text(row->seconds_per_grip),
                              show((row->*error)()))
                : fmt::format("| {} | none | | |\n", show(limit));
  }
}

// One line of the fitted orders: rows of an axis and side, errors by `value`.
void add_fitted_order(std::string& text, const std::vector<ErrorRow>& rows, SweptAxis axis, const std::string& what,
                      const std::string& by, const std::string& theory, double floor,
                      const std::function<double(const ErrorRow&)>& value) {
  std::vector<double> steps, errors;
  for (const ErrorRow& row : rows) {
    if (row.variant.axis != axis || !row.variant.on_core || row.variant.precision != Precision::full) continue;
    const double error = value(row);
    if (!(error > floor)) continue;  // rounding, or nothing
    steps.push_back(row.variant.step);
    errors.push_back(error);
  }
  const double order = fitted_order(steps, errors);
  if (std::isnan(order)) return;
  text += fmt::format("| {} | {} | {:.2f} | {} | {} |\n", what, by, order, errors.size(), theory);
}

std::string fitted_orders(const std::vector<ErrorRow>& rows) {
  std::string text;
  const auto figure = [](ErrorQuantity quantity, double ErrorFigures::*which) {
    return [quantity, which](const ErrorRow& row) { return row.errors[quantity].*which; };
  };
  add_fitted_order(text, rows, SweptAxis::lattice, "distance at random points, median", "spacing of the grid",
                   "2, away from creases", 0, [](const ErrorRow& row) { return row.distance.median; });
  add_fitted_order(text, rows, SweptAxis::lattice, "distance at random points, maximum", "spacing of the grid", "1, at creases", 0,
                   [](const ErrorRow& row) { return row.distance.max; });
  add_fitted_order(text, rows, SweptAxis::lattice, "gap, median", "spacing of the grid", "2, where no crease is near", 0,
                   figure(ERROR_GAP, &ErrorFigures::median));
  add_fitted_order(text, rows, SweptAxis::tolerance, "gap, maximum", "stop tolerance", "1", 0,
                   figure(ERROR_GAP, &ErrorFigures::max));
  add_fitted_order(text, rows, SweptAxis::gap_table, "closure, maximum", "step of the gap table", "2", 0,
                   figure(ERROR_CLOSURE, &ErrorFigures::max));
  add_fitted_order(text, rows, SweptAxis::effort, "worst effort, maximum", "tolerance of efforts",
                   "no fixed order: never more than the tolerance", 0, figure(ERROR_EFFORT, &ErrorFigures::max));
  add_fitted_order(text, rows, SweptAxis::points, "volume, maximum", "1 / points of the liquid",
                   "no fixed order: faster than any power", 1e-7, figure(ERROR_VOLUME, &ErrorFigures::max));
  return text;
}

// "a (3), b (1)": the variants that have a count, with it.
std::string counted_variants(const std::vector<ErrorRow>& rows, const std::function<std::uint64_t(const ErrorRow&)>& count) {
  std::string text;
  for (const ErrorRow& row : rows)
    if (const std::uint64_t n = count(row); n > 0) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", row.variant.name, n);
  return text;
}

// What the errors alone do not show: grips that were not compared, and answers on one side alone.
std::string flip_lines(const std::vector<ErrorRow>& rows, const ErrorContext& context) {
  std::string text;
  std::uint64_t compared = 0;
  for (const ErrorRow& row : rows) compared = std::max(compared, row.errors[ERROR_GAP].compared);
  if (compared > 0 && compared < 1000)
    text += fmt::format("\nWith so few grips compared ({}), the 99.9th percentile is the largest error.\n", compared);
  std::string nothing;
  for (const ErrorRow& row : rows)
    if (row.variant.answers_the_question() && row.errors[ERROR_GAP].compared == 0)
      nothing += (nothing.empty() ? "" : ", ") + row.variant.name;
  if (!nothing.empty()) text += "\nThese variants are not chosen, as none of their grips could be compared: " + nothing + ".\n";
  const std::string often =
      counted_variants(rows, [](const ErrorRow& row) { return row.flips_too_often() ? *row.feasible_flips : 0; });
  if (!often.empty())
    text +=
        "\nThese variants are not chosen, as more than 1 grip in 1,000 is feasible on one side only (number of grips): " + often +
        ".\n";
  if (context.states == 0) return text;
  const std::string hold = counted_variants(rows, [](const ErrorRow& row) { return row.hold_flips; });
  text +=
      "\nThe hold force is finite on one side only (number of grips; more than 1 in 1,000 counts as an infinite error of force): " +
      (hold.empty() ? "nowhere" : hold) + ".\n";
  return text;
}

// Times of the other questions beside that of the same side.
std::string left_out_times(const std::vector<ErrorRow>& rows) {
  std::string text;
  for (const ErrorRow& row : rows) {
    if (row.variant.left_out.empty()) continue;
    const auto own = std::find_if(rows.begin(), rows.end(), [&](const ErrorRow& other) {
      return other.variant.on_core == row.variant.on_core && other.variant.precision == row.variant.precision &&
             other.variant.threads == row.variant.threads;
    });
    if (own == rows.end() || own->variant.axis != SweptAxis::none) continue;
    text += fmt::format("| {} | {} | {} | {:.2f} |\n", row.variant.name, row.variant.left_out, grip_time_text(row.seconds_per_grip),
                        row.seconds_per_grip / own->seconds_per_grip);
  }
  return text;
}

std::string liquid_times(const std::vector<ErrorRow>& rows) {
  std::string text;
  for (const ErrorRow& row : rows) {
    if (row.variant.axis != SweptAxis::points || !(row.liquid_seconds > 0)) continue;
    text += fmt::format("| {} | {} | {:.3g} mL | {} |\n", row.variant.options.quadrature_points, grip_time_text(row.liquid_seconds),
                        row.errors[ERROR_VOLUME].max, length_error_text(row.errors[ERROR_COM].max));
  }
  return text;
}

std::string effort_times(const std::vector<ErrorRow>& rows) {
  const auto figure = [](const ErrorFigures& figures) {
    return figures.compared > 0 ? fmt::format("{:.2g}", figures.max) : std::string();
  };
  std::string text;
  for (const ErrorRow& row : rows)
    if (row.variant.axis == SweptAxis::effort)
      text += fmt::format("| {} | {} | {} | {} |\n", row.variant.name, grip_time_text(row.seconds_per_grip),
                          figure(row.errors[ERROR_EFFORT]), figure(row.errors[ERROR_EFFORT_BRACKET]));
  return text;
}

}  // namespace

std::string error_csv(const std::vector<ErrorRow>& rows, const ErrorContext& context) {
  std::string csv =
      "variant,backend,precision,threads,sdf,resolution,storage_bits,tolerance,effort_tolerance,points,left_out,"
      "seconds_per_grip,spread,memory_bytes";
  for (const char* name : ERROR_NAMES) csv += fmt::format(",{0}_median,{0}_p999,{0}_max,{0}_worst_grip", name);
  csv += ",touch_flips,touch_flips_outside_margin,feasible_flips,device,driver,seed\n";
  for (const ErrorRow& row : rows) {
    const ErrorVariant& v = row.variant;
    const bool lattice = v.options.lattice_samples > 0;
    append_formatted(csv, "{},{},{},{},{},{},{},{:.9g},{},{},{},{:.6g},{:.6g},{}", csv_text(v.name), v.on_core ? "core" : "vulkan",
                     v.precision == Precision::single ? "float" : "double", v.on_core ? fmt::format("{}", v.threads) : "",
                     lattice ? "grid" : "outline", lattice ? fmt::format("{}", v.options.lattice_samples) : "",
                     lattice ? fmt::format("{}", v.options.lattice_bits) : "", v.stop_tolerance(),
                     context.efforts ? fmt::format("{:.9g}", v.effort_tolerance()) : "",
                     context.states > 0 ? fmt::format("{}", v.options.quadrature_points) : "", csv_text(v.left_out),
                     row.seconds_per_grip, row.spread, row.memory_bytes);
    for (const ErrorFigures& error : row.errors)
      append_formatted(csv, ",{},{},{},{}", error_number_cell(error.median), error_number_cell(error.p999),
                       error_number_cell(error.max), error.worst);
    append_formatted(csv, ",{},{},{},{},{},{}\n", error_count_cell(row.touch_flips), error_count_cell(row.touch_flips_outside),
                     error_count_cell(row.feasible_flips), csv_text(row.device), csv_text(row.driver), context.seed);
  }
  return csv;
}

std::string error_grips_csv(const std::vector<std::vector<GripInput>>& grips) {
  std::string csv = "vessel,index,height_m,azimuth_rad,obliquity_rad,roll_rad,offset_m,hand_scale\n";
  for (std::size_t v = 0; v < grips.size(); ++v) {
    for (std::size_t i = 0; i < grips[v].size(); ++i) {
      const GripInput& g = grips[v][i];
      append_formatted(csv, "{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", v, i, g.height, g.azimuth, g.obliquity,
                       g.roll, g.offset, g.hand_scale);
    }
  }
  return csv;
}

std::vector<const ErrorRow*> pareto_front(const std::vector<ErrorRow>& rows, ErrorOf error) {
  std::vector<const ErrorRow*> ordered;
  for (const ErrorRow& row : rows)
    if (!row.flips_too_often() && std::isfinite((row.*error)()) && row.seconds_per_grip > 0) ordered.push_back(&row);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const ErrorRow* a, const ErrorRow* b) { return a->seconds_per_grip < b->seconds_per_grip; });
  std::vector<const ErrorRow*> front;
  for (const ErrorRow* row : ordered)
    if (front.empty() || (row->*error)() < (front.back()->*error)()) front.push_back(row);
  return front;
}

std::string error_report(const std::vector<ErrorRow>& rows, const ErrorContext& context) {
  std::string text = fmt::format("# Error against run time: {}\n\n", context.scene);
  text += fmt::format("{} ({}), wholehand {}, seed {}{}.\n", context.device, context.driver, context.version, context.seed,
                      context.quick ? ", quick" : "");
  text += fmt::format("{} of {}, {} feasible (of these {} not compared){}; {}.\n", counted(context.grips, "random grip"),
                      counted(context.vessels, "vessel"), readable_number(context.feasible),
                      counted(context.grazing, "grazes and is", "graze and are"),
                      context.states > 0 ? fmt::format(", {} of fill and tilt each", counted(context.states, "state")) : "",
                      counted(rows.size(), "variant"));
  text += fmt::format("Reference: core double, exact outline, stop tolerance 1e-12 m, 64 points of the liquid{}.\n",
                      context.efforts ? fmt::format(", efforts to {:g}", reference_options().effort_tolerance) : "");
  for (const std::string& note : context.notes) text += fmt::format("Note: {}.\n", note);
  text +=
      "\n## The fastest variant under an error\n\nThe error of lengths is the largest 99.9th percentile among separation, posed "
      "joints, proxies, gap and center of mass.\nThe error of forces is the largest among feedback and hold force. The time is the "
      "kernel time of one grip.\nIf the spread of the runs does not separate some variants, the first of them is named.\n\n"
      "| error under | variant | time per grip | its error |\n|---|---|---|---|\n";
  add_fastest(text, rows, &ErrorRow::length_error, {1, 10, 100}, length_error_text);
  if (context.states > 0) add_fastest(text, rows, &ErrorRow::force_error, {1e-3, 10e-3}, force_error_text);
  text += flip_lines(rows, context);
  text +=
      "\n## Observed orders of convergence\n\nCore double; error = C step^order.\n\n| error | by | order | rows | theory "
      "|\n|---|---|---|---|---|\n";
  text += fitted_orders(rows);
  if (const std::string times = left_out_times(rows); !times.empty()) {
    text +=
        "\n## Left out, left in\n\nThe ratio compares the time with the time of the unchanged scene, on the same side.\n\n| "
        "variant | left out (+: left in) | time per grip | ratio |\n|---|---|---|---|\n" +
        times;
  }
  if (const std::string efforts = effort_times(rows); !efforts.empty()) {
    text +=
        "\n## Efforts\n\nBoth figures are relative. The difference is that of the worst effort from the reference's. A bracket is "
        "the distance between the two bounds of a state's effort; a device does not keep it.\n\n"
        "| variant | time per grip | largest difference | widest bracket |\n|---|---|---|---|\n" +
        efforts;
  }
  if (const std::string liquid = liquid_times(rows); !liquid.empty()) {
    text +=
        "\n## The liquid\n\nThe liquid is prepared once per vessel, so it is not part of a grip's time.\n\n"
        "| points per piece | time per state, core, one thread | largest volume error | largest center of mass error "
        "|\n|---|---|---|---|\n" +
        liquid;
  }
  return text;
}

}  // namespace wholehand
