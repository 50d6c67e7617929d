// SPDX-License-Identifier: MIT
// Pictures as files: known as ours, and whole or not there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wholehand {

// What every picture of ours has in it, by which it is known.
inline constexpr std::string_view PICTURE_MARK = "<metadata>chart of wholehand</metadata>";

struct PictureFile {
  std::string path;
  std::string svg;
};

// Writes each of them as write_whole_file does. Returns an empty string, or why they are not all there: a sentence for the user, as
// no result depends on its pictures. `written` gets the paths of those that are.
std::string write_pictures(const std::vector<PictureFile>& pictures, std::vector<std::string>* written = nullptr);

}  // namespace wholehand
