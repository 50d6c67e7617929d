// SPDX-License-Identifier: MIT
#include "base/files/pictures.h"

#include <fmt/format.h>

#include <exception>

#include "base/files/files.h"

namespace wholehand {
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
