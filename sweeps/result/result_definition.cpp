// SPDX-License-Identifier: MIT
#include "sweeps/result/result_definition.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <utility>

#include "base/text/error.h"
#include "base/text/text.h"
#include "sweeps/plan/variables.h"

namespace wholehand::sweeps {
namespace {

// Bytes of a value in the file; for a text, a reference plus its heap's overhead.
std::size_t value_size(nc_type type) {
  constexpr std::size_t REFERENCE = 16, IN_HEAP = 24;
  switch (type) {
    case NC_BYTE:
    case NC_CHAR:
      return 1;
    case NC_INT:
    case NC_FLOAT:
      return 4;
    case NC_STRING:
      return REFERENCE + IN_HEAP;
    default:
      return 8;
  }
}

}  // namespace

ResultDefinition::ResultDefinition(const std::string& path, std::string remedy) : path_(path), remedy_(std::move(remedy)) {
  // absolute, because the library takes a relative path in an address's form for an address
  check(nc_create(std::filesystem::absolute(path).c_str(), NC_NETCDF4 | NC_NOCLOBBER, &file_));
}

ResultDefinition::~ResultDefinition() {
  if (file_ >= 0) nc_abort(file_);
}

void ResultDefinition::check(int status) const {
  if (status == NC_NOERR) return;
  const char* why = status > 0 ? std::strerror(status) : nc_strerror(status);
  throw failure_error(fmt::format("{}: cannot write the result file: {}; {}", path_, why, remedy_));
}

void ResultDefinition::finish(const std::vector<int>& later) {
  check(nc_enddef(file_));
  for (const auto& put : values_) put();
  for (const int variable : later) allocate(variable);
  const int file = file_;
  file_ = -1;
  check(nc_close(file));
}

// HDF5's structures grow with the attributes of each variable and with its dimensions, which are attributes to HDF5: by 300 to 410 bytes for each of
// our attributes, in the files of all kinds of sweeps. A long text moves as its block grows, and leaves the first one empty; the longest have their
// own place.
void ResultDefinition::count_attribute(std::size_t bytes) {
  constexpr std::size_t OF_ATTRIBUTE = 415, LONG = 1 << 10, LARGEST_IN_HEAD = 1 << 16;
  size_ += OF_ATTRIBUTE + bytes + (bytes > LONG && bytes < LARGEST_IN_HEAD ? bytes : 0);
}

void ResultDefinition::dimension(const std::string& name, std::size_t length) {
  lengths_[name] = length;
  if (file_ < 0) return;
  int id = -1;
  check(nc_def_dim(file_, name.c_str(), length, &id));
}

int ResultDefinition::dimension_id(const std::string& name) {
  int id = -1;
  check(nc_inq_dimid(file_, name.c_str(), &id));
  return id;
}

void ResultDefinition::text(int variable, const char* name, const std::string& value) {
  count_attribute(value.size());
  if (file_ < 0) return;
  check(nc_put_att_text(file_, variable, name, value.size(), value.c_str()));
}

void ResultDefinition::number(int variable, const char* name, double value) { numbers(variable, name, NC_DOUBLE, 1, &value); }

int ResultDefinition::variable(const std::string& name, nc_type type, const Names& dims, const std::string& units,
                               const std::string& long_name) {
  std::uint64_t values = 1;
  for (const std::string& dim : dims) values *= lengths_.at(dim);
  size_ += values * value_size(type);
  if (type != NC_STRING)
    checksum_room_ += checksum_room(name, dims.size() > 1 ? lengths_.at(dims[0]) : 0, values * value_size(type));
  int id = variables_++;
  if (file_ >= 0) {
    std::vector<int> ids;
    for (const std::string& dim : dims) ids.push_back(dimension_id(dim));
    check(nc_def_var(file_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id));
    if (type != NC_STRING) {
      if (!ids.empty()) check(nc_def_var_chunking(file_, id, NC_CONTIGUOUS, nullptr));
      check(nc_def_var_fill(file_, id, NC_NOFILL, nullptr));
    }
  }
  if (!units.empty()) text(id, "units", units);
  text(id, "long_name", long_name);
  return id;
}

int ResultDefinition::checksums() {
  dimension(CHECKSUMS, checksum_room_);
  return variable(CHECKSUMS, NC_CHAR, {CHECKSUMS}, "1", "checksums of all that the file holds (XXH3, 128 bits)");
}

void ResultDefinition::numbers(int variable, const char* name, nc_type type, std::size_t count, const void* values) {
  count_attribute(8 * count);
  if (file_ < 0) return;
  check(nc_put_att(file_, variable, name, type, count, values));
}

void ResultDefinition::fill_value(int variable, nc_type type) {
  const double full = std::numeric_limits<double>::quiet_NaN();
  const float real = std::numeric_limits<float>::quiet_NaN();
  const int missing = MISSING;
  const signed char small = MISSING;
  const void* value = &real;
  if (type == NC_DOUBLE) value = &full;
  if (type == NC_BYTE) value = &small;
  if (type == NC_INT) value = &missing;
  numbers(variable, "_FillValue", type, 1, value);
}

int ResultDefinition::doubles(const std::string& name, const Names& dims, const std::string& units, const std::string& long_name,
                              std::vector<double> values) {
  const int id = variable(name, NC_DOUBLE, dims, units, long_name);
  fill_value(id, NC_DOUBLE);
  values_.push_back([this, id, values = std::move(values)] { check(nc_put_var_double(file_, id, values.data())); });
  return id;
}

void ResultDefinition::integers(const std::string& name, const Names& dims, const std::string& units, const std::string& long_name,
                                std::vector<int> values, const IntegerCodes& codes) {
  const int id = variable(name, NC_INT, dims, units, long_name);
  if (codes.may_lack) fill_value(id, NC_INT);
  if (!codes.meanings.empty()) {
    std::vector<int> known(codes.meanings.size());
    std::iota(known.begin(), known.end(), 0);
    numbers(id, "flag_values", NC_INT, known.size(), known.data());
    text(id, "flag_meanings", joined(codes.meanings, " "));
  }
  values_.push_back([this, id, values = std::move(values)] { check(nc_put_var_int(file_, id, values.data())); });
}

void ResultDefinition::labels(const std::string& name, const std::string& long_name, const Names& values) {
  strings(name, {name}, long_name, values);
}

void ResultDefinition::strings(const std::string& name, const Names& dims, const std::string& long_name, const Names& values) {
  const int id = variable(name, NC_STRING, dims, "", long_name);
  for (const std::string& value : values) size_ += value.size();
  values_.push_back([this, id, values] {
    std::vector<const char*> pointers;
    for (const std::string& value : values) pointers.push_back(value.c_str());
    check(nc_put_var_string(file_, id, pointers.data()));
  });
}

// HDF5 gives a contiguous block its place in the file when something is first written to it.
void ResultDefinition::allocate(int id) {
  int dims = 0;
  std::array<int, NC_MAX_VAR_DIMS> ids{};
  check(nc_inq_var(file_, id, nullptr, nullptr, &dims, ids.data(), nullptr));
  std::vector<std::size_t> last(dims);
  for (int k = 0; k < dims; ++k) {
    check(nc_inq_dimlen(file_, ids[k], &last[k]));
    --last[k];
  }
  const std::array<double, 1> zero{};  // large enough for every type
  check(nc_put_var1(file_, id, last.data(), zero.data()));
}

}  // namespace wholehand::sweeps
