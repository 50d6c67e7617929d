// SPDX-License-Identifier: MIT
// Checks of arguments that CLI11 makes.
#pragma once

#include <CLI/CLI.hpp>

#include <cctype>
#include <string>
#include <string_view>

namespace wholehand {

// An argument that is there and empty is a mistake, of an unset shell variable perhaps, and not the default.
inline CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& value) { return std::string(value.empty() ? "must not be empty" : ""); }, "");
}

// Without this check, an option that lacks its value takes the next option as its value. A file of such a name is ./--name.
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

// Not a check: the values that completion offers for the option, with spaces between. After one that ends in ':' the user
// goes on; "replay:.nc" stands for replay: and the name of a file with that ending.
inline constexpr std::string_view OFFERED = "offered: ";
inline CLI::Validator offered(const std::string& words) {
  return CLI::Validator([](const std::string&) { return std::string(); }, "", std::string(OFFERED) + words);
}

}  // namespace wholehand
