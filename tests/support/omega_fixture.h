// SPDX-License-Identifier: MIT
// An omega.7 over the stand-in for Force Dimension's SDK.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/text/error.h"
#include "device/grippers/omega_gripper.h"
#include "tests/support/refusal.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {

constexpr double OMEGA_WATCHDOG = 10e-3;  // s
constexpr int OMEGA_RIGHT = 35, OMEGA_LEFT = 37, SIGMA_RIGHT = 104, SIGMA_LEFT = 105;

// What `function` throws: one line.
template <class Function>
std::string omega_refusal(const Function& function, ExitCode code = ExitCode::failure) {
  return refusal_line(function, code);
}

inline void expect_has(const std::string& line, const std::string& gist) {
  EXPECT_NE(line.find(gist), std::string::npos) << "'" << line << "' lacks '" << gist << "'";
}

struct OmegaGripperTest : testing::Test {
  StandIn sdk{STAND_IN_DHD};

  std::unique_ptr<device::Gripper> open(int type = OMEGA_RIGHT) const {
    sdk->types = {type};
    return device::open_omega(STAND_IN_DHD, OMEGA_WATCHDOG);
  }
  std::string refused() const {
    return omega_refusal([] { device::open_omega(STAND_IN_DHD, OMEGA_WATCHDOG); });
  }
  // Where `call` stands among those that were made; past them if it was not.
  std::size_t place(const std::string& call) const {
    return static_cast<std::size_t>(std::find(sdk->calls.begin(), sdk->calls.end(), call) - sdk->calls.begin());
  }
  bool was_called(const std::string& call) const { return place(call) < sdk->calls.size(); }
};

}  // namespace wholehand
