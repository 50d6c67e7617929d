// SPDX-License-Identifier: MIT
// The best score over height and roll of one vessel's grips, gathered during a sweep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/planes.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// Cells along one axis of a heat map. Each value of a grid has a cell, bounded halfway to its neighbors (more than LARGEST_MAP values share cells
// evenly). A Sobol range is cut so that a cell of two such axes has 16 points on average.
class MapAxis {
 public:
  static constexpr std::size_t LARGEST_MAP = 128;
  static constexpr std::size_t LARGEST_SOBOL = 64;  // cells

  // `points`: grips of a vessel, which determine the number of cells of a range.
  MapAxis(const PlanAxis& axis, std::uint64_t points);
  std::size_t cells() const { return edges_.size() - 1; }
  double edge(std::size_t i) const { return edges_[i]; }  // i in [0, cells()], ascending, in the axis's unit
  std::size_t cell(double value) const;                   // clamped to the cells

 private:
  std::vector<double> edges_;
};

// The largest score over all other axes in every cell of height x roll. Memory: at most LARGEST_MAP squared numbers.
class HeatMap {
 public:
  explicit HeatMap(const Plan& plan);

  // Takes the feasible grips of a chunk. The set must keep FIELD_SCORE and FIELD_STATUS.
  void add(const Plan& plan, const PlaneChunk& chunk, const FieldSet& fields);

  // Takes a score, found elsewhere, of one cell by its index in scores().
  void raise(std::size_t cell, double score);

  const MapAxis& heights() const { return heights_; }
  const MapAxis& rolls() const { return rolls_; }
  // The value of a cell, NaN if no grip is feasible.
  double score(std::size_t height, std::size_t roll) const { return scores_[height * rolls_.cells() + roll]; }

  // All cells, height-major, to keep them across an interruption.
  const std::vector<double>& scores() const { return scores_; }
  void restore(const std::vector<double>& scores);  // of the same size; throws Error (failure) otherwise

 private:
  MapAxis heights_, rolls_;
  std::vector<double> scores_;
  std::vector<double> height_values_, roll_values_;  // of a chunk
};

}  // namespace wholehand::sweeps
