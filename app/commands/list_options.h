// SPDX-License-Identifier: MIT
// The options --list, --wide and --rank-by: how many grips of a list a command prints, and in which order.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "app/commands/validators.h"
#include "app/program/values.h"
#include "sweeps/lists/best.h"

namespace wholehand {

struct ListArguments {
  std::string rows, by;
  bool is_wide = false;

  // Throws Error (usage). `by` is the default.
  sweeps::ListView view() const {
    sweeps::ListView view;
    if (!rows.empty()) view.rows = static_cast<std::size_t>(parse_integer(rows, "--list", {1, ranges::BEST.high}));
    view.is_wide = is_wide;
    return view;
  }
};

inline void add_list_options(CLI::App& command, ListArguments& arguments) {
  command.add_option("--list", arguments.rows, "Number of grips to show of each list, as far as --best goes (default: 5)")
      ->type_name("N")
      ->check(not_empty());
  command.add_flag("--wide", arguments.is_wide, "Show all columns of the lists, and all counts");
  command
      .add_option(
          "--rank-by", arguments.by,
          "score, robust (10th percentile over the deviations of [robust]; the default where the scene has it), worst_effort "
          "or push")
      ->type_name("KEY")
      ->check(offered("score robust worst_effort push"))
      ->check(not_empty());
}

}  // namespace wholehand
