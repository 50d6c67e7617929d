// SPDX-License-Identifier: MIT
#include "sweeps/run/merge.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>

#include "base/files/files.h"
#include "base/files/output_lock.h"
#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_file.h"
#include "sweeps/result/shard.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t AT_ONCE = std::size_t{1} << 20;         // bytes
constexpr std::uint64_t UNTIL_SYNC = std::uint64_t{1} << 26;  // bytes that may wait for the disk before writing back starts

class OpenFile {
 public:
  OpenFile(const std::string& path, int flags) : file_(open(path.c_str(), flags | O_CLOEXEC)) {
    if (file_ < 0) throw failure_error(fmt::format("cannot open {}: {}", path, std::strerror(errno)));
    posix_fadvise(file_, 0, 0, POSIX_FADV_RANDOM);  // what would be read ahead is mostly holes
  }
  ~OpenFile() { close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  operator int() const { return file_; }

 private:
  int file_;
};

class Merge {
 public:
  explicit Merge(const MergeRequest& request) : request_(request), names_(output_names(request.result)), buffer_(AT_ONCE) {}

  ExitCode run() {
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows past its limit is an error of the write
    const double start = monotonic_now();
    struct stat status {};
    if (stat(names_.partial.c_str(), &status) != 0) throw usage_error(no_sweep());
    check_output_path(names_.result, "RESULT.nc");
    if (struct stat other{};
        stat(names_.target.c_str(), &other) == 0 && other.st_size > 0 && !begins_with(names_.target, NETCDF4_START))
      throw usage_error(names_.result + " is there and is no result file; move it away, and merge again");
    const OutputLock lock(names_.lock);
    read_mark();
    find_shards();
    const OpenFile result(names_.partial, O_RDWR | O_NOFOLLOW);
    // a file system that cannot reserve is no error; one without the room is
    if (fstat(result, &status) != 0 || (fallocate(result, 0, 0, status.st_size) != 0 && errno != EOPNOTSUPP && errno != ENOSYS))
      fail_writing();
    InterruptGuard interrupt;
    Progress progress(grips_, 0, "grips");
    for (std::size_t v = 0; v < mark_.vessels.size(); ++v)
      if (!take_vessel(v, result, interrupt, progress)) return interrupted(progress);
    if (fsync(result) != 0) fail_writing();
    progress.clear();
    if (!has_name(result, names_.partial))
      throw failure_error(names_.partial + " was replaced or removed while the shards were merged; the result was not named");
    check_readable(names_);
    write_checksums(result, names_.partial, checksum_parts(names_.partial));
    name_result(names_);
    const double seconds = monotonic_now() - start;
    print(fmt::format("wrote {} ({}): {}, {} of them from {}\n{} s ({}/s); the shards can be removed\n", one_line(names_.result),
                      readable_bytes(static_cast<double>(status.st_size)), counted(grips_, "grip"), readable_number(from_shards_),
                      one_line(names_of_shards()), fixed_text(seconds, 2), readable_bytes(static_cast<double>(bytes_) / seconds)));
    return ExitCode::done;
  }

 private:
  std::string no_sweep() const {
    if (begins_with(names_.target, NETCDF4_START) && !names_.target.ends_with(".partial"))
      return names_.result + " is one file, so nothing is left to merge";
    return names_.partial + " is not there; name the result that `wholehand-mpi sweep --shards` wrote, in its folder of rank 0";
  }

  void read_mark() {
    if (!load_mark(names_.mark, mark_, "copy it again from where the sweep ran"))
      throw usage_error(names_.mark + " is not there; copy it from where " + names_.partial + " comes from");
    if (!mark_.shards) throw usage_error(names_.partial + " has no shards; the sweep goes on in it with --resume");
    if (!mark_.shards->is_ended)
      throw failure_error(names_.partial + " is of a sweep that did not end; end it with --resume before its shards are merged");
    if (!has_structure(names_.partial, mark_))
      throw failure_error(names_.partial + " is damaged: it changed after the sweep; copy it again, or start the sweep again");
    for (const VesselProgress& vessel : mark_.vessels) grips_ += vessel.done;
  }

  // The file of every shard that the mark names.
  void find_shards() {
    std::map<std::string, std::uint64_t> wanted;
    for (const VesselProgress& vessel : mark_.vessels)
      for (const Stretch& stretch : vessel.stretches)
        if (!stretch.shard.empty()) wanted[stretch.shard] += stretch.last - stretch.first;
    std::vector<std::string> missing, unusable;
    for (const auto& [name, grips] : wanted) {
      from_shards_ += grips;
      std::vector<std::string> places{shard_path(names_, name)};
      const std::string file = places[0].substr(places[0].find_last_of('/') + 1);
      for (const std::string& folder : request_.folders) places.push_back(folder + "/" + file);
      const auto place =
          std::find_if(places.begin(), places.end(), [&](const std::string& path) { return is_shard(path, mark_.shards->id); });
      if (place != places.end()) {
        shards_[name] = *place;
        continue;
      }
      missing.push_back(file);
      for (const std::string& path : places)
        if (const std::string why = why_no_shard(path); !why.empty()) unusable.push_back(path + " " + why);
    }
    if (!unusable.empty())
      throw usage_error(fmt::format("{}; copy {} of this sweep beside {}, or name its folder with --from", joined(unusable, ", "),
                                    joined(missing, ", "), names_.partial));
    if (missing.empty()) return;
    throw usage_error(fmt::format("{} of this sweep {} in none of the folders; copy {} beside {}, or name a folder with --from",
                                  joined(missing, ", "), missing.size() > 1 ? "are" : "is", missing.size() > 1 ? "them" : "it",
                                  names_.partial));
  }

  // False: interrupted.
  bool take_vessel(std::size_t v, int result, InterruptGuard& interrupt, Progress& progress) {
    std::string open_name;
    std::unique_ptr<OpenFile> shard;
    for (const Stretch& stretch : mark_.vessels[v].stretches) {
      if (interrupt.signalled()) return false;
      if (!stretch.shard.empty() && (!shard || stretch.shard != open_name)) {
        shard = std::make_unique<OpenFile>(shards_.at(stretch.shard), O_RDONLY);
        open_name = stretch.shard;
      }
      take(v, stretch, stretch.shard.empty() ? result : static_cast<int>(*shard), result);
      done_ += stretch.last - stretch.first;
      progress.update("merging", done_);
    }
    return true;
  }

  // Reads a stretch, once for each azimuth for which it stands, and puts it into the result if it comes from elsewhere.
  void take(std::size_t v, const Stretch& stretch, int from, int result) {
    const RunLayout& layout = mark_.shards->layout;
    for (std::uint64_t copy = 0; copy < layout.copies; ++copy) {
      RunsChecksum found;
      layout.visit(v, stretch.first, stretch.last - stretch.first, copy,
                   [&](std::size_t run, FileRange place) { take(run, place, found, from, result); });
      if (found.text() == stretch.checksum) continue;
      const std::string file = stretch.shard.empty() ? names_.partial : shards_.at(stretch.shard);
      throw failure_error(
          fmt::format("{}: grips {} to {} of vessel {} are damaged; copy the file again, or compute them again with the "
                      "sweep's --resume",
                      file, readable_number(stretch.first), readable_number(stretch.last - 1), v + 1));
    }
  }

  void take(std::size_t run, FileRange place, RunsChecksum& found, int from, int result) {
    while (place.size > 0) {
      const ssize_t got =
          pread(from, buffer_.data(), std::min<std::uint64_t>(place.size, AT_ONCE), static_cast<off_t>(place.offset));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw failure_error(fmt::format("cannot read a shard: {}", std::strerror(errno)));
      if (got == 0) return;  // the file ends here, as its checksum will show
      const auto size = static_cast<std::size_t>(got);
      found.add(run, buffer_.data(), size);
      bytes_ += size;
      if (from != result) put(size, place.offset, result);
      place.offset += size;
      place.size -= size;
    }
  }

  void put(std::size_t size, std::uint64_t offset, int result) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t written = pwrite(result, buffer_.data() + done, size - done, static_cast<off_t>(offset + done));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail_writing();
      done += static_cast<std::size_t>(written);
    }
    unsynced_ += size;
    if (unsynced_ < UNTIL_SYNC) return;
    sync_file_range(result, 0, 0, SYNC_FILE_RANGE_WRITE);  // so that little is left for the end
    unsynced_ = 0;
  }

  [[noreturn]] void fail_writing() const {
    throw failure_error(fmt::format("{}: cannot write it: {}; make room, and merge again", names_.partial, std::strerror(errno)));
  }

  ExitCode interrupted(Progress& progress) const {
    progress.clear();
    print_note("interrupted; the same command begins again, and the shards are as they were");
    return ExitCode::interrupted;
  }

  std::string names_of_shards() const {
    std::vector<std::string> names;
    for (const auto& [name, path] : shards_) names.push_back(path);
    return joined(names, ", ");
  }

  const MergeRequest& request_;
  OutputNames names_;
  SweepMark mark_;
  std::map<std::string, std::string> shards_;  // paths
  std::vector<unsigned char> buffer_;
  std::uint64_t grips_ = 0, from_shards_ = 0, done_ = 0, bytes_ = 0, unsynced_ = 0;
};

}  // namespace

ExitCode merge_shards(const MergeRequest& request) { return Merge(request).run(); }

}  // namespace wholehand::sweeps
