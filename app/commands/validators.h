// SPDX-License-Identifier: MIT
// Checks of arguments that CLI11 makes.
#pragma once

#include <CLI/CLI.hpp>

#include <cctype>
#include <string>
#include <string_view>

namespace wholehand {

// Refuses an argument that is present but empty, perhaps from an unset shell variable, instead of taking the default.
inline CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& value) { return std::string(value.empty() ? "must not be empty" : ""); }, "");
}

// Without this check, an option that lacks its value would take the next option as its value. Write ./--name for a file of such a name.
inline CLI::Validator not_an_option() {
  return CLI::Validator(
      [](const std::string& value) {
        const std::size_t letter = value.starts_with("--") ? 2 : 1;
        const bool is_option =
            value.starts_with('-') && value.size() > letter && std::isalpha(static_cast<unsigned char>(value[letter]));
        return is_option ? "its value is missing: '" + value + "' is an option" : std::string();
      },
      "");
}

// Not a check: the values that completion offers for the option, separated by spaces. After one that ends in ':' the user continues; "replay:.nc"
// stands for replay: and a file name with that ending.
inline constexpr std::string_view OFFERED = "offered: ";
inline CLI::Validator offered(const std::string& words) {
  return CLI::Validator([](const std::string&) { return std::string(); }, "", std::string(OFFERED) + words);
}

}  // namespace wholehand
