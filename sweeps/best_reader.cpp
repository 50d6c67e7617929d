#include "sweeps/best_reader.h"

#include <fmt/format.h>
#include <netcdf.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "sweeps/result_contents.h"

namespace wholehand {
namespace {

// A result file that is only read.
class FinishedFile {
 public:
  explicit FinishedFile(const std::string& path) : path_(path) {
    const int status = nc_open(path.c_str(), NC_NOWRITE, &file_);
    if (status > 0) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(status)));
    if (status != NC_NOERR) throw usage_error(fmt::format("{}: is no result of a sweep: {}", path, nc_strerror(status)));
  }
  ~FinishedFile() { nc_close(file_); }
  FinishedFile(const FinishedFile&) = delete;
  FinishedFile& operator=(const FinishedFile&) = delete;

  // A global attribute; empty where there is none.
  std::string text(const char* name) const {
    std::size_t length = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(file_, NC_GLOBAL, name, &type, &length) != NC_NOERR || type != NC_CHAR) return "";
    std::string value(length, ' ');
    if (length > 0) check(nc_get_att_text(file_, NC_GLOBAL, name, value.data()));
    return value;
  }
  double number(const char* name) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    nc_get_att_double(file_, NC_GLOBAL, name, &value);
    return value;
  }
  std::size_t length(const char* dimension) const {
    int id = -1;
    std::size_t count = 0;
    if (nc_inq_dimid(file_, dimension, &id) == NC_NOERR) check(nc_inq_dimlen(file_, id, &count));
    return count;
  }
  // A variable over (vessel, rank).
  std::vector<double> ranked(const std::string& name, std::size_t vessels, std::size_t ranks) const {
    int id = -1, dimensions = 0;
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    if (nc_inq_varid(file_, name.c_str(), &id) != NC_NOERR)
      throw usage_error(fmt::format("{}: is no result of a sweep: it lacks {}", path_, name));
    check(nc_inq_var(file_, id, nullptr, nullptr, &dimensions, ids.data(), nullptr));
    std::array<std::size_t, 2> lengths{};
    for (int k = 0; k < std::min(dimensions, 2); ++k) check(nc_inq_dimlen(file_, ids[k], &lengths[k]));
    if (dimensions != 2 || lengths != std::array{vessels, ranks})
      throw usage_error(fmt::format("{}: is no result of a sweep: {} is not over vessels and ranks", path_, name));
    std::vector<double> values(vessels * ranks);
    if (!values.empty()) check(nc_get_var_double(file_, id, values.data()));
    return values;
  }

 private:
  void check(int status) const {
    if (status != NC_NOERR) throw usage_error(fmt::format("{}: cannot be read: {}", path_, nc_strerror(status)));
  }
  std::string path_;
  int file_ = -1;
};

}  // namespace

RecordedBest read_best(const std::string& path) {
  const FinishedFile file(path);
  RecordedBest best;
  best.scene_text = file.text("scene");
  best.scene_file = file.text(SCENE_FILE);
  if (best.scene_text.empty()) throw usage_error(fmt::format("{}: is no result of a sweep: it lacks the scene", path));
  // written last
  if (!std::isfinite(file.number(WALL_TIME)))
    throw usage_error(fmt::format("{}: is not finished; go on with wholehand sweep --resume", path));
  const std::size_t vessels = file.length("vessel"), ranks = file.length("rank");
  if (ranks == 0) throw usage_error(fmt::format("{}: holds no best grips; sweep with --best 1 or more", path));
  const auto read = [&](const char* name) { return file.ranked(name, vessels, ranks); };
  const std::vector<double> score = read(BEST_SCORE), height = read("best_height"), azimuth = read("best_azimuth"),
                            obliquity = read("best_obliquity"), roll = read("best_roll"), offset = read("best_offset"),
                            hand_scale = read("best_hand_scale");
  best.vessels.resize(vessels);
  for (std::size_t k = 0; k < vessels * ranks; ++k) {
    const GripInput grip{height[k], azimuth[k], obliquity[k], roll[k], offset[k], hand_scale[k]};
    // what is missing of the ranks is filled
    const double sum = score[k] + grip.height + grip.azimuth + grip.obliquity + grip.roll + grip.offset + grip.hand_scale;
    if (std::isfinite(sum)) best.vessels[k / ranks].push_back({grip, score[k]});
  }
  return best;
}

}  // namespace wholehand
