#include "sweeps/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "core/scene.h"
#include "sweeps/readable.h"

namespace wholehand {
namespace {

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Root may write anywhere, and still not make a file in every folder.
void try_folder(const std::string& asked, const std::string& folder, const char* option = "-o") {
  std::string trial = folder + "/.wholehand-XXXXXX";
  const int file = mkstemp(trial.data());
  if (file < 0) {
    throw failure_error(
        fmt::format("{} {}: cannot make a file in {}: {}; name a place elsewhere", option, asked, folder, std::strerror(errno)));
  }
  close(file);
  unlink(trial.c_str());
}

}  // namespace

OutputNames output_names(const std::string& result) {
  OutputNames names;
  names.result = result;
  names.partial = result + ".partial";
  names.mark = names.partial + ".mark";
  names.stem = result.ends_with(".nc") && result.size() > 3 ? result.substr(0, result.size() - 3) : result;
  names.best = names.stem + ".best.csv";
  return names;
}

void check_output_path(const std::string& path, const char* option) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    throw usage_error(
        fmt::format("{} {}: is a {}; name a file", option, path, S_ISDIR(status.st_mode) ? "directory" : "device or pipe"));
  }
  const std::string folder = folder_of(path);
  if (path.empty() || path.ends_with('/') || stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw usage_error(fmt::format("{} {}: {} is not a directory; create it or name another", option, path, folder));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw failure_error(
        fmt::format("{} {}: cannot write to {}: {}; name a file elsewhere", option, path, folder, std::strerror(errno)));
  }
  try_folder(path, folder, option);
}

void check_not_the_scene(const std::string& path, const Scene& scene, const char* option) {
  struct stat written {};
  if (stat(path.c_str(), &written) != 0) return;
  const auto refuse = [&](const std::string& source, const std::string& what) {
    struct stat status {};
    if (stat(source.c_str(), &status) != 0 || status.st_dev != written.st_dev || status.st_ino != written.st_ino) return;
    throw usage_error(fmt::format("{} {}: this is {}; name another file for the results", option, path, what));
  };
  refuse(scene.file, "the scene file itself");
  const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
  for (const VesselData& vessel : scene.vessels) {
    if (vessel.mesh) refuse((folder / vessel.mesh->file).string(), fmt::format("the mesh of vessel '{}'", vessel.name));
  }
}

void check_overwrites_kind(const std::string& path, const std::string& start, const char* what, const char* option) {
  std::ifstream file(path, std::ios::binary);
  std::string head(start.size(), '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (file.gcount() == 0 || head == start) return;  // not there, empty, or its like
  throw usage_error(fmt::format("{} {}: is there and is no {}; name another, or remove it", option, path, what));
}

void check_overwrites_result(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  file.read(head, sizeof head);
  if (file.gcount() == 0) return;  // not there, or empty
  // the signature of HDF5, which NetCDF-4 files are made of
  if (file.gcount() == 8 && std::memcmp(head, "\x89HDF\r\n\x1a\n", 8) == 0) return;
  throw usage_error(fmt::format("-o {}: is there and is no result file; name another, or remove it", path));
}

void make_output_folder(const std::string& path) {
  if (path.empty()) throw usage_error("-o: name a folder");
  if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) {
    const ExitCode code = errno == ENOENT || errno == ENOTDIR ? ExitCode::usage : ExitCode::failure;
    throw Error(code, fmt::format("-o {}: cannot make that folder: {}; name one elsewhere", path, std::strerror(errno)));
  }
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw usage_error(fmt::format("-o {}: is there and is not a folder; name another", path));
  }
  try_folder(path, path);
}

double free_bytes(const std::string& path) {
  struct statvfs disk {};
  double bytes = 1e300;
  if (statvfs(folder_of(path).c_str(), &disk) == 0) bytes = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return bytes;
}

void check_room(const std::string& path, std::uint64_t bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  int error = file < 0 ? errno : 0;
  if (!error && fallocate(file, 0, 0, static_cast<off_t>(bytes)) != 0) {
    error = errno;
    if (error == EOPNOTSUPP || error == ENOSYS) {
      // a file system that cannot reserve: see at least that it takes something
      const std::vector<char> some(std::min<std::uint64_t>(bytes, 1 << 20));
      error = pwrite(file, some.data(), some.size(), 0) == static_cast<ssize_t>(some.size()) ? 0 : ENOSPC;
    }
  }
  if (file >= 0) {
    close(file);
    unlink(path.c_str());
  }
  if (error) {
    throw failure_error(fmt::format("{}: cannot write it ({}): {}; make room, or name another file with -o", path,
                                    readable_bytes(static_cast<double>(bytes)), std::strerror(error)));
  }
}

void sync_folder_of(const std::string& path) {
  const int folder = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

void rename_file(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    throw failure_error(fmt::format("cannot rename {} to {}: {}", from, to, std::strerror(errno)));
  }
}

void write_whole_file(const std::string& path, const std::string& text, bool durable) {
  const std::string temporary = path + ".new";
  unlink(temporary.c_str());  // left over from a process that was killed
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  bool good = file >= 0;
  for (std::size_t done = 0; good && done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    good = written > 0;
    if (good) done += static_cast<std::size_t>(written);
  }
  if (good && durable) good = fsync(file) == 0;
  const int error = errno;
  if (file >= 0) close(file);
  if (!good) {
    unlink(temporary.c_str());
    throw failure_error(fmt::format("cannot write {}: {}", path, std::strerror(error)));
  }
  try {
    rename_file(temporary, path);
  } catch (...) {
    unlink(temporary.c_str());
    throw;
  }
  if (durable) sync_folder_of(path);
}

}  // namespace wholehand
