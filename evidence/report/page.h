// SPDX-License-Identifier: MIT
// One page for a sweep: what `wholehand report` writes.
#pragma once

#include <string>

#include "base/charts/markup.h"
#include "core/scene.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

// The page as one self-contained HTML file (also well-formed XML): no script, and nothing is fetched. `scene` is what the file's text describes, with
// its meshes read if possible; `trouble`: why they could not be, empty if nothing is missing. A sentence replaces what then cannot be computed.
// `lists_file`: a list of `wholehand rank` whose grips replace the sweep's best, or empty. Throws Error (usage) if the file does not fit its scene,
// or the list the file.
std::string report_page(sweeps::SweepResult& result, const Scene& scene, const std::string& mesh_error = "",
                        const std::string& lists_file = "");

// The start of such a page: the element html, which stays open, and its head with the style and the mark of wholehand's pages.
void begin_page(MarkupWriter& html, const std::string& title);

// Throws Error (usage) if `path` must not be overwritten: it is the result file itself, or something else than such a page exists.
void check_overwrites_page(const std::string& path, const std::string& result);

}  // namespace wholehand
