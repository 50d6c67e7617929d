// SPDX-License-Identifier: MIT
// The page of trials: trials.html.
#pragma once

#include <string>

#include "evidence/trials/page_source.h"

namespace wholehand {

// One self-contained HTML file (also well-formed XML): no script, and nothing is fetched. It links to the recordings beside it.
std::string trials_page(const TrialPageSource& source);

}  // namespace wholehand
