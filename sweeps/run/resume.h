// SPDX-License-Identifier: MIT
// What an earlier sweep left, and whether a new one may go on with it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"

namespace wholehand {

// Throws Error (usage) where a result that is complete is of another sweep than this, as far as that is known without a device.
void check_complete(const std::string& result, const Scene& scene, bool on_core, Precision precision,
                    const std::vector<const Variable*>& variables);

// What must be the same for a sweep to go on where another one stopped.
std::map<std::string, std::string> sweep_identity(const Scene& scene, const Plan& plan, const BackendInfo& info, std::size_t best,
                                                  const std::vector<const Variable*>& variables);

// Reads the mark that a sweep goes on with. False: there is none, or the partial file no longer has the structure that the mark vouches for; then
// `note`
// is a line for the user. Throws Error: (usage) it is of another sweep, (failure) it is damaged or contradicts itself.
bool load_usable_mark(const OutputNames& names, const std::map<std::string, std::string>& identity, const MarkBounds& bounds,
                      SweepMark& mark, std::string& note);

// A line about the grips of an earlier sweep that is begun again; empty where there are none.
std::string lost_line(const OutputNames& names);

}  // namespace wholehand
