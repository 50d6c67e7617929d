// SPDX-License-Identifier: MIT
#include "app/commands/command_line.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <system_error>

#include "app/commands/command_names.h"
#include "app/program/failure_line.h"
#include "app/program/open_files.h"
#include "app/program/remedy.h"
#include "base/system/memory_limit.h"
#include "base/system/output.h"
#include "base/system/version.h"
#include "base/text/error.h"
#include "core/reader/text.h"
#include "host/device.h"

namespace wholehand {
namespace {

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// runs before the initializers of all libraries, which also fail without memory
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)() = prepare_failure_line;
#endif

constexpr std::size_t OPEN_FILES = 48;  // of any command, beside the standard streams

int to_int(ExitCode code) { return static_cast<int>(code); }

int report(const Program& program, ExitCode code, const std::string& line) {
  std::fflush(stdout);
  if (program.on_failure) program.on_failure(code, line);
  if (program.is_silent) return to_int(code);
  print_note(line);
  return to_int(code);
}

// Names the unknown argument and what the user may have meant; "" if the parser's own words suffice.
std::string unexpected_argument(const CLI::App& command, const CLI::ParseError& error) {
  for (const std::string& extra : command.remaining()) {
    if (extra[0] != '-') continue;
    const std::string option = extra.substr(0, extra.find('='));
    const std::string guess = did_you_mean(option, option_names(command));
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) return guess;
    return "; unknown option " + in_quotes(option) + guess;
  }
  return "";
}

int refuse(const Program& program, const CLI::App& app, const CLI::ParseError& error) {
  const auto extra = app.remaining();
  if (app.get_subcommands().empty() && !extra.empty() && extra.front()[0] != '-') {
    return report(program, ExitCode::usage, unknown_command(app, extra.front()));
  }
  const CLI::App& command = named_command(app);
  return report(program, ExitCode::usage,
                error.what() + unexpected_argument(command, error) + "; see " + full_name(command) + " --help");
}

int run(int argc, char** argv, const Program& program) {
  Action action;
  CLI::App app{program.description, program.name};
  app.set_version_flag("-V,--version", program.name + " " + version() + program.version_note);
  app.require_subcommand(0, 1);
  app.footer(program.footer);
  program.add_commands(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answer) {  // --help, --version
    std::ostringstream text;
    app.exit(answer, text);
    if (!program.is_silent) print(text.str());
    finish_output();
    return to_int(ExitCode::done);
  } catch (const CLI::ParseError& error) {
    return refuse(program, app, error);
  }
  if (!action)
    return report(program, ExitCode::usage,
                  "the command is missing; allowed: " + command_list(app, "or") + "; see " + program.name + " --help");
  check_open_files(OPEN_FILES);
  const ExitCode code = action();
  finish_output();
  // with the validation layer on (WHOLEHAND_VALIDATION=1) a message is a failure
  const auto messages = host::take_validation_messages();
  for (const std::string& message : messages) print_note("validation: " + message);
  if (!messages.empty()) return to_int(ExitCode::failure);
  return to_int(code);
}

}  // namespace

int run_program(int argc, char** argv, const Program& program) {
  try {
    prepare_output();
    return run(argc, argv, program);
  } catch (const Error& error) {
    return report(program, error.code, error_line(error));
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return report(program, ExitCode::failure,
                    "no further thread can be started; raise the limits of processes (ulimit -u) and memory (ulimit -v)");
    return report(program, ExitCode::failure, std::string("unexpected failure: ") + error.what());
  } catch (const std::bad_alloc&) {
    return report(program, ExitCode::failure, "out of memory" + memory_limit_text() + "; ask for less at once");
  } catch (const std::exception& error) {
    return report(program, ExitCode::failure, std::string("unexpected failure: ") + error.what());
  }
}

int end_process(int code) {
  if (host::has_abandoned_devices()) _exit(code);  // the driver still uses what the end of a process destroys
  return code;
}

}  // namespace wholehand
