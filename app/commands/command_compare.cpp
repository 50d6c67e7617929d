// SPDX-License-Identifier: MIT
// wholehand compare: what differs between two results of sweeps.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands/commands.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/printable.h"
#include "evidence/report/compare.h"
#include "evidence/report/page.h"

namespace wholehand {
namespace {

struct CompareArguments {
  std::string a, b, page;
};

ExitCode compare(const CompareArguments& arguments) {
  if (is_same_file(arguments.a, arguments.b))
    throw usage_error(fmt::format("compare: {} and {} are the same file; name two results", arguments.a, arguments.b));
  sweeps::SweepResult a(arguments.a), b(arguments.b);
  if (!arguments.page.empty()) {
    check_output_path(arguments.page);
    check_overwrites_page(arguments.page, is_same_file(arguments.page, arguments.b) ? arguments.b : arguments.a);
  }
  std::string mesh_error;  // with meshes, which nothing here needs
  const Scene scene_a = scene_of_result(a, mesh_error), scene_b = scene_of_result(b, mesh_error);
  const std::vector<ComparePart> parts = compare_results(a, scene_a, b, scene_b);
  print(comparison_text(parts));
  if (arguments.page.empty()) return ExitCode::done;
  write_whole_file(arguments.page, comparison_page(parts), false);
  print(fmt::format("\nwrote {}\n", one_line(arguments.page)));
  return ExitCode::done;
}

}  // namespace

void add_compare_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Show what differs between two sweeps: how they judge, counts, best grips, worst efforts");
  const auto add = [command](const char* name, std::string& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("a", arguments->a, "A.nc", "Result of `wholehand sweep`")->required();
  add("b", arguments->b, "B.nc", "Result of another sweep, of an edited scene perhaps")->required();
  add("-o,--output", arguments->page, "PAGE.html", "Write the comparison as a page too");
  command->callback([arguments, &action] { action = [arguments] { return compare(*arguments); }; });
}

}  // namespace wholehand
