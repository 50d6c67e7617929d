// SPDX-License-Identifier: MIT
// Parts of the page of trials, each a section or a figure.
#pragma once

#include "base/charts/markup.h"
#include "evidence/trials/page_source.h"

namespace wholehand {

void write_trial_bars(MarkupWriter& html, const TrialPageSource& source);
void write_trial_setup(MarkupWriter& html, const TrialPageSource& source);
void write_trial_successes(MarkupWriter& html, const TrialPageSource& source);
void write_success_charts(MarkupWriter& html, const TrialPageSource& source);  // of the first group at fill-tilt, over the tilt
void write_trial_scatter(MarkupWriter& html, const TrialPageSource& source);   // nothing without one
void write_trial_predictors(MarkupWriter& html, const TrialPageSource& source);
void write_trial_efforts(MarkupWriter& html, const TrialPageSource& source);
void write_trial_weights(MarkupWriter& html, const TrialPageSource& source);
void write_trial_disagreements(MarkupWriter& html, const TrialPageSource& source);
void write_trial_words(MarkupWriter& html);

// "73 of 80: 91 % (83 to 96)".
std::string share_text(const Share& share);

// Opens a section with its heading.
void open_trial_section(MarkupWriter& html, const char* id, const char* heading);

}  // namespace wholehand
