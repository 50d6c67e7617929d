// SPDX-License-Identifier: MIT
// Checks of arguments that CLI11 makes.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace wholehand {

// An argument that is there and empty is a mistake, of an unset shell variable perhaps, and not the default.
inline CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& value) { return std::string(value.empty() ? "must not be empty" : ""); }, "");
}

}  // namespace wholehand
