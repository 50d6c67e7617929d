// SPDX-License-Identifier: MIT
// wholehand report: one page for a sweep.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands/commands.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "evidence/report/page.h"
#include "sweeps/result/output_names.h"

namespace wholehand {
namespace {

struct PageArguments {
  std::string result, page, list;
};

ExitCode report_sweep(const PageArguments& arguments) {
  const std::string page = arguments.page.empty() ? sweeps::output_names(arguments.result).stem + ".html" : arguments.page;
  sweeps::SweepResult result(arguments.result);
  check_output_path(page);
  check_overwrites_page(page, arguments.result);
  result.check_all();  // also what the page does not show: it says that the file's numbers agree
  std::string mesh_error;
  const Scene scene = scene_of_result(result, mesh_error);
  const std::string html = report_page(result, scene, mesh_error, arguments.list);
  write_whole_file(page, html, false);
  print(fmt::format("wrote {} ({})\n", one_line(page), readable_bytes(static_cast<double>(html.size()))));
  return ExitCode::done;
}

}  // namespace

void add_report_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<PageArguments>();
  CLI::App* command =
      app.add_subcommand("report", "Write one page that explains a sweep: maps, best grips, forces, agreement with the core");
  command->add_option("result", arguments->result, "Result of `wholehand sweep`")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command->add_option("-o,--output", arguments->page, "File of the page (default: the result's name with .html)")
      ->type_name("FILE")
      ->check(not_empty());
  command
      ->add_option("--list", arguments->list,
                   "Show the best grips of this list of `wholehand rank` (default: the sweep's own list)")
      ->type_name("LIST.csv")
      ->check(not_empty());
  command->callback([arguments, &action] { action = [arguments] { return report_sweep(*arguments); }; });
}

}  // namespace wholehand
