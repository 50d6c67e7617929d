// SPDX-License-Identifier: MIT
// Decides whether a new sweep may continue what an earlier one left.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

// Throws Error (usage) if a complete result belongs to another sweep than this, as far as that is known without a device.
void check_complete(const std::string& result, const Scene& scene, bool on_core, Precision precision,
                    const std::vector<const Variable*>& variables);

// What must be the same for a sweep to continue another one.
std::map<std::string, std::string> sweep_identity(const Scene& scene, const Plan& plan, const BackendInfo& info, std::size_t best,
                                                  const std::vector<const Variable*>& variables);

// Reads the mark of the sweep to continue. False: there is none, or the partial file no longer has the mark's structure; then `note` is a line for
// the user. Throws Error: (usage) it belongs to another sweep; (failure) it is damaged or contradicts itself.
bool load_usable_mark(const OutputNames& names, const std::map<std::string, std::string>& identity, const MarkBounds& bounds,
                      SweepMark& mark, std::string& note);

// A line about the grips of an earlier sweep that are computed again; empty if there are none.
std::string lost_line(const OutputNames& names);

}  // namespace wholehand::sweeps
