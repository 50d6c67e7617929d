// SPDX-License-Identifier: MIT
// A NetCDF-4 file, read by a separate process.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wholehand::sweeps {

// HDF5 follows what a damaged file says to places that are not there: it crashes, never ends, or forgets memory, when the file is opened
// and at any value that is read later. So a process that may die of it does all of that and hands over what it found. Its processor time
// for each answer and its memory are limited; whatever goes wrong in it is one line here.
//
// Local files only: NetCDF gets an absolute path, since it takes a relative one in an address's form for an address and sends a request there.
class GuardedFile {
 public:
  // A variable as the file declares it; `type` is NetCDF's.
  struct Stored {
    int id = -1;
    std::string name;
    int type = 0;
    std::vector<std::size_t> shape;
  };

  // Opens the file and reads its structure, its own attributes and a value at both ends of every numeric variable. Throws Error: (usage) one line
  // that begins with the path: it cannot be read, is not a regular file, is damaged or not NetCDF-4; (failure) no process can be started.
  explicit GuardedFile(const std::string& path);
  ~GuardedFile();
  GuardedFile(const GuardedFile&) = delete;
  GuardedFile& operator=(const GuardedFile&) = delete;

  const std::string& path() const { return path_; }
  double bytes() const { return bytes_; }

  // Null if the file does not have the variable.
  const Stored* find(const std::string& name) const;
  // An attribute of the file, or the contents of its variable CHECKSUMS (sweeps/result/result_checksums.h); nothing if it is absent or of another
  // type.
  std::optional<std::string> text(const std::string& name) const;
  std::optional<double> number(const std::string& name) const;  // one NC_DOUBLE

  // A block of a numeric variable, row by row; numbers outside a double's range come as NetCDF converts them. Throws Error (usage).
  void read(const Stored& variable, std::span<const std::size_t> start, std::span<const std::size_t> count, double* out) const;

 private:
  void start(const std::string& name);
  void stop();
  void read_catalogue();
  void take(void* data, std::size_t size) const;
  void send(const void* data, std::size_t size) const;
  void expect_good(const std::string& what) const;
  [[noreturn]] void fail(const std::string& why) const;

  std::string path_;
  double bytes_ = 0;
  pid_t process_ = -1;
  int socket_ = -1;
  std::vector<Stored> variables_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, double> numbers_;
};

}  // namespace wholehand::sweeps
