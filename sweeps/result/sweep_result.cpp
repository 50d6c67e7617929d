// SPDX-License-Identifier: MIT
#include "sweeps/result/sweep_result.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>

#include "base/system/version.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/file_kind.h"
#include "sweeps/lists/refine.h"
#include "sweeps/lists/robust.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_contents.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t AT_ONCE = 1 << 18;        // values
constexpr std::uint64_t SEEK_IN_VALUES = 4096;  // reading one value alone takes as long as so many in a row

// Throws if the file, by its name and first bytes, is not one that a sweep finished; returns the path.
const std::string& check_is_result(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    const int error = errno;
    const std::string partial = output_names(path).partial;
    if (stat(partial.c_str(), &status) == 0)
      throw usage_error(
          fmt::format("{}: {} is of a sweep that was not finished; finish it with wholehand sweep --resume", path, partial));
    throw usage_error(fmt::format("{}: cannot be read: {}{}", path, std::strerror(error), backslash_note(path)));
  }
  if (!S_ISREG(status.st_mode)) return path;  // refused where it is opened
  if (access(path.c_str(), R_OK) != 0) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  const FileKind kind = file_kind_at(path);
  if (kind == FileKind::result) return path;
  throw usage_error(
      path + ": " +
      (kind == FileKind::unknown ? "is not a result file of a sweep (NetCDF-4)" : wrong_kind(kind, "a result of a sweep")));
}

std::uint64_t product(const std::vector<std::size_t>& lengths, std::size_t first) {
  return std::accumulate(lengths.begin() + static_cast<std::ptrdiff_t>(first), lengths.end(), std::uint64_t{1},
                         std::multiplies<>());
}

}  // namespace

SweepResult::SweepResult(const std::string& path) : file_(check_is_result(path)) {
  if (const std::optional<std::string> checksums = file_.text(CHECKSUMS))
    checksums_ = std::make_unique<ResultChecksums>(path, *checksums);
  origin_.bytes = file_.bytes();
  origin_.scene = text("scene");
  if (text("program") != "wholehand") throw usage_error(path + ": is not a result of a sweep: another program wrote it");
  if (file_.text("engine"))
    throw usage_error(path +
                      ": is the answer of wholehand trials, and not a result of a sweep; give a result of wholehand sweep, "
                      "or for new trials a scene; wholehand view plays the disagreement-*.nc beside it");
  origin_.version = text("version");
  check_version(path + ": ", origin_.version, "run the sweep again");
  origin_.backend = text("backend");
  origin_.device = text("device");
  origin_.driver = text("driver");
  origin_.precision = text("precision") == "float" ? Precision::single : Precision::full;
  origin_.scene_file = file_.text(SCENE_FILE).value_or("");
  origin_.meshes = file_.text(MESHES).value_or("");
  origin_.mesh_keys = file_.text(MESH_KEYS).value_or("");
  origin_.mesh_lattices = file_.text(MESH_LATTICES).value_or("");
  origin_.wall_seconds = number(WALL_TIME);
  origin_.kernel_seconds = number(KERNEL_TIME);
  if (!std::isfinite(origin_.wall_seconds)) {
    throw usage_error(path + ": is of a sweep that was not finished; finish it with wholehand sweep --resume");
  }
  if (!checksums_) throw usage_error(path + ": has no checksums of its values; sweep again");
  for (const Variable& variable : variable_catalogue()) {
    if (file_.find(variable.name)) variables_.push_back(&variable);
  }
}

const Variable* SweepResult::find(const std::string& name) const {
  const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const Variable* v) { return v->name == name; });
  return found == variables_.end() ? nullptr : *found;
}

void SweepResult::use(const Scene& scene, const Plan& plan) {
  scene_ = &scene;
  plan_ = &plan;
  if (numbers("vessel_height").shape != std::vector<std::size_t>{scene.vessels.size()})
    throw usage_error(fmt::format("{}: does not have the {} of its own scene", path(), counted(scene.vessels.size(), "vessel")));
  grip_shape_.clear();
  if (plan.is_sobol()) {
    grip_shape_.push_back(plan.grips());
  } else {
    for (const PlanAxis& axis : plan.axes()) grip_shape_.push_back(axis.values.size());
  }
  // a wrong one makes the file foreign, whether or not it is needed later
  for (const Variable* variable : variables_) {
    std::vector<std::size_t> shape{scene.vessels.size()};
    for (const char* dim : variable->dims) {
      const std::string_view name = dim;
      shape.push_back(name == "fill"      ? scene_fills(scene)
                      : name == "tilt"    ? scene.tilts.size()
                      : name == "joint"   ? JOINT_COUNT
                      : name == "contact" ? 2
                                          : 3);
    }
    shape.insert(shape.end(), grip_shape_.begin(), grip_shape_.end());
    check_shape(variable->name, shape);
  }
}

// Ranges of the grips' numbers are not blocks of the file, which has a dimension for each axis. They are divided into the largest ones that begin and
// end at whole steps of an axis.
void SweepResult::read(const Variable& variable, std::size_t vessel, std::size_t plane, std::uint64_t first, std::size_t count,
                       double* out) const {
  const GuardedFile::Stored& stored = numbers(variable.name);
  const std::vector<std::size_t>& shape = stored.shape;
  const std::size_t outer = shape.size() - grip_shape_.size();  // vessel, and the variable's own
  std::vector<std::size_t> start(shape.size(), 0), length(shape.size(), 1);
  start[0] = vessel;
  for (std::size_t k = outer; k-- > 1; plane /= shape[k]) start[k] = plane % shape[k];
  while (count > 0) {
    std::size_t axis = 0;
    const auto step = [&](std::size_t k) { return product(grip_shape_, k + 1); };
    while (axis + 1 < grip_shape_.size() && (first % step(axis) != 0 || step(axis) > count)) ++axis;
    std::uint64_t rest = first;
    for (std::size_t k = 0; k < grip_shape_.size(); ++k) {
      start[outer + k] = rest / step(k);
      rest %= step(k);
      length[outer + k] = k > axis ? grip_shape_[k] : 1;
    }
    const std::uint64_t steps = std::min<std::uint64_t>(grip_shape_[axis] - start[outer + axis], count / step(axis));
    length[outer + axis] = steps;
    read_block(stored, start, length, out);
    const std::uint64_t done = steps * step(axis);
    first += done;
    count -= done;
    out += done;
  }
}

std::vector<double> SweepResult::pick(const Variable& variable, std::size_t vessel, std::size_t plane,
                                      const std::vector<std::uint64_t>& grips) const {
  std::vector<double> values(grips.size());
  const std::uint64_t all = product(grip_shape_, 0);
  if (grips.size() < all / SEEK_IN_VALUES) {
    for (std::size_t i = 0; i < grips.size(); ++i) read(variable, vessel, plane, grips[i], 1, &values[i]);
    return values;
  }
  std::vector<std::size_t> order(grips.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&grips](std::size_t a, std::size_t b) { return grips[a] < grips[b]; });
  std::vector<double> stretch;
  std::size_t next = 0;
  for (std::uint64_t first = 0; next < order.size(); first += AT_ONCE) {
    const std::size_t count = std::min<std::uint64_t>(AT_ONCE, all - first);
    if (grips[order[next]] >= first + count) continue;
    stretch.resize(count);
    read(variable, vessel, plane, first, count, stretch.data());
    for (; next < order.size() && grips[order[next]] < first + count; ++next)
      values[order[next]] = stretch[grips[order[next]] - first];
  }
  return values;
}

bool SweepResult::lists_best() const { return file_.find(BEST_GRIP) != nullptr; }

std::vector<Candidate> SweepResult::best(std::size_t vessel, std::size_t hand_scale) const {
  if (!lists_best()) return {};
  std::vector<std::size_t> lists{vessel};
  if (plan_->hand_scales() > 1) lists.push_back(hand_scale);
  const std::size_t length = ranks(lists.size() + 1);
  const std::vector<double> grips = row(BEST_GRIP, lists, length), scores = row(BEST_SCORE, lists, length);
  std::vector<Candidate> best;
  for (std::size_t rank = 0; rank < grips.size() && grips[rank] >= 0; ++rank) {
    if (!(grips[rank] < static_cast<double>(plan_->grips())) || !std::isfinite(scores[rank]) ||
        plan_->hand_scale_of(static_cast<std::uint64_t>(grips[rank])) != hand_scale)
      throw usage_error(fmt::format("{}: {} names a grip that the sweep did not have", path(), BEST_GRIP));
    best.push_back({scores[rank], static_cast<std::uint64_t>(grips[rank])});
  }
  return best;
}

std::vector<std::optional<RefinedGrip>> SweepResult::refined(std::size_t vessel, std::size_t hand_scale) const {
  constexpr double ROUNDING = 1e-9;  // m or rad; a box ends within 1e-12 of where it ended in the sweep
  const std::vector<Candidate> listed = best(vessel, hand_scale);
  std::vector<std::optional<RefinedGrip>> refined(listed.size());
  if (listed.empty() || !file_.find(REFINED_SCORE)) return refined;
  std::vector<std::size_t> lists{vessel};
  if (plan_->hand_scales() > 1) lists.push_back(hand_scale);
  const std::size_t length = ranks(lists.size() + 1);
  const std::vector<double> scores = row(REFINED_SCORE, lists, length);
  std::array<std::vector<double>, REFINED_COORDINATES> coordinates;
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    coordinates[k] = row(refined_axis_name(plan_->axes()[static_cast<std::size_t>(REFINED_PLACES[k])]), lists, length);
  for (std::size_t rank = 0; rank < listed.size(); ++rank) {
    if (std::isnan(scores[rank])) continue;
    const RefineBox box = refine_box(*plan_, vessel, listed[rank].index);
    std::array<double, REFINED_COORDINATES> place{};
    for (std::size_t k = 0; k < place.size(); ++k) {
      place[k] = coordinates[k][rank];
      if (!(place[k] >= box.low[k] - ROUNDING && place[k] <= box.high[k] + ROUNDING))
        throw usage_error(fmt::format("{}: {} names a grip that the sweep did not refine", path(), REFINED_SCORE));
    }
    refined[rank] = RefinedGrip{with_coordinates(plan_->grip(vessel, listed[rank].index), place), scores[rank]};
  }
  return refined;
}

std::vector<RobustScore> SweepResult::robust(std::size_t vessel, std::size_t hand_scale) const {
  const std::vector<Candidate> listed = best(vessel, hand_scale);
  if (listed.empty() || !scene_->robust) return {};
  std::vector<std::size_t> lists{vessel};
  if (plan_->hand_scales() > 1) lists.push_back(hand_scale);
  const std::size_t length = ranks(lists.size() + 1);
  const std::vector<double> means = row(ROBUST_MEAN, lists, length), lows = row(ROBUST_LOW, lists, length),
                            shares = row(ROBUST_SHARE, lists, length);
  std::vector<RobustScore> robust;
  for (std::size_t rank = 0; rank < listed.size(); ++rank) {
    const std::array<double, 3> all{means[rank], lows[rank], shares[rank]};
    const bool has_scores = std::all_of(all.begin(), all.end(), [](double value) { return value >= 0 && std::isfinite(value); });
    const bool has_none = std::all_of(all.begin(), all.end(), [](double value) { return std::isnan(value); });
    if (rank < MOST_ROBUST ? !has_scores : !has_none)
      throw usage_error(fmt::format("{}: {}, {} and {} of rank {} are {}, {} and {}; allowed: {}", path(), ROBUST_MEAN, ROBUST_LOW,
                                    ROBUST_SHARE, rank + 1, means[rank], lows[rank], shares[rank],
                                    rank < MOST_ROBUST ? "numbers from 0 on" : "no numbers (NaN)"));
    robust.push_back({means[rank], lows[rank], shares[rank]});
  }
  return robust;
}

std::vector<double> SweepResult::pouring_tilts(std::size_t vessel) const {
  return row("pouring_tilt", {vessel}, scene_fills(*scene_));
}

std::vector<double> SweepResult::vessel_heights() const { return of_vessels("vessel_height"); }

std::vector<double> SweepResult::vessel_bases() const { return of_vessels("vessel_base"); }

std::vector<double> SweepResult::empty_masses() const { return of_vessels("empty_mass"); }

std::size_t SweepResult::vessels() const {
  const std::vector<std::size_t>& shape = numbers("vessel_height").shape;
  if (shape.size() != 1 || shape[0] > MOST_VESSELS)
    throw usage_error(fmt::format("{}: vessel_height is not as a sweep writes it", path()));
  return shape[0];
}

std::vector<double> SweepResult::of_vessels(const char* name) const {
  check_shape(name, {vessels()});
  std::vector<double> values(vessels());
  read_block(numbers(name), std::vector<std::size_t>{0}, std::vector<std::size_t>{values.size()}, values.data());
  return values;
}

// The only way to a value. First compares everything that the block covers in the file's order with its checksums.
void SweepResult::read_block(const GuardedFile::Stored& variable, std::span<const std::size_t> start,
                             std::span<const std::size_t> count, double* out) const {
  std::uint64_t first = 0, last = 0;
  for (std::size_t k = 0; k < variable.shape.size(); ++k) {
    first = first * variable.shape[k] + start[k];
    last = last * variable.shape[k] + start[k] + count[k] - 1;
  }
  checksums_->check(variable.name, first, last + 1, product(variable.shape, 0));
  file_.read(variable, start, count, out);
}

const GuardedFile::Stored& SweepResult::numbers(const std::string& name) const {
  const GuardedFile::Stored* stored = file_.find(name);
  if (!stored) throw usage_error(fmt::format("{}: lacks the variable {}", path(), name));
  const auto types = {NC_BYTE, NC_SHORT, NC_INT, NC_INT64, NC_FLOAT, NC_DOUBLE};
  if (std::find(types.begin(), types.end(), stored->type) == types.end())
    throw usage_error(fmt::format("{}: {} is not as a sweep writes it", path(), name));
  return *stored;
}

void SweepResult::check_shape(const std::string& name, const std::vector<std::size_t>& shape) const {
  if (numbers(name).shape != shape)
    throw usage_error(fmt::format("{}: {} does not have the shape that its own scene asks for", path(), name));
}

// Grips in each list of the best, places that were filled included; `dimensions`: of such a variable.
std::size_t SweepResult::ranks(std::size_t dimensions) const {
  const std::vector<std::size_t>& shape = numbers(BEST_GRIP).shape;
  if (shape.size() != dimensions) throw usage_error(fmt::format("{}: {} is not as a sweep writes it", path(), BEST_GRIP));
  if (shape.back() > MOST_BEST)
    throw usage_error(
        fmt::format("{}: {} lists {} grips per vessel, and a sweep lists at most {}", path(), BEST_GRIP, shape.back(), MOST_BEST));
  return shape.back();
}

// A variable over (vessel, length), or (vessel, hand scale, length), at one vessel and hand scale.
std::vector<double> SweepResult::row(const std::string& name, const std::vector<std::size_t>& lists, std::size_t length) const {
  std::vector<std::size_t> shape{vessels()}, start = lists, count(lists.size(), 1);
  if (lists.size() > 1) shape.push_back(plan_->hand_scales());
  shape.push_back(length);
  start.push_back(0);
  count.push_back(length);
  check_shape(name, shape);
  std::vector<double> values(length);
  read_block(numbers(name), start, count, values.data());
  return values;
}

std::string SweepResult::text(const char* name) const {
  const std::optional<std::string> value = file_.text(name);
  if (!value) throw usage_error(fmt::format("{}: is not a result of a sweep: it lacks the attribute {}", path(), name));
  return *value;
}

double SweepResult::number(const char* name) const {
  const std::optional<double> value = file_.number(name);
  if (!value) throw usage_error(fmt::format("{}: is not a result of a sweep: it lacks the attribute {}", path(), name));
  return *value;
}

void set_heights(const SweepResult& result, Scene& scene) {
  const std::vector<double> heights = result.vessel_heights(), bases = result.vessel_bases();
  for (std::size_t v = 0; v < std::min({heights.size(), bases.size(), scene.vessels.size()}); ++v) {
    if (!scene.vessels[v].mesh || scene.vessels[v].mesh->body) continue;
    scene.vessels[v].height = heights[v];
    scene.vessels[v].base = bases[v];
  }
}

}  // namespace wholehand::sweeps
