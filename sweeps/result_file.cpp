#include "sweeps/result_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5/serial/hdf5.h>
#include <netcdf.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

using Clock = std::chrono::steady_clock;

// Adds the time of a scope to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  double& sum_;
  Clock::time_point start_ = Clock::now();
};

// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Whether this process is the only one that writes the file. A process that was killed a moment ago may not be gone quite.
bool lock(int file) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return true;  // a file system without locks
    usleep(10000);
  }
  return false;
}

// HDF5 prints its own stack of errors unless told not to; ours are one line.
void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// The partial file is under this process's lock already; HDF5's own would collide with it.
hid_t open_hdf5(const std::string& path, unsigned mode) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  return H5Fopen(path.c_str(), mode, access);
}

// Place of a variable's block in the file, bytes.
std::uint64_t block_offset(hid_t file, const std::string& name) {
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const haddr_t offset = dataset >= 0 ? H5Dget_offset(dataset) : HADDR_UNDEF;
  if (offset == HADDR_UNDEF) throw failure_error("no place for the variable " + name);
  return offset;
}

// Overwrites the value of an attribute, in place: the file's structure stays as it is.
bool put_attribute(hid_t file, const char* name, double value) {
  const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
}

// The axes' values of a grip in the order of Plan::axes().
std::array<double, 6> axis_values(const GripInput& grip) {
  return {grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale, grip.height};
}

}  // namespace

ResultFile::ResultFile(const OutputNames& names, const ResultContents& contents, const FieldSet& fields, bool resume)
    : names_(names), contents_(contents), fields_(fields) {
  silence_hdf5();
  file_ = open(names_.partial.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file_ >= 0 && !lock(file_)) {
    close(file_);
    throw failure_error(
        fmt::format("{}: another process is writing it; wait for it, or name another file with -o", names_.partial));
  }
  if (!resume) {
    // a new file under the old name: never onto what somebody may still have open
    if (file_ >= 0) close(file_);
    file_ = -1;
    unlink(names_.mark.c_str());
    if (unlink(names_.partial.c_str()) != 0 && errno != ENOENT) fail("replace", errno);
    // HDF5 does not survive a disk that fills up under it
    check_room(names_.partial, result_size(contents_));
    try {
      define_result_file(names_.partial, contents_);
    } catch (...) {
      unlink(names_.partial.c_str());
      throw;
    }
    file_ = open(names_.partial.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (file_ >= 0) lock(file_);
  }
  if (file_ < 0) fail("open", errno);
  try {
    open_blocks();
    struct stat status {};
    if (fstat(file_, &status) != 0) fail("read", errno);
    // file systems that cannot reserve are told apart from those that lack the room
    if (!resume && fallocate(file_, 0, 0, status.st_size) != 0 && errno != EOPNOTSUPP && errno != ENOSYS)
      fail("reserve room for", errno);
  } catch (...) {
    close(file_);
    if (!resume) unlink(names_.partial.c_str());
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

void ResultFile::open_blocks() {
  const Handle file(open_hdf5(names_.partial, H5F_ACC_RDONLY), H5Fclose);
  if (file < 0)
    throw failure_error(fmt::format("{}: cannot be read as a result file; start again without --resume", names_.partial));
  try {
    const std::size_t real_size = contents_.info.precision == Precision::single ? sizeof(float) : sizeof(double);
    for (const Variable* variable : contents_.variables) {
      if (!is_kept(fields_, variable->field)) throw failure_error(fmt::format("{} is not read back", variable->name));
      const std::size_t size = variable->type == NumberType::real ? real_size : variable->type == NumberType::byte ? 1 : 4;
      blocks_.push_back({variable, block_offset(file, variable->name), variable_planes(*variable, contents_.scene), size,
                         fields_.plane[variable->field] + variable->plane});
    }
    const auto& axes = contents_.plan.axes();
    if (contents_.plan.is_sobol() && !contents_.variables.empty()) {
      for (const PlanAxis& axis : axes) axis_offsets_.push_back(block_offset(file, axis.name));
    }
    if (contents_.best > 0) {
      best_offsets_ = {block_offset(file, BEST_GRIP), block_offset(file, BEST_SCORE)};
      for (const PlanAxis& axis : axes) best_offsets_.push_back(block_offset(file, best_axis_name(axis)));
    }
  } catch (const Error& error) {
    throw failure_error(fmt::format("{}: {}; start again without --resume", names_.partial, error.what()));
  }
}

void ResultFile::put(const void* data, std::size_t size, std::uint64_t offset) {
  const auto* from = static_cast<const unsigned char*>(data);
  bytes_ += size;
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
    const bool exists = variable.always || (status[i] & STATUS_REASON_MASK) == REASON_NONE;
    const std::int32_t value = exists ? variable.value(chunk.uints[start + i]) : MISSING;
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
  const Plan& plan = contents_.plan;
  for (const Block& block : blocks_) {
    for (std::size_t plane = 0; plane < block.planes; ++plane) {
      const void* values = plane_values(block, plane, chunk);
      const std::uint64_t place = (chunk.vessel * block.planes + plane) * plan.stored_grips() + chunk.first;
      for (std::uint64_t copy = 0; copy < plan.copies(); ++copy) {
        put(values, chunk.count * block.size, block.offset + (place + copy * plan.grips()) * block.size);
      }
    }
  }
  if (chunk.vessel > 0) return;  // every vessel has the same points
  for (std::size_t axis = 0; axis < axis_offsets_.size(); ++axis) {
    buffer_.resize(chunk.count * sizeof(double));
    plan.coordinates(static_cast<int>(axis), chunk.first, chunk.count, reinterpret_cast<double*>(buffer_.data()));
    put(buffer_.data(), buffer_.size(), axis_offsets_[axis] + chunk.first * sizeof(double));
  }
}

void ResultFile::sync() {
  const Stopwatch stopwatch(seconds_);
  if (fsync(file_) != 0) fail("write", errno);
}

void ResultFile::start_sync() {
  const Stopwatch stopwatch(seconds_);
  sync_file_range(file_, 0, 0, SYNC_FILE_RANGE_WRITE);  // a hint: sync() is what counts
}

void ResultFile::write_ending(const std::vector<std::vector<RankedGrip>>& best, double wall_seconds, double kernel_seconds) {
  const Stopwatch stopwatch(seconds_);
  const std::size_t ranks = contents_.best;
  for (std::size_t v = 0; v < best.size() && ranks > 0; ++v) {
    std::vector<std::int64_t> grips(ranks, MISSING);
    std::vector<std::vector<double>> reals(best_offsets_.size() - 1,
                                           std::vector<double>(ranks, std::numeric_limits<double>::quiet_NaN()));
    for (std::size_t rank = 0; rank < std::min(ranks, best[v].size()); ++rank) {
      const RankedGrip& ranked = best[v][rank];
      grips[rank] = static_cast<std::int64_t>(ranked.candidate.index);
      reals[0][rank] = ranked.candidate.score;
      const auto values = axis_values(ranked.grip);
      for (std::size_t axis = 0; axis < values.size(); ++axis) reals[1 + axis][rank] = values[axis];
    }
    put(grips.data(), ranks * sizeof(std::int64_t), best_offsets_[0] + v * ranks * sizeof(std::int64_t));
    for (std::size_t k = 0; k < reals.size(); ++k) {
      put(reals[k].data(), ranks * sizeof(double), best_offsets_[k + 1] + v * ranks * sizeof(double));
    }
  }
  const Handle file(open_hdf5(names_.partial, H5F_ACC_RDWR), H5Fclose);
  if (file < 0 || !put_attribute(file, WALL_TIME, wall_seconds) || !put_attribute(file, KERNEL_TIME, kernel_seconds)) {
    fail("write", EIO);
  }
}

void ResultFile::finish() {
  sync();
  const Stopwatch stopwatch(seconds_);
  close(file_);
  file_ = -1;
  rename_file(names_.partial, names_.result);
  sync_folder_of(names_.result);
  unlink(names_.mark.c_str());
}

FinishedResult read_finished(const std::string& path, const std::vector<std::string>& variables) {
  const auto refuse = [&path] {
    return usage_error(
        fmt::format("-o {}: is there and is no result of a sweep; name another file, or start without --resume", path));
  };
  struct File {
    explicit File(const std::string& name) : status(nc_open(name.c_str(), NC_NOWRITE, &id)) {}
    ~File() {
      if (status == NC_NOERR) nc_close(id);
    }
    int id = -1, status;
  } file(path);
  if (file.status != NC_NOERR) throw refuse();
  const auto text = [&](const char* name) {
    std::size_t length = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(file.id, NC_GLOBAL, name, &type, &length) != NC_NOERR || type != NC_CHAR) throw refuse();
    std::string value(length, ' ');
    if (length > 0 && nc_get_att_text(file.id, NC_GLOBAL, name, value.data()) != NC_NOERR) throw refuse();
    return value;
  };
  FinishedResult finished{text("scene"), text("backend"), text("precision"), {}};
  for (const std::string& name : variables) {
    int id = -1;
    if (nc_inq_varid(file.id, name.c_str(), &id) != NC_NOERR) finished.missing.push_back(name);
  }
  return finished;
}

}  // namespace wholehand
