// SPDX-License-Identifier: MIT
#include "sweeps/result/result_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

#include "base/files/files.h"
#include "base/system/clock.h"
#include "base/text/error.h"
#include "shaders/layout.h"
#include "shaders/status.h"
#include "sweeps/result/guarded_file.h"
#include "sweeps/result/hdf5_file.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {
namespace {

// Adds the time of a scope to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += monotonic_now() - start_; }

 private:
  double& sum_;
  double start_ = monotonic_now();
};

// Place of a variable's block in the file, bytes.
std::uint64_t block_offset(hid_t file, const std::string& name) {
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const haddr_t offset = dataset >= 0 ? H5Dget_offset(dataset) : HADDR_UNDEF;
  if (offset == HADDR_UNDEF) throw failure_error("no place for the variable " + name);
  return offset;
}

// Overwrites the value of an attribute, in place: the file's structure stays as it is.
bool put_attribute(hid_t file, const char* name, double value) {
  const Hdf5Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
}

// The axes' values of a grip in the order of Plan::axes().
std::array<double, 6> axis_values(const GripInput& grip) {
  return {grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale, grip.height};
}

}  // namespace

ResultFile::ResultFile(const OutputNames& names, const ResultContents& contents, const FieldSet& fields, FileStart start,
                       const OpenOutput& open_output)
    : names_(names), contents_(contents), fields_(fields) {
  if (start != FileStart::resumed) create(start);
  file_ = open(names_.partial.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file_ < 0) fail("open", errno);
  try {
    places_ = find_places();
    set_blocks();
    struct stat status {};
    if (fstat(file_, &status) != 0) fail("read", errno);
    // a file system that cannot reserve is no error; one without the room is
    if (start == FileStart::reserved && fallocate(file_, 0, 0, status.st_size) != 0 && errno != EOPNOTSUPP && errno != ENOSYS)
      fail("reserve room for", errno);
    if (open_output) output_ = open_output(names_.partial);
  } catch (...) {
    close(file_);
    if (start != FileStart::resumed) unlink(names_.partial.c_str());
    throw;
  }
}

ResultFile::ResultFile(const OutputNames& names, const ResultContents& contents, const FieldSet& fields, const FilePlaces& places,
                       const OpenOutput& open_output)
    : names_(names), contents_(contents), fields_(fields), places_(places) {
  file_ = open(names_.partial.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file_ < 0) fail("open", errno);
  try {
    set_blocks();
    if (open_output) output_ = open_output(names_.partial);
  } catch (...) {
    close(file_);
    throw;
  }
}

// A new file under the old name: never over one that may still be open elsewhere.
void ResultFile::create(FileStart start) {
  unlink(names_.mark.c_str());
  if (unlink(names_.partial.c_str()) != 0 && errno != ENOENT) fail("replace", errno);
  // HDF5 crashes if the disk fills up while it writes
  if (start == FileStart::reserved) check_room(names_.partial, result_size(contents_));
  try {
    define_result_file(names_.partial, contents_);
  } catch (...) {
    unlink(names_.partial.c_str());
    throw;
  }
}

ResultFile::~ResultFile() {
  if (file_ >= 0) close(file_);
}

void ResultFile::fail(const char* what, int error) const {
  throw failure_error(fmt::format("{}: cannot {} it: {}; make room and go on with --resume, or name another file with -o",
                                  names_.partial, what, std::strerror(error)));
}

FilePlaces ResultFile::find_places() const {
  const Hdf5Handle file(open_hdf5(names_.partial, H5F_ACC_RDONLY), H5Fclose);
  if (file < 0)
    throw failure_error(fmt::format("{}: cannot be read as a result file; start again without --resume", names_.partial));
  try {
    FilePlaces places;
    const Hdf5Handle checksums(H5Dopen2(file, CHECKSUMS, H5P_DEFAULT), H5Dclose);
    places.checksums = {block_offset(file, CHECKSUMS), H5Dget_storage_size(checksums)};
    for (const Variable* variable : contents_.variables) places.variables.push_back(block_offset(file, variable->name));
    const auto& axes = contents_.plan.axes();
    if (contents_.plan.is_sobol() && !contents_.variables.empty()) {
      for (const PlanAxis& axis : axes) places.axes.push_back(block_offset(file, axis.name));
      if (contents_.plan.height_is_fraction()) places.height = block_offset(file, HEIGHT);
    }
    if (contents_.best > 0) {
      places.best = {block_offset(file, BEST_GRIP), block_offset(file, BEST_SCORE)};
      for (const PlanAxis& axis : axes) places.best.push_back(block_offset(file, best_axis_name(axis)));
      places.best.push_back(block_offset(file, REFINED_SCORE));
      for (const PlanAxis& axis : axes)
        if (is_refined_axis(axis)) places.best.push_back(block_offset(file, refined_axis_name(axis)));
      if (contents_.scene.robust)
        for (const char* name : {ROBUST_MEAN, ROBUST_LOW, ROBUST_SHARE}) places.best.push_back(block_offset(file, name));
    }
    return places;
  } catch (const Error& error) {
    throw failure_error(fmt::format("{}: {}; start again without --resume", names_.partial, error.what()));
  }
}

void ResultFile::set_blocks() {
  const std::size_t real_size = contents_.info.precision == Precision::single ? sizeof(float) : sizeof(double);
  for (std::size_t i = 0; i < contents_.variables.size(); ++i) {
    const Variable& variable = *contents_.variables[i];
    if (!is_kept(fields_, variable.field)) throw failure_error(fmt::format("{} is not read back", variable.name));
    const std::size_t size = variable.type == NumberType::real ? real_size : variable.type == NumberType::byte ? 1 : 4;
    blocks_.push_back({{places_.variables[i], variable_planes(variable, contents_.scene), size},
                       &variable,
                       fields_.plane[variable.field] + variable.plane});
  }
  layout_ = {contents_.plan.grips(), contents_.plan.copies(), {blocks_.begin(), blocks_.end()}, places_.height, places_.axes};
}

void ResultFile::put(const void* data, std::size_t size, std::uint64_t offset) {
  const auto* from = static_cast<const unsigned char*>(data);
  bytes_ += size;
  if (output_) {
    if (const int error = output_->write(data, size, offset); error != 0) fail("write", error);
    return;
  }
  while (size > 0) {
    const ssize_t written = pwrite(file_, from, size, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write", written < 0 ? errno : EIO);
    from += written;
    size -= static_cast<std::size_t>(written);
    offset += static_cast<std::uint64_t>(written);
  }
}

// The chunk's own plane where it is already what the file holds, otherwise a converted copy.
const void* ResultFile::plane_values(const Block& block, std::size_t plane, const PlaneChunk& chunk) {
  const std::size_t start = (block.plane + plane) * chunk.stride;
  const Variable& variable = *block.variable;
  if (variable.type == NumberType::real) {
    if (block.size == sizeof(float) && chunk.floats) return chunk.floats + start;
    if (block.size == sizeof(double) && chunk.doubles) return chunk.doubles + start;
  }
  buffer_.resize(block.size * chunk.count);
  if (variable.type == NumberType::real) {
    const int at = block.plane + static_cast<int>(plane);
    auto* floats = reinterpret_cast<float*>(buffer_.data());
    auto* doubles = reinterpret_cast<double*>(buffer_.data());
    for (std::size_t i = 0; i < chunk.count; ++i) {
      if (block.size == sizeof(float)) {
        floats[i] = static_cast<float>(chunk.real(at, i));
      } else {
        doubles[i] = chunk.real(at, i);
      }
    }
    return buffer_.data();
  }
  const std::uint32_t* status = chunk.uints + fields_.plane[FIELD_STATUS] * chunk.stride;
  auto* words = reinterpret_cast<std::int32_t*>(buffer_.data());
  auto* bytes = reinterpret_cast<std::int8_t*>(buffer_.data());
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const bool exists = variable.always || is_feasible(status[i]);
    const std::int32_t value = exists ? variable.value(chunk.uints[start + i]) : variable.missing;
    if (variable.type == NumberType::word) {
      words[i] = value;
    } else {
      bytes[i] = static_cast<std::int8_t>(value);
    }
  }
  return buffer_.data();
}

void ResultFile::write(const PlaneChunk& chunk) {
  const Stopwatch stopwatch(seconds_);
  if (chunk.vessel != stretch_vessel_ || chunk.first != stretch_.last || stretch_.first == stretch_.last) {
    checksum_ = RunsChecksum();
    stretch_ = {chunk.first, chunk.first, ""};
    stretch_vessel_ = chunk.vessel;
  }
  std::vector<FileRange> places;
  const std::uint64_t copies = contents_.plan.copies();
  for (std::uint64_t copy = 0; copy < copies; ++copy) {
    layout_.visit(chunk.vessel, chunk.first, chunk.count, copy, [&](std::size_t, FileRange place) { places.push_back(place); });
  }
  const std::size_t runs = places.size() / copies;
  const auto write_run = [&](std::size_t run, const void* values) {
    checksum_.add(run, values, places[run].size);
    for (std::uint64_t copy = 0; copy < copies; ++copy) put(values, places[run].size, places[copy * runs + run].offset);
  };
  std::size_t run = 0;
  for (const Block& block : blocks_) {
    for (std::size_t plane = 0; plane < block.planes; ++plane, ++run) write_run(run, plane_values(block, plane, chunk));
  }
  if (places_.height) {
    buffer_.resize(chunk.count * sizeof(double));
    auto* heights = reinterpret_cast<double*>(buffer_.data());
    contents_.plan.coordinates(PLACE_HEIGHT, chunk.first, chunk.count, heights);
    for (std::size_t i = 0; i < chunk.count; ++i) heights[i] = contents_.plan.height(chunk.vessel, heights[i]);
    write_run(run++, heights);
  }
  for (std::size_t axis = 0; run < runs; ++axis, ++run) {
    buffer_.resize(chunk.count * sizeof(double));
    contents_.plan.coordinates(static_cast<int>(axis), chunk.first, chunk.count, reinterpret_cast<double*>(buffer_.data()));
    write_run(run, buffer_.data());
  }
  stretch_.last += chunk.count;
}

Stretch ResultFile::stretch() const { return {stretch_.first, stretch_.last, checksum_.text()}; }

void ResultFile::end_stretch() { stretch_ = {}; }

bool ResultFile::holds(std::size_t vessel, const Stretch& stretch) {
  for (std::uint64_t copy = 0; copy < contents_.plan.copies(); ++copy) {
    RunsChecksum found;
    layout_.visit(vessel, stretch.first, stretch.last - stretch.first, copy, [&](std::size_t run, FileRange place) {
      if (!add_range(found, run, file_, place)) fail("read", errno);
    });
    if (found.text() != stretch.checksum) return false;
  }
  return true;
}

const ResultFile::Block* ResultFile::block_of(const char* variable) const {
  for (const Block& block : blocks_)
    if (std::strcmp(block.variable->name, variable) == 0) return &block;
  return nullptr;
}

bool ResultFile::has_eligible() const {
  return block_of("score") && block_of("plausible") && (!has_effort(contents_.scene) || block_of("not_held"));
}

std::vector<Candidate> ResultFile::eligible(std::size_t vessel, std::uint64_t first, std::uint64_t last) const {
  // opened anew, because a network file system shows others' writes when a file is opened
  const int file = open(names_.partial.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) fail("open", errno);
  const auto read_block = [&](const char* name, void* to) {
    const Block& block = *block_of(name);
    auto* bytes = static_cast<char*>(to);
    std::uint64_t place = block.offset + (vessel * contents_.plan.stored_grips() + first) * block.size;
    for (std::uint64_t left = (last - first) * block.size; left > 0;) {
      const ssize_t got = pread(file, bytes, left, static_cast<off_t>(place));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        const int error = got < 0 ? errno : EIO;
        close(file);
        fail("read", error);
      }
      bytes += got;
      place += static_cast<std::uint64_t>(got);
      left -= static_cast<std::uint64_t>(got);
    }
  };
  const std::size_t count = last - first;
  std::vector<std::int8_t> plausible(count), not_held(count, 0);
  std::vector<float> floats;
  std::vector<double> doubles;
  const bool is_float = block_of("score")->size == sizeof(float);
  if (is_float) {
    floats.resize(count);
    read_block("score", floats.data());
  } else {
    doubles.resize(count);
    read_block("score", doubles.data());
  }
  read_block("plausible", plausible.data());
  if (block_of("not_held")) read_block("not_held", not_held.data());
  close(file);
  std::vector<Candidate> grips;
  for (std::size_t i = 0; i < count; ++i)
    if (plausible[i] == 1 && not_held[i] == 0) grips.push_back({is_float ? static_cast<double>(floats[i]) : doubles[i], first + i});
  return grips;
}

// What changes after the definition, in the file's order.
std::vector<FileRange> ResultFile::written_in_place() const {
  const Plan& plan = contents_.plan;
  const std::uint64_t vessels = contents_.scene.vessels.size();
  std::vector<FileRange> ranges;
  for (const Block& block : blocks_) ranges.push_back({block.offset, vessels * block.planes * plan.stored_grips() * block.size});
  for (const std::uint64_t offset : places_.axes) ranges.push_back({offset, plan.grips() * sizeof(double)});
  if (places_.height) ranges.push_back({*places_.height, vessels * plan.grips() * sizeof(double)});
  for (const std::uint64_t offset : places_.best) {
    ranges.push_back({offset, vessels * plan.hand_scales() * contents_.best * sizeof(double)});
  }
  if (places_.checksums.size > 0) ranges.push_back(places_.checksums);
  std::sort(ranges.begin(), ranges.end(), [](const FileRange& a, const FileRange& b) { return a.offset < b.offset; });
  return ranges;
}

void ResultFile::vouch_for_structure(SweepMark& mark) {
  if (structure_.empty()) {
    const auto structure = checksum_without(file_, written_in_place());
    if (!structure) fail("read", errno);
    structure_ = *structure;
  }
  mark.structure = structure_;
  mark.in_place = written_in_place();
}

void ResultFile::sync() {
  const Stopwatch stopwatch(seconds_);
  if (sync_error_ == 0) sync_error_ = output_ ? output_->sync() : fsync(file_) == 0 ? 0 : errno;
  if (sync_error_ != 0) fail("write", sync_error_);
}

std::uint64_t ResultFile::inode() const {
  struct stat status {};
  if (fstat(file_, &status) != 0) fail("read", errno);
  return status.st_ino;
}

void ResultFile::check_own() const {
  if (has_name(file_, names_.partial)) return;
  struct stat named {};
  const bool is_there = lstat(names_.partial.c_str(), &named) == 0;
  throw failure_error(fmt::format("{}: another job {} this file meanwhile; this job ends and leaves everything to the other one",
                                  names_.partial, is_there ? "replaced" : "took away"));
}

void ResultFile::start_sync() {
  const Stopwatch stopwatch(seconds_);
  sync_file_range(file_, 0, 0, SYNC_FILE_RANGE_WRITE);  // a hint: sync() is what counts
}

void ResultFile::write_ending(const BestLists& best, double wall_seconds, double kernel_seconds) {
  const Stopwatch stopwatch(seconds_);
  const std::size_t ranks = contents_.best;
  for (std::size_t list = 0; list < best.size() && ranks > 0; ++list) {
    std::vector<std::int64_t> grips(ranks, MISSING);
    std::vector<std::vector<double>> reals(places_.best.size() - 1,
                                           std::vector<double>(ranks, std::numeric_limits<double>::quiet_NaN()));
    for (std::size_t rank = 0; rank < std::min(ranks, best[list].size()); ++rank) {
      const BestGrip& ranked = best[list][rank];
      grips[rank] = static_cast<std::int64_t>(ranked.candidate.index);
      reals[0][rank] = ranked.candidate.score;
      const auto values = axis_values(ranked.grip);
      for (std::size_t axis = 0; axis < values.size(); ++axis) reals[1 + axis][rank] = values[axis];
      if (contents_.scene.robust) {
        reals[reals.size() - 3][rank] = ranked.robust.mean;
        reals[reals.size() - 2][rank] = ranked.robust.low;
        reals[reals.size() - 1][rank] = ranked.robust.share;
      }
      if (std::isnan(ranked.refined_score)) continue;
      const auto refined = axis_values(ranked.refined);
      std::size_t k = 1 + values.size();
      reals[k++][rank] = ranked.refined_score;
      for (std::size_t axis = 0; axis < refined.size(); ++axis)
        if (is_refined_axis(contents_.plan.axes()[axis])) reals[k++][rank] = refined[axis];
    }
    put(grips.data(), ranks * sizeof(std::int64_t), places_.best[0] + list * ranks * sizeof(std::int64_t));
    for (std::size_t k = 0; k < reals.size(); ++k) {
      put(reals[k].data(), ranks * sizeof(double), places_.best[k + 1] + list * ranks * sizeof(double));
    }
  }
  check_own();  // HDF5 opens it by its name
  const Hdf5Handle file(open_hdf5(names_.partial, H5F_ACC_RDWR), H5Fclose);
  if (file < 0 || !put_attribute(file, WALL_TIME, wall_seconds) || !put_attribute(file, KERNEL_TIME, kernel_seconds)) {
    fail("write", EIO);
  }
  structure_.clear();  // the times are part of it
}

void ResultFile::drop_cached() { posix_fadvise(file_, 0, 0, POSIX_FADV_DONTNEED); }  // a hint

void ResultFile::finish(ChecksumParts parts) {
  sync();
  const Stopwatch stopwatch(seconds_);
  check_own();
  check_readable(names_);
  if (parts.parts.empty()) parts = checksum_parts(names_.partial);
  write_checksums(file_, names_.partial, std::move(parts));
  check_own();  // reading it may have taken long
  name_result(names_);
  close(file_);
  file_ = -1;
}

void check_readable(const OutputNames& names) {
  try {
    const GuardedFile file(names.partial);
  } catch (const Error& error) {
    // a failed attempt says nothing about the file
    const char* remedy = error.code == ExitCode::failure ? "go on with --resume" : "start again without --resume";
    throw failure_error(fmt::format("{} (found when the sweep read the file back); {}", error.what(), remedy));
  }
}

void name_result(const OutputNames& names) {
  rename_file(names.partial, names.target);
  sync_folder_of(names.target);
  unlink(names.mark.c_str());
}

}  // namespace wholehand::sweeps
