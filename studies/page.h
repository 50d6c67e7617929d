// SPDX-License-Identifier: MIT
// study.html: one page that shows what a study found.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "studies/contact_plan.h"
#include "studies/options.h"
#include "studies/row.h"

namespace wholehand {

// Self-contained HTML, well-formed XML too.
std::string study_page(const Scene& scene, const StudyOptions& options, const ContactPlan& plan, std::span<const StudyRow> rows);

}  // namespace wholehand
