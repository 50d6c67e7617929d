// SPDX-License-Identifier: MIT
// The best score over height and roll of one vessel's grips, gathered while they are swept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/planes.h"
#include "sweeps/plan/plan.h"

namespace wholehand {

// Cells along one axis of a heat map. A grid's values have a cell each, bounded halfway to their neighbors (more than LARGEST_MAP
// values share cells evenly); a Sobol range is cut into so many that a cell of two such axes has 16 points on average.
class MapAxis {
 public:
  static constexpr std::size_t LARGEST_MAP = 128;
  static constexpr std::size_t LARGEST_SOBOL = 64;  // cells

  // `points`: grips of a vessel, which decide how many cells a range has.
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

  // Takes a score of one cell, by its place in scores(), found elsewhere.
  void raise(std::size_t cell, double score);

  const MapAxis& heights() const { return heights_; }
  const MapAxis& rolls() const { return rolls_; }
  // The value of a cell, NaN where no grip is feasible.
  double score(std::size_t height, std::size_t roll) const { return scores_[height * rolls_.cells() + roll]; }

  // All cells, height-major, for keeping them across a break.
  const std::vector<double>& scores() const { return scores_; }
  void restore(const std::vector<double>& scores);  // of the same size; throws Error (failure) otherwise

 private:
  MapAxis heights_, rolls_;
  std::vector<double> scores_;
  std::vector<double> height_values_, roll_values_;  // of a chunk
};

}  // namespace wholehand
