// SPDX-License-Identifier: MIT
// Statistics and their values in words for people.
#pragma once

#include <span>
#include <string>

#include "evidence/studies/row.h"

namespace wholehand {

// "response_time_mean" becomes "response time, mean (s)". An unknown statistic is its name without underscores.
std::string statistic_words(const std::string& statistic);

// The unit of a statistic's value in the files, as in a result: "s", "N", "m", "N-1" (per newton), "1".
std::string statistic_unit(const std::string& statistic);

// A value of this statistic: "0.106", "8.2 %", "-" if there is none.
std::string statistic_value(const std::string& statistic, double value);

// The row's interval: "0.08 to 0.13", "-" if there is none.
std::string interval_words(const StudyRow& row);

// "yes", "no", or "-" if there is nothing to compare.
std::string inside_words(const StudyRow& row);

// "31 of 40 statistics of the paper are inside their intervals.", or that there is none to compare.
std::string inside_sentence(std::span<const StudyRow> rows);

}  // namespace wholehand
