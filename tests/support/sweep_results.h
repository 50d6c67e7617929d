// SPDX-License-Identifier: MIT
// Result files of real sweeps, small and without their companions.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/backend.h"
#include "evidence/report/source.h"
#include "tests/support/files.h"

namespace wholehand {

// Two vessels with guidance points, a cup and a flask, of 3 x 2 x 3 x 12 grips with 2 fills and 4 tilts; made by editing it for
// other cases.
extern const std::string RESULT_SCENE;
// Parts of it that may be edited away.
inline const std::string RESULT_TILTS = "[tilts]\ndeg = [0, 45, 90, 135]", RESULT_LIQUID = "[liquid]\nfills = [0, 0.6]",
                         NO_EFFORTS = "[strength]\nefforts = false\n";

// Sweeps the scene by the core, in either precision, and writes what `wholehand sweep` does to `path`. Without an ending it is as a
// sweep that was interrupted leaves it.
void write_result(const Scene& scene, const std::string& path, Precision precision = Precision::full, bool has_ending = true);

// Writes the checksums of a result anew that was changed on purpose, so that readers come as far as what was changed.
void renew_checksums(const std::string& path);

// `text` with the first `from` in it replaced; a test failure where there is none.
std::string edited(std::string text, const std::string& from, const std::string& to);

// A swept scene with everything that a report needs.
struct SweptScene {
  explicit SweptScene(const std::string& text, Precision precision = Precision::full);

  TemporaryFolder folder;
  Scene scene;
  std::string path;
  std::unique_ptr<sweeps::SweepResult> result;
  std::unique_ptr<sweeps::Plan> plan;
  std::unique_ptr<ReportSource> source;

  GripInput best_grip(std::size_t vessel) const;
  // Overwrites values of a variable of the file, from its first on, and reads it anew.
  void change(const std::string& variable, const std::vector<double>& values);

 private:
  void open();
};

}  // namespace wholehand
