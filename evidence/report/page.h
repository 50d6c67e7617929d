// SPDX-License-Identifier: MIT
// One page for a sweep: what `wholehand report` writes.
#pragma once

#include <string>

#include "base/charts/markup.h"
#include "core/scene.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

// The page as one self-contained file of HTML (well-formed XML too): no script, nothing that is fetched. `scene` is what the file's text
// describes, with its meshes read where they could be; `trouble`: why they could not, empty where nothing is missing. What then cannot be
// computed is left out with a sentence. `lists_file`: a list of `wholehand rank` whose grips stand for the sweep's best, or empty. Throws Error
// (usage) where the file does not fit its scene, or the list the file.
std::string report_page(SweepResult& result, const Scene& scene, const std::string& mesh_error = "",
                        const std::string& lists_file = "");

// The start of such a page: the element html, which stays open, and its head with the style and the mark of a page of wholehand's.
void begin_page(MarkupWriter& html, const std::string& title);

// Throws Error (usage) where `path` may not be written over: it is the result file itself, or something is there that is no such page.
void check_overwrites_page(const std::string& path, const std::string& result);

}  // namespace wholehand
