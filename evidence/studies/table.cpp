// SPDX-License-Identifier: MIT
#include "evidence/studies/table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "base/files/csv.h"
#include "base/files/files.h"
#include "base/system/version.h"
#include "evidence/studies/output.h"
#include "evidence/studies/statistic_words.h"
#include "evidence/studies/words.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/result_definition.h"

namespace wholehand {
namespace {

std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

template <class Number>
std::string cell(const std::optional<Number>& value) {
  return value ? fmt::format("{}", *value) : "";
}

template <class Number>
double number(const std::optional<Number>& value) {
  return value ? static_cast<double>(*value) : std::nan("");
}

// A correlation has a word beside its number.
std::string correlation_word(const StudyRow& row) {
  const bool is_correlation = row.statistic.starts_with("pearson_") || row.statistic.starts_with("point_biserial_") ||
                              row.statistic.starts_with("correlation_");
  return is_correlation ? word_of_correlation(row.value) : "";
}

void define_study(const std::string& path, const Scene& scene, const StudyOptions& options, std::span<const StudyRow> rows) {
  sweeps::ResultDefinition file(path, STUDY_REMEDY);
  file.dimension("row", rows.size());
  file.text(NC_GLOBAL, "Conventions", "CF-1.8");
  file.text(NC_GLOBAL, "title", "study of people with " + (scene.name.empty() ? std::string("a scene") : scene.name));
  file.text(NC_GLOBAL, "program", "wholehand");
  file.text(NC_GLOBAL, "version", version());
  file.text(NC_GLOBAL, "scene", scene.text);
  const StudyPeople& people = options.people;
  const std::pair<const char*, std::uint64_t> counts[] = {{"people_contacts", people.contacts},
                                                          {"people_forces", people.forces},
                                                          {"people_sessions", people.sessions},
                                                          {"people_advice", people.advice}};
  for (const auto& [name, count] : counts) file.text(NC_GLOBAL, name, fmt::format("{}", count));
  file.text(NC_GLOBAL, "seed", fmt::format("{}", options.seed));
  file.text(NC_GLOBAL, "resamples", fmt::format("{}", options.resamples));
  const auto texts = [&](const char* name, const char* long_name, const std::function<std::string(const StudyRow&)>& of) {
    sweeps::ResultDefinition::Names values;
    for (const StudyRow& row : rows) values.push_back(of(row));
    file.strings(name, {"row"}, long_name, values);
  };
  const auto numbers = [&](const char* name, const char* units, const char* long_name,
                           const std::function<double(const StudyRow&)>& of) {
    std::vector<double> values;
    for (const StudyRow& row : rows) values.push_back(of(row));
    return file.doubles(name, {"row"}, units, long_name, values);
  };
  // rows have different units, so the attribute `units` cannot say them
  const auto measured = [&](const char* name, const char* long_name, const std::function<double(const StudyRow&)>& of) {
    file.text(numbers(name, "", long_name, of), "ancillary_variables", "unit");
  };
  texts("experiment", "experiment", [](const StudyRow& row) { return row.experiment; });
  texts("pose", "pose", [](const StudyRow& row) { return row.pose; });
  texts("vessel", "vessel, or all of the paper's sample", [](const StudyRow& row) { return row.vessel; });
  texts("statistic", "statistic", [](const StudyRow& row) { return row.statistic; });
  texts("subject", "what the statistic is of, as a point of the hand; empty: of all",
        [](const StudyRow& row) { return row.subject; });
  measured("value", "value of the population", [](const StudyRow& row) { return row.value; });
  measured("low", "lower end of the 95 % interval at the paper's sample size",
           [](const StudyRow& row) { return row.interval.low; });
  measured("high", "upper end of it", [](const StudyRow& row) { return row.interval.high; });
  measured("paper", "the paper's value, where it is known", [](const StudyRow& row) { return number(row.paper); });
  std::vector<int> inside;
  for (const StudyRow& row : rows) inside.push_back(row.inside() ? (*row.inside() ? 1 : 0) : sweeps::MISSING);
  file.integers("inside", {"row"}, "", "whether the paper's value is in the interval", inside, {{"outside", "inside"}, true});
  texts("word", "the correlation in the paper's words", correlation_word);
  texts("unit", "unit of value, low, high, paper and off", [](const StudyRow& row) { return statistic_unit(row.statistic); });
  numbers("people", "1", "number of people behind the value", [](const StudyRow& row) { return number(row.count.people); });
  numbers("grasps", "1", "number of grasps behind the value", [](const StudyRow& row) { return number(row.count.grasps); });
  measured("off", "nearer end of the interval minus the paper's value; 0 inside",
           [](const StudyRow& row) { return number(row.off()); });
  file.finish({});
}

std::uint64_t dataset_room(const Scene& scene, std::span<const StudyRow> rows) {
  constexpr std::uint64_t OF_ROW = 9 * 8 + 7 * (16 + 64), HEAD = 32 << 10;
  return HEAD + rows.size() * OF_ROW + 2 * scene.text.size();
}

}  // namespace

std::string study_csv(std::span<const StudyRow> rows) {
  std::string text = fmt::format("{},unit,people,grasps,off\n", STUDY_CSV_START);
  for (const StudyRow& row : rows) {
    const std::optional<bool> inside = row.inside();
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.experiment, row.pose, csv_text(row.vessel),
                        row.statistic, row.subject, cell(row.value), cell(row.interval.low), cell(row.interval.high),
                        cell(row.paper), inside ? (*inside ? "1" : "0") : "", statistic_unit(row.statistic), cell(row.count.people),
                        cell(row.count.grasps), cell(row.off()));
  }
  return text;
}

void write_study_dataset(const std::string& path, const Scene& scene, const StudyOptions& options, std::span<const StudyRow> rows) {
  // HDF5 crashes if the disk fills up while it writes
  check_room(path, dataset_room(scene, rows), STUDY_REMEDY);
  try {
    define_study(path, scene, options, rows);
  } catch (...) {
    std::remove(path.c_str());
    throw;
  }
}

}  // namespace wholehand
