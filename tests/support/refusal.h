// SPDX-License-Identifier: MIT
// What callers are refused with.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/text/error.h"

namespace wholehand {

// The line of the Error that `act` throws, which has that code; "" where it throws none.
template <class Act>
std::string refusal_line(const Act& act, ExitCode code = ExitCode::usage) {
  try {
    act();
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.code, code) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return "";
}

}  // namespace wholehand
