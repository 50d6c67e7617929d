// SPDX-License-Identifier: MIT
#include "tests/support/result_reader.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cstring>

namespace wholehand {
namespace {

// An open file; closes itself.
struct Reader {
  explicit Reader(const std::string& file) {
    const int status = nc_open(file.c_str(), NC_NOWRITE, &id);
    EXPECT_EQ(status, NC_NOERR) << file << ": " << nc_strerror(status);
  }
  ~Reader() { nc_close(id); }
  int id = -1;
};

// How many values a variable has, and its id. Adds a test failure and answers 0 where it is not there.
std::size_t size_of_variable(const Reader& reader, const std::string& variable, int& id) {
  int dims = 0;
  std::array<int, NC_MAX_VAR_DIMS> ids{};
  EXPECT_EQ(nc_inq_varid(reader.id, variable.c_str(), &id), NC_NOERR) << variable;
  if (nc_inq_var(reader.id, id, nullptr, nullptr, &dims, ids.data(), nullptr) != NC_NOERR) return 0;
  std::size_t size = 1;
  for (int k = 0; k < dims; ++k) {
    std::size_t length = 0;
    nc_inq_dimlen(reader.id, ids[k], &length);
    size *= length;
  }
  return size;
}

}  // namespace

std::vector<double> read_values(const std::string& file, const std::string& variable) {
  const Reader reader(file);
  int id = -1;
  std::vector<double> values(size_of_variable(reader, variable, id));
  if (values.empty()) return {};
  EXPECT_EQ(nc_get_var_double(reader.id, id, values.data()), NC_NOERR) << variable;
  return values;
}

std::vector<std::string> read_strings(const std::string& file, const std::string& variable) {
  const Reader reader(file);
  int id = -1;
  std::vector<char*> texts(size_of_variable(reader, variable, id));
  if (texts.empty() || nc_get_var_string(reader.id, id, texts.data()) != NC_NOERR) {
    ADD_FAILURE() << variable;
    return {};
  }
  const std::vector<std::string> strings(texts.begin(), texts.end());
  nc_free_string(texts.size(), texts.data());
  return strings;
}

std::string read_text(const std::string& file, const std::string& variable, const std::string& attribute) {
  const Reader reader(file);
  int id = NC_GLOBAL;
  EXPECT_EQ(variable.empty() ? NC_NOERR : nc_inq_varid(reader.id, variable.c_str(), &id), NC_NOERR) << variable;
  std::size_t length = 0;
  EXPECT_EQ(nc_inq_attlen(reader.id, id, attribute.c_str(), &length), NC_NOERR) << variable << ":" << attribute;
  std::string text(length, ' ');
  EXPECT_EQ(nc_get_att_text(reader.id, id, attribute.c_str(), text.data()), NC_NOERR) << variable << ":" << attribute;
  return text;
}

std::vector<std::string> dimension_names(const std::string& file, const std::string& variable) {
  const Reader reader(file);
  int id = -1, dims = 0;
  std::array<int, NC_MAX_VAR_DIMS> ids{};
  EXPECT_EQ(nc_inq_varid(reader.id, variable.c_str(), &id), NC_NOERR) << variable;
  nc_inq_var(reader.id, id, nullptr, nullptr, &dims, ids.data(), nullptr);
  std::vector<std::string> names;
  for (int k = 0; k < dims; ++k) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_inq_dimname(reader.id, ids[k], name.data());
    names.emplace_back(name.data());
  }
  return names;
}

std::vector<std::string> variable_names(const std::string& file) {
  const Reader reader(file);
  int count = 0;
  nc_inq_nvars(reader.id, &count);
  std::vector<std::string> names;
  for (int id = 0; id < count; ++id) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_inq_varname(reader.id, id, name.data());
    names.emplace_back(name.data());
  }
  return names;
}

void expect_same_values(const std::string& file, const std::string& other) {
  const std::vector<std::string> names = variable_names(file);
  ASSERT_EQ(names, variable_names(other));
  const Reader reader(file);
  for (const std::string& name : names) {
    int id = -1;
    nc_type type = NC_NAT;
    nc_inq_varid(reader.id, name.c_str(), &id);
    nc_inq_vartype(reader.id, id, &type);
    if (type == NC_STRING || type == NC_CHAR) continue;  // checksums cover the times, too
    const std::vector<double> a = read_values(file, name), b = read_values(other, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0) << name;
  }
}

}  // namespace wholehand
