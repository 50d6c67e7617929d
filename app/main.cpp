// SPDX-License-Identifier: MIT
// The command line: finds the command, runs it, and turns whatever goes wrong into one line and an exit code.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <system_error>

#include "app/command_names.h"
#include "app/commands.h"
#include "app/failure_line.h"
#include "app/open_files.h"
#include "app/remedy.h"
#include "core/error.h"
#include "host/device.h"
#include "scene/text.h"
#include "system/memory_limit.h"
#include "system/output.h"
#include "system/version.h"

namespace {

using wholehand::Action;
using wholehand::ExitCode;

constexpr std::size_t OPEN_FILES = 48;  // of any command, beside the standard streams

int to_int(ExitCode code) { return static_cast<int>(code); }

int report(ExitCode code, std::string line) {
  std::fflush(stdout);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  std::fprintf(stderr, "wholehand: %s\n", line.c_str());
  return to_int(code);
}

// What is not known among the arguments, with what was meant perhaps; "" where the parser's own words say it all.
std::string unexpected_argument(const CLI::App& command, const CLI::ParseError& error) {
  for (const std::string& extra : command.remaining()) {
    if (extra[0] != '-') continue;
    const std::string option = extra.substr(0, extra.find('='));
    const std::string guess = wholehand::did_you_mean(option, wholehand::option_names(command));
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) return guess;
    return "; unknown option " + wholehand::in_quotes(option) + guess;
  }
  return "";
}

int refuse(const CLI::App& app, const CLI::ParseError& error) {
  const auto extra = app.remaining();
  if (app.get_subcommands().empty() && !extra.empty() && extra.front()[0] != '-') {
    return report(ExitCode::usage, wholehand::unknown_command(app, extra.front()));
  }
  const CLI::App& command = wholehand::named_command(app);
  return report(ExitCode::usage,
                error.what() + unexpected_argument(command, error) + "; see " + wholehand::full_name(command) + " --help");
}

int run(int argc, char** argv) {
  Action action;
  CLI::App app{"Whole-hand grasping with a two-finger gripper: score the grips of a scene, look at one, check the devices.",
               "wholehand"};
  app.set_version_flag("--version", std::string("wholehand ") + wholehand::version() +
                                        "\n`wholehand devices` lists the devices that compute, and the grippers");
  app.require_subcommand(0, 1);
  app.footer(
      "The launcher also builds and runs the tests (test) and the benchmarks (bench).\n"
      "Exit codes: 0 done, 1 the answer is no (check), 2 wrong usage or input, 3 device or system failure, 130 interrupted.");
  wholehand::add_sweep_command(app, action);
  wholehand::add_rank_command(app, action);
  wholehand::add_report_command(app, action);
  wholehand::add_grip_command(app, action);
  wholehand::add_check_command(app, action);
  wholehand::add_error_time_command(app, action);
  wholehand::add_stability_command(app, action);
  wholehand::add_live_command(app, action);
  wholehand::add_session_command(app, action);
  wholehand::add_view_command(app, action);
  wholehand::add_devices_command(app, action);
  wholehand::add_scenes_command(app, action);
  wholehand::add_help_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wish) {  // --help, --version
    std::ostringstream text;
    app.exit(wish, text);
    wholehand::print(text.str());
    wholehand::finish_output();
    return to_int(ExitCode::done);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
  }
  if (!action)
    return report(ExitCode::usage,
                  "the command is missing; allowed: " + wholehand::command_list(app, "or") + "; see wholehand --help");
  wholehand::check_open_files(OPEN_FILES);
  const ExitCode code = action();
  wholehand::finish_output();
  // with the validation layer on (WHOLEHAND_VALIDATION=1) a message is a failure
  const auto messages = wholehand::host::take_validation_messages();
  for (const std::string& message : messages) std::fprintf(stderr, "wholehand: validation: %s\n", message.c_str());
  if (!messages.empty()) return to_int(ExitCode::failure);
  return to_int(code);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// runs before the initializers of all libraries, which fail too where there is no memory
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)() = wholehand::prepare_failure_line;
#endif

}  // namespace

int main(int argc, char** argv) {
  try {
    wholehand::prepare_output();
    return run(argc, argv);
  } catch (const wholehand::Error& error) {
    return report(error.code, wholehand::line_of(error));
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return report(ExitCode::failure,
                    "no further thread can be started; raise the limits of processes (ulimit -u) and memory (ulimit -v)");
    return report(ExitCode::failure, std::string("unexpected failure: ") + error.what());
  } catch (const std::bad_alloc&) {
    return report(ExitCode::failure, "out of memory" + wholehand::memory_limit_text() + "; ask for less at once");
  } catch (const std::exception& error) {
    return report(ExitCode::failure, std::string("unexpected failure: ") + error.what());
  }
}
