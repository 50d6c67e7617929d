// SPDX-License-Identifier: MIT
// The best grips of every vessel, for people: a file and a table.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// The first characters of best_csv's table.
inline constexpr std::string_view BEST_CSV_START = "vessel,rank,height_mm,";

// Efforts of the whole hand over all fills and tilts (docs/method.md, 10).
struct GripEfforts {
  double worst = std::numeric_limits<double>::quiet_NaN(), fill = worst, tilt = worst;  // a state of it: fraction, rad
  double tips_worst = worst;
  double push = worst;  // N
  double friction_needed = worst;
};

// Over deviations of a grip (sweeps/lists/robust.h).
struct RobustScore {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double low = mean;    // 10th percentile
  double share = mean;  // of the deviations that are feasible, plausible and held
};

// One of the best grips with its figures. Forces and tilts are the worst over all fills; NaN if the scene has no tilts.
struct BestGrip {
  Candidate candidate;
  GripInput grip;
  std::size_t rank = 1;
  double score = 0;
  std::array<double, 6> terms{};  // fingers, contacts, depth, posture, force, hold
  double closure = 0;
  double gap = 0;  // m
  int fingers_used = 0, points_touching = 0;
  bool antipodal = false;
  double phalanx_depth = 0, palm_depth = 0;                       // m
  double wrist_share = std::numeric_limits<double>::quiet_NaN();  // NaN in a scene without [arm]
  double peak_force = 0;                                          // largest feedback force, N
  double peak_tilt = 0;                                           // of it, rad
  double largest_hold = 0;                                        // of each of two tips, N, may be infinite
  double safe_tilt = 0;                                           // smallest over the fills, rad; NaN if a fill has none
  bool is_safe_to_end = false;  // at every fill it is the last counted tilt, so the limit is unknown
  GripEfforts efforts;          // NaN in a scene without efforts
  GripInput refined{};          // the best place near the grip (sweeps/lists/refine.h), if it has a score
  double refined_score = std::numeric_limits<double>::quiet_NaN();
  RobustScore robust{};  // NaN in a scene without [robust]
};

// A list for each vessel and hand scale, in the order of GripLists (sweeps/result/grip_lists.h); in each the best first.
using BestLists = std::vector<std::vector<BestGrip>>;

// A candidate of the vessel, with only its place known.
BestGrip bare_grip(const Plan& plan, std::size_t vessel, const Candidate& candidate);

// FIELD_* from which a BestGrip is read.
std::vector<int> best_fields(const Scene& scene);

// Evaluates a vessel's grips again, because a sweep need not have kept all their figures: sets these and the ranks, but no refined places and robust
// scores. The backend must keep best_fields(). Throws Error (failure) if it delivers fewer.
void evaluate_best(Backend& backend, const Scene& scene, std::size_t vessel, std::vector<BestGrip>& grips);
std::vector<BestGrip> evaluate_best(Backend& backend, const Scene& scene, const Plan& plan, std::size_t vessel,
                                    const std::vector<Candidate>& candidates);

// Sets forces and tilts to the worst over the fills, from FIELD_PEAK_FORCE, FIELD_PEAK_TILT, FIELD_LARGEST_HOLD and FIELD_SAFE_TILT of each. With
// efforts it sets these too, and computes the hold force from the effort of the tips at the grip's gap and hand scale, which must be set, instead of
// FIELD_LARGEST_HOLD. `last_tilts` are the vessel's (core/counted_tilts.h).
void set_worst(BestGrip& best, const Scene& scene, const std::vector<double>& last_tilts,
               const std::function<double(int field, int fill)>& value);

// The sweep of a list: the name of its result without the folder, and its sweep_id (sweeps/result/grip_lists.h).
struct ListOrigin {
  std::string result, sweep;
};

// The file NAME.best.csv and those of `wholehand rank`: one row per grip, with units in the column names. At the end, the grip's number in the sweep,
// the result and the sweep identify the grip. The lists are those of each vessel and hand scale (GripLists).
std::string best_csv(const Scene& scene, const Plan& plan, const std::vector<std::vector<BestGrip>>& lists,
                     const ListOrigin& origin);
// The first line of a CSV list, and the line of a grip of a vessel.
std::string best_csv_head(const Scene& scene);
std::string best_csv_row(const Scene& scene, const std::string& vessel, const BestGrip& best, const ListOrigin& origin);

// The criterion of a list: the largest score, the largest robust scores (sweeps/lists/robust.h), the least worst_effort, or the largest push.
enum class RankBy { score, robust, worst_effort, push };
// The order of a sweep's lists: `robust` in a scene with [robust], else `score`.
RankBy usual_order(const Scene& scene);

// What a terminal shows of a list.
struct ListView {
  std::size_t rows = 5;  // at most
  bool is_wide = false;  // all columns, however wide the lines get
  RankBy by = RankBy::score;
  double score_tolerance = 0;             // scores this close count as equal (core/tolerances.h)
  std::vector<std::string> results = {};  // for a list of several results: each grip's result; else empty
};

// The table of one list for a terminal, with only the axes that vary. Unless it is wide, it has at most ten columns in less than 100 characters: the
// list's criterion, the axes, and as much of the rest as fits.
std::string best_table(const Scene& scene, const Plan& plan, const std::vector<BestGrip>& best, const ListView& view);

}  // namespace wholehand::sweeps
