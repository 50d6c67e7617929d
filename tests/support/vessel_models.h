// SPDX-License-Identifier: MIT
// Models of vessels, made by code, whose true values come from formulas.
#pragma once

#include <string>
#include <vector>

#include "tests/support/mesh_faults.h"
#include "tests/support/vessel_model.h"

namespace wholehand {

// What a refusal must say.
constexpr const char* SAYS_NO_CAVITY = "no hollow";      // the body is solid
constexpr const char* SAYS_SEALED = "closed above";      // the cavity has no mouth
constexpr const char* SAYS_UPSIDE_DOWN = "upside down";  // the mouth faces down
constexpr const char* SAYS_NO_FLOOR = "no floor";        // a pipe: open above and below

// All of them, made once.
const std::vector<VesselModel>& vessel_models();
// Throws std::out_of_range if there is none of that name.
const VesselModel& vessel_model(const std::string& name);

}  // namespace wholehand
