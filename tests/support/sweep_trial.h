// SPDX-License-Identifier: MIT
// A whole sweep over the stand-in kernels, in this process or in one of its own.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "core/core_backend.h"
#include "sweeps/result/output_names.h"
#include "sweeps/run/run.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"

namespace wholehand {

struct SweepOutcome {
  ExitCode code = ExitCode::done;
  std::string error, out, notes;
};

// A sweep over the stand-in kernels.
struct SweepTrial {
  Scene scene = fake_scene();
  sweeps::SweepOptions options;
  Precision precision = Precision::full;
  std::size_t chunk = 50;
  std::function<void()> before_run, before_chunk, before_other;  // of a scene with another friction: each of its chunks
  std::string driver = "fake driver 1";
  int opened = 0;  // backends

  explicit SweepTrial(const std::string& output) {
    options.output = output;
    options.on = "fake";
    options.precision = Precision::full;
  }

  ExitCode run_bare() {
    const sweeps::SweepParts parts{
        .open_backend = [this](const sweeps::BackendChoice&, const FieldSet& fields) -> std::unique_ptr<Backend> {
          auto backend = std::make_unique<FakeBackend>(scene, fields, precision, chunk);
          backend->before_run = before_run;
          backend->before_chunk = before_chunk;
          backend->info_.driver = driver;
          ++opened;
          return backend;
        },
        .open_evaluator = [this] { return std::make_unique<FakeEvaluator>(scene); },
        .open_core = [this](const Scene& other, const FieldSet& fields) -> std::unique_ptr<Backend> {
          auto backend = std::make_unique<FakeBackend>(other, fields, precision, chunk);
          backend->before_chunk = before_other;
          return backend;
        }};
    return sweeps::run_sweep(scene, options, parts);
  }

  SweepOutcome run() {
    SweepOutcome outcome;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      outcome.code = run_bare();
    } catch (const Error& error) {
      outcome.code = error.code;
      outcome.error = error.what();
    }
    outcome.out = testing::internal::GetCapturedStdout();
    outcome.notes = testing::internal::GetCapturedStderr();
    EXPECT_EQ(outcome.error.find('\n'), std::string::npos) << outcome.error;
    return outcome;
  }

  // In a process of its own, without a word.
  pid_t start() {
    const pid_t child = fork();
    if (child != 0) return child;
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    int code = 99;
    try {
      code = static_cast<int>(run_bare());
    } catch (const Error& error) {
      code = static_cast<int>(error.code);
    }
    _exit(code);
  }
};

inline int exit_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// The list beside a result without what each row ends with: the names of the result and of the sweep, which reveal the backend.
inline std::string list_beside(const std::string& result) {
  std::istringstream rows(file_text(sweeps::output_names(result).best));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    for (int k = 0; k < 2; ++k) row.resize(std::min(row.size(), row.rfind(',')));
    text += row + "\n";
  }
  return text;
}

class RunTest : public testing::Test {
 protected:
  TemporaryFolder folder;

  // An undisturbed sweep to compare with.
  std::string reference(const Scene& scene = fake_scene()) {
    SweepTrial trial(folder / "reference.nc");
    trial.scene = scene;
    EXPECT_EQ(trial.run().code, ExitCode::done);
    return folder / "reference.nc";
  }

  void expect_same_as(const std::string& reference, const std::string& other) {
    expect_same_values(reference, other);
    EXPECT_EQ(list_beside(reference), list_beside(other));
    EXPECT_EQ(file_text(sweeps::output_names(reference).heat_map("second")),
              file_text(sweeps::output_names(other).heat_map("second")));
  }
};

// Without pictures, which take most of a short sweep's time.
inline Scene quick_scene() {
  Scene scene = fake_scene();
  scene.output.keep = {{"gap", "reason"}};
  return scene;
}

}  // namespace wholehand
