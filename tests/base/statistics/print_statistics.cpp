// SPDX-License-Identifier: MIT
// Statistics of made data, for against_scipy_test.py: a JSON list of calls from standard input, and a list of their answers to
// standard output. A number that is none is null in both.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/charts/box_plot.h"
#include "base/statistics/anova.h"
#include "base/statistics/correlation.h"
#include "base/statistics/distributions.h"
#include "base/statistics/given_data_indices.h"
#include "base/statistics/interval.h"
#include "base/statistics/logistic.h"
#include "base/statistics/moments.h"
#include "base/statistics/resample.h"
#include "base/statistics/running_correlation.h"
#include "base/statistics/sobol_indices.h"
#include "evidence/studies/contact_tally.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

std::vector<double> doubles_in(const Json& list) {
  std::vector<double> numbers;
  for (const Json& number : list) numbers.push_back(number.is_null() ? std::nan("") : number.get<double>());
  return numbers;
}

std::vector<char> answers_of(const Json& list) {
  std::vector<char> answers;
  for (const Json& answer : list) answers.push_back(answer.get<bool>() ? 1 : 0);
  return answers;
}

std::vector<std::vector<double>> groups_of(const Json& lists) {
  std::vector<std::vector<double>> groups;
  for (const Json& list : lists) groups.push_back(doubles_in(list));
  return groups;
}

Json written(const Interval& interval) { return {interval.low, interval.high}; }

Json written(const Correlation& correlation, std::size_t pairs) {
  constexpr std::array<const char*, 6> LACKS{"none", "fewer_than_3", "one_x", "one_y", "never", "always"};
  Json answer{{"lack", LACKS[static_cast<std::size_t>(correlation.lack)]}};
  if (!correlation.r) return answer;
  answer["r"] = *correlation.r;
  answer["p"] = correlation_p(*correlation.r, pairs);
  answer["interval"] = written(correlation_interval(*correlation.r, pairs));
  return answer;
}

Json written(const SensitivityIndex& index) { return {{"first", index.first}, {"interval", written(index.interval)}}; }

RunningCorrelation running_of(const std::vector<double>& x, const std::vector<double>& y) {
  RunningCorrelation running;
  for (std::size_t i = 0; i < x.size(); ++i) running.add(x[i], y[i]);
  return running;
}

// ---- what may be called ----

Json call_pearson(const Json& call) {
  const std::vector<double> x = doubles_in(call["x"]), y = doubles_in(call["y"]);
  const RunningCorrelation running = running_of(x, y);
  return {{"whole", written(pearson(x, y), x.size())},
          {"running", written(running.pearson(), running.pairs())},
          {"mean_y", running.mean_y()}};
}

Json call_point_biserial(const Json& call) {
  const std::vector<double> x = doubles_in(call["x"]);
  const std::vector<char> yes = answers_of(call["yes"]);
  const RunningCorrelation running = running_of(x, {yes.begin(), yes.end()});
  return {{"whole", written(point_biserial(x, yes), x.size())}, {"running", written(running.point_biserial(), running.pairs())}};
}

Json call_moments(const Json& call) {
  const std::vector<double> values = doubles_in(call["values"]);
  return {{"mean", mean_of(values)}, {"deviation", deviation_of(values)}, {"varies", varies(values)}};
}

Json call_anova(const Json& call) {
  const auto result = one_way_anova(groups_of(call["groups"]));
  if (!result) return nullptr;
  return {{"f", result->f}, {"p", result->p}, {"between", result->between}, {"within", result->within}, {"share", result->share}};
}

Json call_logistic(const Json& call) {
  const LogisticModel model =
      fit_logistic_model(doubles_in(call["terms"]), call["count"].get<std::size_t>(), answers_of(call["success"]));
  Json intervals = Json::array();
  for (std::size_t k = 0; k < model.coefficients.size(); ++k) intervals.push_back(written(model.interval(k)));
  return {{"coefficients", model.coefficients}, {"errors", model.errors},
          {"intercept", model.intercept},       {"intervals", intervals},
          {"is_fitted", model.is_fitted},       {"has_ridge", model.has_ridge}};
}

Json call_incomplete_beta(const Json& call) {
  return incomplete_beta(call["a"].get<double>(), call["b"].get<double>(), call["x"].get<double>());
}

Json call_f_tail(const Json& call) {
  return f_tail(call["f"].get<double>(), call["above"].get<double>(), call["below"].get<double>());
}

Json call_percentiles(const Json& call) {
  const std::vector<double> ascending = doubles_in(call["ascending"]);
  Json percentiles = Json::array();
  for (const double share : doubles_in(call["shares"])) percentiles.push_back(percentile_of(ascending, share));
  return percentiles;
}

Json call_percentile_interval(const Json& call) { return written(percentile_interval(doubles_in(call["values"]))); }

Json call_share(const Json& call) {
  const Share share = share_of(call["yes"].get<std::size_t>(), call["of"].get<std::size_t>());
  return {{"share", share.share}, {"interval", written(share.interval)}};
}

Json call_correlation(const Json& call) {
  const auto r = call["r"].get<double>();
  const auto pairs = call["pairs"].get<std::size_t>();
  return {{"p", correlation_p(r, pairs)}, {"interval", written(correlation_interval(r, pairs))}};
}

// Means of samples.
Json call_resampled(const Json& call) {
  const std::vector<double> values = doubles_in(call["values"]);
  const auto mean = [&](std::span<const std::size_t> members) {
    double sum = 0;
    for (const std::size_t member : members) sum += values[member];
    return sum / static_cast<double>(members.size());
  };
  const auto sample = call["sample"].get<std::size_t>();
  const auto resamples = call["resamples"].get<int>();
  const auto seed = call["seed"].get<std::uint64_t>();
  return {{"values", resampled_values(values.size(), sample, resamples, seed, mean)},
          {"interval", written(resampled_interval(values.size(), sample, resamples, seed, mean))}};
}

Json call_sobol(const Json& call) {
  Json all = Json::array();
  for (const SensitivityIndex& index :
       first_order_indices(doubles_in(call["a"]), doubles_in(call["b"]), groups_of(call["mixed"]), 100, 1))
    all.push_back(written(index));
  return all;
}

// `inputs` and `outputs` have a list for each entry.
Json call_given_data(const Json& call) {
  const auto inputs = groups_of(call["inputs"]), outputs = groups_of(call["outputs"]);
  GivenDataIndices indices(inputs[0].size(), outputs[0].size());
  for (std::size_t n = 0; n < inputs.size(); ++n) indices.add(inputs[n], outputs[n]);
  Json all = Json::array();
  for (std::size_t k = 0; k < indices.outputs(); ++k) {
    all.push_back(Json::array());
    for (std::size_t i = 0; i < indices.inputs(); ++i) all.back().push_back(written(indices.first_order(k, i)));
  }
  return all;
}

Json call_tally(const Json& call) {
  ContactTally tally;
  for (const Json& made : call["grasps"]) {
    ContactGrasp grasp;
    grasp.height = made["height"].get<double>();
    grasp.distance = made["distance"].get<double>();
    grasp.touch_mask = made["touch"].get<std::uint32_t>();
    grasp.tip_mask = made["tip"].get<std::uint32_t>();
    grasp.finger_mask = made["finger"].get<std::uint32_t>();
    grasp.inner_mask = made["inner"].get<std::uint32_t>();
    grasp.used_mask = made["used"].get<std::uint32_t>();
    grasp.is_held = made["held"].get<bool>();
    grasp.is_plausible = made["plausible"].get<bool>();
    tally.add(grasp);
  }
  Json all = Json::array();
  const std::vector<double> values = tally.values();
  for (std::size_t k = 0; k < values.size(); ++k)
    all.push_back({contact_statistics()[k].name, contact_statistics()[k].subject, values[k]});
  return all;
}

Json call_box(const Json& call) {
  const Box box = box_of(doubles_in(call["values"]));
  return {{"numbers", {box.low, box.lower_quartile, box.median, box.upper_quartile, box.high}}, {"outliers", box.outliers}};
}

const std::map<std::string, std::function<Json(const Json&)>> CALLS{
    {"pearson", call_pearson},
    {"point_biserial", call_point_biserial},
    {"moments", call_moments},
    {"anova", call_anova},
    {"logistic", call_logistic},
    {"incomplete_beta", call_incomplete_beta},
    {"f_tail", call_f_tail},
    {"percentiles", call_percentiles},
    {"share", call_share},
    {"percentile_interval", call_percentile_interval},
    {"correlation", call_correlation},
    {"resampled", call_resampled},
    {"sobol", call_sobol},
    {"given_data", call_given_data},
    {"tally", call_tally},
    {"box", call_box},
};

}  // namespace
}  // namespace wholehand

int main() {
  try {
    nlohmann::json answers = nlohmann::json::array();
    for (const nlohmann::json& call : nlohmann::json::parse(std::cin))
      answers.push_back(wholehand::CALLS.at(call["call"].get<std::string>())(call));
    std::cout << answers << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "print_statistics: %s\n", error.what());
    return 1;
  }
}
