// SPDX-License-Identifier: MIT
// Defines a NetCDF-4 file: dimensions, attributes and variables, all contiguous and in native byte order, so that values can later be put in place
// without the library.
#pragma once

#include <netcdf.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sweeps/result/result_checksums.h"

namespace wholehand::sweeps {

// The meanings of integers 0, 1 .., each one word. MISSING may stand for a missing value.
struct IntegerCodes {
  std::vector<std::string> meanings;
  bool may_lack = false;
};

// Every method throws Error (failure) with the file's name and the remedy. The file is discarded unless `finish` was called. Without a file the same
// calls only count its size.
class ResultDefinition {
 public:
  using Names = std::vector<std::string>;

  ResultDefinition() = default;
  // Creates the file, which must not exist.
  explicit ResultDefinition(const std::string& path, std::string remedy = "is the disk full?");
  ~ResultDefinition();
  ResultDefinition(const ResultDefinition&) = delete;
  ResultDefinition& operator=(const ResultDefinition&) = delete;

  void dimension(const std::string& name, std::size_t length);

  // Attributes of a variable, or of the file (NC_GLOBAL).
  void text(int variable, const char* name, const std::string& value);
  void number(int variable, const char* name, double value);
  void numbers(int variable, const char* name, nc_type type, std::size_t count, const void* values);
  // The value that stands for a missing one: NaN or MISSING.
  void fill_value(int variable, nc_type type);

  // A variable with its units and name, whose values come later; not filled.
  int variable(const std::string& name, nc_type type, const Names& dims, const std::string& units, const std::string& long_name);

  // Variables with their values, which `finish` writes. `doubles` returns the variable. Labels belong to the dimension of their name.
  int doubles(const std::string& name, const Names& dims, const std::string& units, const std::string& long_name,
              std::vector<double> values);
  void integers(const std::string& name, const Names& dims, const std::string& units, const std::string& long_name,
                std::vector<int> values, const IntegerCodes& codes = {});
  void strings(const std::string& name, const Names& dims, const std::string& long_name, const Names& values);
  void labels(const std::string& name, const std::string& long_name, const Names& values);

  // The variable of the checksums, with room for those of all variables so far.
  int checksums();

  // Upper bound of the file's bytes so far: values, texts, and HDF5's overhead.
  std::uint64_t size() const { return size_; }

  // Ends the definition, writes the known values, gives the blocks of `later` their places and closes the file.
  void finish(const std::vector<int>& later);

 private:
  void check(int status) const;
  void count_attribute(std::size_t bytes);
  int dimension_id(const std::string& name);
  void allocate(int variable);

  std::string path_, remedy_;
  int file_ = -1;
  int variables_ = 0;
  std::uint64_t size_ = 4096;  // of the file's head
  std::uint64_t checksum_room_ = CHECKSUM_START_ROOM;
  std::map<std::string, std::size_t> lengths_;  // of the dimensions
  std::vector<std::function<void()>> values_;   // written once the definition stands
};

}  // namespace wholehand::sweeps
