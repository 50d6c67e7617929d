#include "sweeps/sweep_result.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>

#include "core/error.h"
#include "sweeps/files.h"
#include "sweeps/result_contents.h"

namespace wholehand {
namespace {

constexpr unsigned OPENING_SECONDS = 30;
constexpr std::size_t AT_ONCE = 1 << 18;        // values
constexpr std::uint64_t SEEK_IN_VALUES = 4096;  // reading one value alone takes as long as so many in a row

// The path as the NetCDF library takes it: absolute, since it sees an address in what has one's form, and goes and asks for it.
std::string readable_file(const std::string& path, double& bytes) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    const std::string why = std::strerror(errno), partial = output_names(path).partial;
    if (stat(partial.c_str(), &status) == 0)
      throw usage_error(
          fmt::format("{}: {} is of a sweep that was not finished; finish it with wholehand sweep --resume", path, partial));
    throw usage_error(fmt::format("{}: cannot be read: {}", path, why));
  }
  if (!S_ISREG(status.st_mode)) {
    throw usage_error(fmt::format("{}: is a {}; name the result file of a sweep", path,
                                  S_ISDIR(status.st_mode) ? "directory" : "device or pipe"));
  }
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  if (!file) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  file.read(head, sizeof head);
  if (std::memcmp(head, "CDF", 3) == 0) {
    throw usage_error(
        path + ": is a NetCDF file of the classic format, and no result of a sweep; a recording is read by wholehand session");
  }
  if (std::memcmp(head, "\x89HDF\r\n\x1a\n", 8) != 0) throw usage_error(path + ": is no result file of a sweep (NetCDF-4)");
  bytes = static_cast<double>(status.st_size);
  char* absolute = realpath(path.c_str(), nullptr);
  const std::string name = absolute ? absolute : path;
  std::free(absolute);
  return name;
}

// Reads the first value of a variable, and with it the part of the file where that lies; NetCDF's status.
int try_to_read(int file, int id) {
  int dims = 0;
  nc_type type = NC_NAT;
  int status = nc_inq_var(file, id, nullptr, &type, &dims, nullptr, nullptr);
  if (status != NC_NOERR || type > NC_UINT64 || type == NC_CHAR) return status;
  const std::vector<std::size_t> first(static_cast<std::size_t>(dims) + 1, 0);
  double value = 0;
  status = nc_get_var1_double(file, id, first.data(), &value);
  return status == NC_ERANGE || status == NC_EINVALCOORDS ? NC_NOERR : status;  // no double, or no value at all
}

// Opens the file, and all that it says of its variables and a value of each; NetCDF's status.
int try_to_open(const std::string& name) {
  int file = -1, variables = 0;
  int status = nc_open(name.c_str(), NC_NOWRITE, &file);
  if (status == NC_NOERR) status = nc_inq_nvars(file, &variables);
  for (int id = 0; id < variables && status == NC_NOERR; ++id) status = try_to_read(file, id);
  return status;
}

// Throws where the file cannot be opened. HDF5 follows what a damaged one says to places that are not there, and forgets memory on the way:
// so that is found out by a process that may die of it.
void check_opens(const std::string& path, const std::string& name) {
  constexpr int DIED = 255;
  const pid_t child = fork();
  if (child < 0) return;  // not to be found out
  if (child == 0) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGALRM}) std::signal(signal, [](int) { _exit(DIED); });
    alarm(OPENING_SECONDS);
    const int status = try_to_open(name);  // NetCDF's are above -255; positive: of the system
    _exit(status > 0 ? DIED : -status);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : DIED;
  if (code == 0) return;
  throw usage_error(
      fmt::format("{}: is damaged, or no NetCDF-4 file: {}", path, code == DIED ? "it cannot be read" : nc_strerror(-code)));
}

std::uint64_t product(const std::vector<std::size_t>& lengths, std::size_t first) {
  return std::accumulate(lengths.begin() + static_cast<std::ptrdiff_t>(first), lengths.end(), std::uint64_t{1},
                         std::multiplies<>());
}

}  // namespace

SweepResult::SweepResult(const std::string& path) : path_(path) {
  const std::string name = readable_file(path, origin_.bytes);
  check_opens(path, name);
  const int status = nc_open(name.c_str(), NC_NOWRITE, &file_);
  if (status != NC_NOERR) {
    file_ = -1;
    throw usage_error(fmt::format("{}: is damaged, or no NetCDF-4 file: {}", path, nc_strerror(status)));
  }
  try {
    origin_.scene = text("scene");
    if (text("program") != "wholehand") throw usage_error(path_ + ": is no result of a sweep: another program wrote it");
    origin_.version = text("version");
    origin_.backend = text("backend");
    origin_.device = text("device");
    origin_.driver = text("driver");
    origin_.precision = text("precision") == "float" ? Precision::single : Precision::full;
    origin_.scene_file = text_or_nothing(SCENE_FILE);
    origin_.meshes = text_or_nothing(MESHES);
    origin_.mesh_keys = text_or_nothing(MESH_KEYS);
    origin_.mesh_lattices = text_or_nothing(MESH_LATTICES);
    origin_.wall_seconds = number(WALL_TIME);
    origin_.kernel_seconds = number(KERNEL_TIME);
    if (!std::isfinite(origin_.wall_seconds)) {
      throw usage_error(path_ + ": is of a sweep that was not finished; finish it with wholehand sweep --resume");
    }
    for (const Variable& variable : variable_catalogue()) {
      int id = -1;
      if (nc_inq_varid(file_, variable.name, &id) == NC_NOERR) variables_.push_back(&variable);
    }
  } catch (...) {
    nc_close(file_);
    throw;
  }
}

SweepResult::~SweepResult() { nc_close(file_); }

const Variable* SweepResult::find(const std::string& name) const {
  const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const Variable* v) { return v->name == name; });
  return found == variables_.end() ? nullptr : *found;
}

void SweepResult::use(const Scene& scene, const Plan& plan) {
  scene_ = &scene;
  plan_ = &plan;
  if (shape_of(numbers_id("vessel_height")) != std::vector<std::size_t>{scene.vessels.size()})
    throw usage_error(fmt::format("{}: has not the {} vessels of its own scene", path_, scene.vessels.size()));
  grip_shape_.clear();
  if (plan.is_sobol()) {
    grip_shape_.push_back(plan.grips());
  } else {
    for (const PlanAxis& axis : plan.axes()) grip_shape_.push_back(axis.data.values.size());
  }
  // one that is wrong makes the file foreign, whether or not it is asked for later
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
    checked_id(variable->name, shape);
  }
}

// Ranges of the grips' numbers are no blocks of the file, which has a dimension for each axis: they are taken apart into the largest ones
// that begin and end at whole steps of an axis.
void SweepResult::read(const Variable& variable, std::size_t vessel, std::size_t plane, std::uint64_t first, std::size_t count,
                       double* out) const {
  const int id = numbers_id(variable.name);
  const std::vector<std::size_t> shape = shape_of(id);
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
    const int status = nc_get_vara_double(file_, id, start.data(), length.data(), out);
    if (status != NC_NOERR && status != NC_ERANGE)
      throw usage_error(fmt::format("{}: {} cannot be read: {}", path_, variable.name, nc_strerror(status)));
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

bool SweepResult::lists_best() const {
  int id = -1;
  return nc_inq_varid(file_, BEST_GRIP, &id) == NC_NOERR;
}

std::vector<Candidate> SweepResult::best(std::size_t vessel) const {
  if (!lists_best()) return {};
  const std::vector<std::size_t> shape = shape_of(numbers_id(BEST_GRIP));
  if (shape.size() != 2) throw usage_error(fmt::format("{}: {} is not as a sweep writes it", path_, BEST_GRIP));
  if (shape[1] > MOST_BEST)
    throw usage_error(fmt::format("{}: {} lists {} grips a vessel, and a sweep at most {}", path_, BEST_GRIP, shape[1], MOST_BEST));
  const std::vector<double> grips = row(BEST_GRIP, vessel, shape[1]), scores = row(BEST_SCORE, vessel, shape[1]);
  std::vector<Candidate> best;
  for (std::size_t rank = 0; rank < grips.size() && grips[rank] >= 0; ++rank) {
    if (!(grips[rank] < static_cast<double>(plan_->grips())) || !std::isfinite(scores[rank]))
      throw usage_error(fmt::format("{}: {} names a grip that the sweep did not have", path_, BEST_GRIP));
    best.push_back({scores[rank], static_cast<std::uint64_t>(grips[rank])});
  }
  return best;
}

std::vector<double> SweepResult::pouring_tilts(std::size_t vessel) const {
  return row("pouring_tilt", vessel, scene_fills(*scene_));
}

std::vector<double> SweepResult::vessel_heights() const { return of_vessels("vessel_height"); }

std::vector<double> SweepResult::vessel_bases() const { return of_vessels("vessel_base"); }

std::vector<double> SweepResult::of_vessels(const char* name) const {
  const int id = numbers_id(name);
  const std::vector<std::size_t> shape = shape_of(id);
  if (shape.size() != 1 || shape[0] > MOST_VESSELS)
    throw usage_error(fmt::format("{}: {} is not as a sweep writes it", path_, name));
  std::vector<double> values(shape[0]);
  const int status = nc_get_var_double(file_, id, values.data());
  if (status != NC_NOERR) throw usage_error(fmt::format("{}: {} cannot be read: {}", path_, name, nc_strerror(status)));
  return values;
}

int SweepResult::numbers_id(const std::string& name) const {
  int id = -1;
  nc_type type = NC_NAT;
  if (nc_inq_varid(file_, name.c_str(), &id) != NC_NOERR) throw usage_error(fmt::format("{}: lacks the variable {}", path_, name));
  nc_inq_vartype(file_, id, &type);
  const auto numbers = {NC_BYTE, NC_SHORT, NC_INT, NC_INT64, NC_FLOAT, NC_DOUBLE};
  if (std::find(numbers.begin(), numbers.end(), type) == numbers.end())
    throw usage_error(fmt::format("{}: {} is not as a sweep writes it", path_, name));
  return id;
}

std::vector<std::size_t> SweepResult::shape_of(int id) const {
  int dims = 0;
  nc_inq_varndims(file_, id, &dims);
  std::vector<int> ids(dims);
  nc_inq_vardimid(file_, id, ids.data());
  std::vector<std::size_t> shape(dims);
  for (int k = 0; k < dims; ++k) nc_inq_dimlen(file_, ids[k], &shape[k]);
  return shape;
}

int SweepResult::checked_id(const std::string& name, const std::vector<std::size_t>& shape) const {
  const int id = numbers_id(name);
  if (shape_of(id) != shape) throw usage_error(fmt::format("{}: {} has not the shape that its own scene gives it", path_, name));
  return id;
}

// A variable over (vessel, length) at one vessel.
std::vector<double> SweepResult::row(const std::string& name, std::size_t vessel, std::size_t length) const {
  const int id = checked_id(name, {scene_->vessels.size(), length});
  std::vector<double> values(length);
  const std::size_t start[2] = {vessel, 0}, count[2] = {1, length};
  const int status = nc_get_vara_double(file_, id, start, count, values.data());
  if (status != NC_NOERR) throw usage_error(fmt::format("{}: {} cannot be read: {}", path_, name, nc_strerror(status)));
  return values;
}

std::string SweepResult::text(const char* name) const {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (nc_inq_att(file_, NC_GLOBAL, name, &type, &length) != NC_NOERR || type != NC_CHAR)
    throw usage_error(fmt::format("{}: is no result of a sweep: it lacks the attribute {}", path_, name));
  std::string value(length, ' ');
  if (length > 0) nc_get_att_text(file_, NC_GLOBAL, name, value.data());
  return value;
}

std::string SweepResult::text_or_nothing(const char* name) const {
  return nc_inq_attid(file_, NC_GLOBAL, name, nullptr) == NC_NOERR ? text(name) : "";
}

double SweepResult::number(const char* name) const {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  double value = 0;
  if (nc_inq_att(file_, NC_GLOBAL, name, &type, &length) != NC_NOERR || type != NC_DOUBLE || length != 1 ||
      nc_get_att_double(file_, NC_GLOBAL, name, &value) != NC_NOERR) {
    throw usage_error(fmt::format("{}: is no result of a sweep: it lacks the attribute {}", path_, name));
  }
  return value;
}

}  // namespace wholehand
