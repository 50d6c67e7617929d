// The command line: finds the command, runs it, and turns whatever goes wrong into one line and an exit code.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <system_error>

#include "app/commands.h"
#include "app/output.h"
#include "app/scene_text.h"
#include "app/version.h"
#include "core/error.h"
#include "host/device.h"

namespace {

using wholehand::Action;
using wholehand::ExitCode;

int to_int(ExitCode code) { return static_cast<int>(code); }

int report(ExitCode code, std::string line) {
  std::fflush(stdout);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  std::fprintf(stderr, "wholehand: %s\n", line.c_str());
  return to_int(code);
}

// The command that the arguments name, for the hint at its help; "" before one is known.
std::string command_name(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? "" : " " + commands.front()->get_name() + command_name(*commands.front());
}

int run(int argc, char** argv) {
  Action action;
  CLI::App app{"Whole-hand grasping with a two-finger gripper: score the grips of a scene, look at one, check the devices.",
               "wholehand"};
  app.set_version_flag("--version", std::string("wholehand ") + wholehand::version());
  app.require_subcommand(0, 1);
  app.footer(
      "The launcher also builds and runs the tests (test) and the benchmarks (bench).\n"
      "Exit codes: 0 done, 1 the answer is no (check), 2 wrong usage or input, 3 device or system failure, 130 interrupted.");
  wholehand::add_sweep_command(app, action);
  wholehand::add_report_command(app, action);
  wholehand::add_grip_command(app, action);
  wholehand::add_check_command(app, action);
  wholehand::add_error_time_command(app, action);
  wholehand::add_stability_command(app, action);
  wholehand::add_live_command(app, action);
  wholehand::add_session_command(app, action);
  wholehand::add_view_command(app, action);
  wholehand::add_devices_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wish) {  // --help, --version
    std::ostringstream text;
    app.exit(wish, text);
    wholehand::print(text.str());
    return to_int(ExitCode::done);
  } catch (const CLI::ParseError& error) {
    const auto extra = app.remaining();
    if (app.get_subcommands().empty() && !extra.empty() && extra.front()[0] != '-') {
      return report(ExitCode::usage,
                    "unknown command " + wholehand::in_quotes(extra.front()) +
                        "; the commands are sweep, report, grip, check, error-time, stability, live, session, view and devices");
    }
    return report(ExitCode::usage, std::string(error.what()) + "; see wholehand" + command_name(app) + " --help");
  }
  if (!action)
    return report(ExitCode::usage,
                  "which command? sweep, report, grip, check, error-time, stability, live, session, view or devices; see "
                  "wholehand --help");
  const ExitCode code = action();
  wholehand::finish_output();
  // with the validation layer on (WHOLEHAND_VALIDATION=1) a message is a failure
  const auto messages = wholehand::host::take_validation_messages();
  for (const std::string& message : messages) std::fprintf(stderr, "wholehand: validation: %s\n", message.c_str());
  if (!messages.empty()) return to_int(ExitCode::failure);
  return to_int(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    wholehand::prepare_output();
    return run(argc, argv);
  } catch (const wholehand::Error& error) {
    return report(error.code, error.what());
  } catch (const std::system_error& error) {
    // what prints while it works throws this where standard output takes no more
    if (std::ferror(stdout)) {
      return report(ExitCode::failure,
                    "cannot write to standard output: " + error.code().message() + "; what was printed is incomplete");
    }
    return report(ExitCode::failure, std::string("unexpected failure: ") + error.what());
  } catch (const std::bad_alloc&) {
    return report(ExitCode::failure, "out of memory; ask for less at once");
  } catch (const std::exception& error) {
    return report(ExitCode::failure, std::string("unexpected failure: ") + error.what());
  }
}
