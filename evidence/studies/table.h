// SPDX-License-Identifier: MIT
// study.csv and study.nc.
#pragma once

#include <span>
#include <string>

#include "core/scene.h"
#include "evidence/studies/options.h"
#include "evidence/studies/row.h"

namespace wholehand {

// A row for each statistic; absent values are empty. Numbers are exact, to the bit.
std::string study_csv(std::span<const StudyRow> rows);

// The same rows, with the request. Throws Error (failure); then no file is left.
void write_study_dataset(const std::string& path, const Scene& scene, const StudyOptions& options, std::span<const StudyRow> rows);

}  // namespace wholehand
