// SPDX-License-Identifier: MIT
#include "system/pictures.h"

#include <fmt/format.h>

#include <exception>

#include "system/files.h"

namespace wholehand {
namespace {

constexpr std::string_view MARK_BY_GNUPLOT = "<title>wholehand</title>";
constexpr std::string_view MARK_OF_VERSION_0_1_0 = "<title>Gnuplot</title>";

}  // namespace

bool is_own_picture(const std::string& path, bool is_beside_own) {
  return has_mark(path, PICTURE_MARK) || has_mark(path, MARK_BY_GNUPLOT) ||
         (is_beside_own && has_mark(path, MARK_OF_VERSION_0_1_0));
}

void check_overwrites_picture(const std::string& path, bool is_beside_own) {
  if (!is_own_picture(path, is_beside_own)) check_overwrites_marked(path, PICTURE_MARK, "picture of wholehand's", "-o");
}

std::string write_pictures(const std::vector<PictureFile>& pictures, std::vector<std::string>* written) {
  std::string first;
  std::size_t missing = 0;
  for (const PictureFile& picture : pictures) {
    try {
      write_whole_file(picture.path, picture.svg, false);
      if (written) written->push_back(picture.path);
    } catch (const std::exception& error) {
      if (missing++ == 0) first = error.what();
    }
  }
  if (missing == 0) return {};
  return missing == 1 ? "no picture: " + first : fmt::format("{} of {} pictures are missing: {}", missing, pictures.size(), first);
}

}  // namespace wholehand
