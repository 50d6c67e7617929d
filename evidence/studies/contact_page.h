// SPDX-License-Identifier: MIT
// The page's part on the experiment of contacts.
#pragma once

#include <span>

#include "evidence/studies/contact_plan.h"
#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// Adds the words about the samples, a section for each pose, and one on the meaning of the words. `rows`: of contacts alone.
void add_contact_sections(StudyPage& page, const ContactPlan& plan, std::span<const StudyRow> rows);

}  // namespace wholehand
