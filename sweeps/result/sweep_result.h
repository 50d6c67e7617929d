// SPDX-License-Identifier: MIT
// Reads the finished result file of a sweep, for later use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/result.h"
#include "sweeps/lists/best.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/guarded_file.h"
#include "sweeps/result/result_checksums.h"

namespace wholehand::sweeps {

// The file's data on the sweep as a whole.
struct SweepOrigin {
  std::string scene;  // the scene file's text
  std::string version, backend, device, driver;
  Precision precision = Precision::full;
  double wall_seconds = 0, kernel_seconds = 0;
  double bytes = 0;  // of the file
  // For a scene with meshes, else empty: its place, the findings on each mesh, the keys that show whether they are still the same, and the lattices
  // by which they were read.
  std::string scene_file, meshes, mesh_keys, mesh_lattices;
};

// Limits of a scene (core/reader/ranges.h): more in a file is damage, detected before allocation.
constexpr std::size_t MOST_BEST = 100'000;  // grips listed of a vessel
constexpr std::size_t MOST_VESSELS = 64;

// A better place of one of the best grips within half a step of its axes.
struct RefinedGrip {
  GripInput grip;
  double score = 0;
};

// The only reader of results, local files only; a damaged file costs an error and no more (sweeps/result/guarded_file.h). No value is used before it
// is known to have the type and shape that a sweep gives it, and to be what the sweep wrote (sweeps/result/result_checksums.h). Not thread-safe.
class SweepResult {
 public:
  // Opens the file. Throws Error (usage), one line with the file: it does not exist or cannot be read, is not NetCDF-4 or is damaged, is not a
  // sweep's, or the sweep was not finished.
  explicit SweepResult(const std::string& path);

  const std::string& path() const { return file_.path(); }
  const SweepOrigin& origin() const { return origin_; }

  // Compares everything in the file with its checksums; what is read is compared anyway. Throws Error (usage), as every reading method does.
  void check_all() const { checksums_->check_all(); }

  // The variables of the grips in the file, in the catalogue's order; and one of them by its name, null if the file lacks it.
  const std::vector<const Variable*>& variables() const { return variables_; }
  const Variable* find(const std::string& name) const;

  // Ties the file to the scene that its text describes; call once, before the methods below. Throws Error (usage) if the vessels or the grips are not
  // the scene's. Both must outlive the object.
  void use(const Scene& scene, const Plan& plan);

  // Values of one plane of a variable at the stored grips first .. first + count - 1 of a vessel. NaN or MISSING if a grip has none.
  void read(const Variable& variable, std::size_t vessel, std::size_t plane, std::uint64_t first, std::size_t count,
            double* out) const;
  // The same for some of the grips, in their order.
  std::vector<double> pick(const Variable& variable, std::size_t vessel, std::size_t plane,
                           const std::vector<std::uint64_t>& grips) const;

  // Whether the sweep was asked to list its best grips; and those of a vessel and, if the plan has several, of a hand scale, the best first, none if
  // none is feasible and plausible.
  bool lists_best() const;
  std::vector<Candidate> best(std::size_t vessel, std::size_t hand_scale = 0) const;

  // The refined places of the grips of best(), in order; nothing if the sweep did not refine (`sweep --no-refine`).
  std::vector<std::optional<RefinedGrip>> refined(std::size_t vessel, std::size_t hand_scale = 0) const;

  // The robust scores of the grips of best(), in order; nothing in a scene without [robust]. NaN if a grip has none.
  std::vector<RobustScore> robust(std::size_t vessel, std::size_t hand_scale = 0) const;

  // The tilts at which a vessel starts to pour, one for each of the scene's fills, rad; NaN if it never does.
  std::vector<double> pouring_tilts(std::size_t vessel) const;

  // Heights of the mouths and lowest points of all vessels, m; known before `use`.
  std::vector<double> vessel_heights() const;
  std::vector<double> vessel_bases() const;
  std::vector<double> empty_masses() const;  // of all vessels, kg

 private:
  std::size_t vessels() const;
  std::size_t ranks(std::size_t dimensions) const;
  const GuardedFile::Stored& numbers(const std::string& name) const;
  void check_shape(const std::string& name, const std::vector<std::size_t>& shape) const;
  std::vector<double> row(const std::string& name, const std::vector<std::size_t>& lists, std::size_t length) const;
  std::vector<double> of_vessels(const char* name) const;
  std::string text(const char* name) const;
  double number(const char* name) const;

  void read_block(const GuardedFile::Stored& variable, std::span<const std::size_t> start, std::span<const std::size_t> count,
                  double* out) const;

  GuardedFile file_;
  std::unique_ptr<ResultChecksums> checksums_;
  SweepOrigin origin_;
  std::vector<const Variable*> variables_;
  const Scene* scene_ = nullptr;
  const Plan* plan_ = nullptr;
  std::vector<std::size_t> grip_shape_;  // lengths of the grips' dimensions, the slowest first
};

// Gives vessels with an unread mesh the heights that the file stores. Call before `use`.
void set_heights(const SweepResult& result, Scene& scene);

}  // namespace wholehand::sweeps
