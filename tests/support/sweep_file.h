// SPDX-License-Identifier: MIT
// A result file of the stand-in kernels, written grip by grip, and what must be in it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "sweeps/result/output_names.h"
#include "sweeps/result/result_file.h"
#include "tests/support/fake_backend.h"
#include "tests/support/result_reader.h"

namespace wholehand {

// All that a result file needs, over the stand-in kernels.
struct SweepFile {
  SweepFile(const Scene& wanted, const std::string& path, Precision precision = Precision::full, std::size_t chunk = 97)
      : scene(wanted),
        variables(sweeps::choose_variables(scene)),
        plan(scene, sweeps::keeps_vectors(variables)),
        backend(scene, make_field_set(sweeps::variable_fields(variables), scene), precision, chunk),
        contents{scene, plan, variables, sweeps::vessel_facts(scene, backend, FakeEvaluator(scene)), backend.info(), "1", 3},
        names(sweeps::output_names(path)) {}

  sweeps::ResultFile open(bool resume = false) {
    return sweeps::ResultFile(names, contents, backend.fields(), resume ? sweeps::FileStart::resumed : sweeps::FileStart::reserved);
  }

  // Grips [first, last) of a vessel.
  void write(sweeps::ResultFile& file, std::size_t vessel, std::uint64_t first, std::uint64_t last) {
    RunRequest request;
    request.vessel = vessel;
    request.first = first;
    request.last = last;
    request.grips = [&](std::size_t v, std::uint64_t i, std::size_t n, GripInput* out) { plan.fill(v, i, n, out); };
    request.sink = [&](const PlaneChunk& chunk) { file.write(chunk); };
    backend.run(request);
  }

  void write_all(sweeps::ResultFile& file) {
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) write(file, v, 0, plan.grips());
    file.write_ending(sweeps::BestLists(scene.vessels.size()), 1, 1);
  }

  Scene scene;
  std::vector<const sweeps::Variable*> variables;
  sweeps::Plan plan;
  FakeBackend backend;
  sweeps::ResultContents contents;
  sweeps::OutputNames names;
};

// Runs `work` in a process of its own; its exit code, or minus the signal that ended it.
template <class Work>
int in_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// What the file must hold of a variable: written out from the stand-in kernels, index by index.
inline std::vector<double> expected_values(const SweepFile& setup, const sweeps::Variable& variable) {
  std::vector<double> values;
  const std::size_t planes = sweeps::variable_planes(variable, setup.scene);
  for (std::size_t v = 0; v < setup.scene.vessels.size(); ++v) {
    for (std::size_t p = 0; p < planes; ++p) {
      for (std::uint64_t stored = 0; stored < setup.plan.stored_grips(); ++stored) {
        const GripInput grip = setup.plan.grip(v, stored % setup.plan.grips());
        if (variable.type == sweeps::NumberType::real) {
          values.push_back(fake_real(v, grip, variable.field, variable.plane + static_cast<int>(p)));
          continue;
        }
        const bool feasible = (fake_uint(v, grip, FIELD_STATUS) & STATUS_REASON_MASK) == REASON_NONE;
        values.push_back(feasible || variable.always ? variable.value(fake_uint(v, grip, variable.field)) : variable.missing);
      }
    }
  }
  return values;
}

inline void expect_expected(const SweepFile& setup, const std::string& path) {
  for (const sweeps::Variable* variable : setup.variables) {
    const auto expected = expected_values(setup, *variable), found = read_values(path, variable->name);
    ASSERT_EQ(found.size(), expected.size()) << variable->name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_TRUE(found[i] == expected[i] || (std::isnan(found[i]) && std::isnan(expected[i])))
          << variable->name << "[" << i << "]: " << found[i] << " instead of " << expected[i];
    }
  }
}

}  // namespace wholehand
