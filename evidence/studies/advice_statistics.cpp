// SPDX-License-Identifier: MIT
#include "evidence/studies/advice_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/charts/html.h"
#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "evidence/studies/paper_sample.h"
#include "evidence/studies/statistic_tables.h"

namespace wholehand {
namespace {

constexpr double NO_MEAN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t ADVICE_SAMPLES = 0x616476696365;  // keeps these samples from those of other experiments

struct AdviceNumber {
  const char *statistic, *name;
  double (*of)(const AdvisedOutcome&);
  const char *less, *more;  // which of the two is good is in the order: less is better for all of them
};
const std::array<AdviceNumber, 3> ADVICE_NUMBERS{{
    {"lost_share", "Lost grips", [](const AdvisedOutcome& one) { return one.lost_share(); }, "fewer", "more"},
    {"effort_mean", "Effort", [](const AdvisedOutcome& one) { return one.effort; }, "lower", "higher"},
    {"time_mean", "Time, s", [](const AdvisedOutcome& one) { return one.is_whole > 0 ? one.seconds : NO_MEAN; }, "less", "more"},
}};

constexpr std::array<const char*, 3> ADVICE_SUBJECTS{"without", "with", "difference"};

using Members = std::span<const std::size_t>;
using Means = std::array<double, 3>;  // in the order of ADVICE_SUBJECTS

bool has_both(const AdvisedPerson& person, const AdviceNumber& number) {
  return !std::isnan(number.of(person.without)) && !std::isnan(number.of(person.with));
}

// Over those who have the number in both sessions.
Means means_of(std::span<const AdvisedPerson> people, Members members, const AdviceNumber& number) {
  double without = 0, with = 0;
  std::size_t count = 0;
  for (const std::size_t member : members) {
    if (!has_both(people[member], number)) continue;
    without += number.of(people[member].without);
    with += number.of(people[member].with);
    ++count;
  }
  if (count == 0) return {NO_MEAN, NO_MEAN, NO_MEAN};
  const auto n = static_cast<double>(count);
  return {without / n, with / n, (with - without) / n};
}

std::vector<double> all_means(std::span<const AdvisedPerson> people, Members members) {
  std::vector<double> values;
  for (const AdviceNumber& number : ADVICE_NUMBERS)
    for (const double mean : means_of(people, members, number)) values.push_back(mean);
  return values;
}

std::vector<double> column(const std::vector<std::vector<double>>& samples, std::size_t k) {
  std::vector<double> values;
  for (const std::vector<double>& sample : samples)
    if (!std::isnan(sample[k])) values.push_back(sample[k]);
  return values;
}

// Efforts and shares as they are, times in s.
std::string size_text(double value) { return fmt::format("{:.3f}", std::abs(value)); }

std::string advice_sentence(const AdviceNumber& number, const StudyRow& difference) {
  const auto& [low, high] = difference.interval;
  if (!(low <= high)) return fmt::format("{}: there are too few people to say.", number.name);
  const std::string interval = fmt::format("({:.3f} to {:.3f})", low, high);
  if (low <= 0 && high >= 0)
    return fmt::format("{}: no difference is seen, {:.3f} {}. Here advice does not help.", number.name, difference.value, interval);
  const bool is_less = difference.value < 0;
  return fmt::format("{}: {} {} with advice, {}. Here advice {}.", number.name, size_text(difference.value),
                     is_less ? number.less : number.more, interval, is_less ? "helps" : "costs");
}

std::string advice_cell(const StudyRow& row) {
  if (std::isnan(row.value)) return "-";
  std::string text = fmt::format("{:.3f}", row.value);
  if (row.interval.low <= row.interval.high) text += fmt::format(" ({:.3f} to {:.3f})", row.interval.low, row.interval.high);
  return text;
}

TextTable advice_table(std::span<const StudyRow> rows) {
  TextTable table{{"number", "without", "with", "difference"}};
  for (const AdviceNumber& number : ADVICE_NUMBERS) {
    std::vector<std::string> line{number.name};
    for (const char* subject : ADVICE_SUBJECTS)
      for (const StudyRow& row : rows)
        if (row.statistic == number.statistic && row.subject == subject) line.push_back(advice_cell(row));
    table.push_back(std::move(line));
  }
  return table;
}

void write_advice_table(MarkupWriter& html, std::span<const StudyRow> rows) {
  const TextTable lines = advice_table(rows);
  HtmlTable table(html, "The same people with and without advice", lines.front(), {});
  for (std::size_t k = 1; k < lines.size(); ++k) {
    std::vector<std::string> cells = lines[k];
    for (std::size_t c = 1; c < cells.size(); ++c) cells[c] = page_text(cells[c]);
    table.row(cells);
  }
  table.end();
}

}  // namespace

std::vector<StudyRow> advice_rows(std::span<const AdvisedPerson> people, std::uint64_t seed, int resamples, int threads) {
  std::vector<std::size_t> everybody(people.size());
  std::iota(everybody.begin(), everybody.end(), std::size_t{0});
  const std::vector<double> values = all_means(people, everybody);
  std::vector<std::vector<double>> samples(people.size() < 2 ? 0 : static_cast<std::size_t>(resamples));
  in_parallel(samples.size(), threads, [&](std::size_t k) {
    std::uint64_t state = mixed_bits(mixed_bits(seed ^ ADVICE_SAMPLES) + k);
    std::vector<std::size_t> members(people.size());
    for (std::size_t& member : members) member = draw_below(people.size(), state);
    samples[k] = all_means(people, members);
  });
  std::vector<StudyRow> rows;
  for (std::size_t k = 0; k < values.size(); ++k) {
    StudyRow row;
    row.experiment = "advice";
    row.vessel = ALL_VESSELS;
    row.statistic = ADVICE_NUMBERS[k / ADVICE_SUBJECTS.size()].statistic;
    row.subject = ADVICE_SUBJECTS[k % ADVICE_SUBJECTS.size()];
    row.value = values[k];
    row.count.people = static_cast<std::uint64_t>(std::count_if(people.begin(), people.end(), [&](const AdvisedPerson& one) {
      return has_both(one, ADVICE_NUMBERS[k / ADVICE_SUBJECTS.size()]);
    }));
    if (!std::isnan(row.value)) row.interval = percentile_interval(column(samples, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::string> advice_sentences(std::span<const StudyRow> rows) {
  std::vector<std::string> sentences;
  for (const AdviceNumber& number : ADVICE_NUMBERS)
    for (const StudyRow& row : rows)
      if (row.statistic == number.statistic && row.subject == ADVICE_SUBJECTS[2]) sentences.push_back(advice_sentence(number, row));
  return sentences;
}

StudySection advice_section(std::vector<StudyRow> rows) {
  StudySection section;
  section.id = "advice";
  section.title = "Advice";
  section.words = {
      "Each person does the mixing task twice with the same numbers of chance: as planned, and with advice. With advice the person "
      "looks at the advised grip beside each vessel, and then aims at it as well, or as badly, as at any other. The effort is the "
      "mean over a session's grasps of the largest effort that each came to. The intervals are of 95 % for the mean of all people; "
      "the difference is taken person by person."};
  for (std::string& sentence : advice_sentences(rows)) section.words.push_back(std::move(sentence));
  section.rows = std::move(rows);
  section.write = write_advice_table;
  return section;
}

std::string advice_summary(std::span<const StudyRow> rows) {
  std::string text = plain_table(advice_table(rows), 1) + "\n";
  for (const std::string& sentence : advice_sentences(rows)) text += sentence + "\n";
  return text;
}

}  // namespace wholehand
