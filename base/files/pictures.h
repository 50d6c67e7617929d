// SPDX-License-Identifier: MIT
// Picture files that the program recognizes as its own, and that are either complete or absent.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wholehand {

// Every picture of ours contains this text, which identifies it.
inline constexpr std::string_view PICTURE_MARK = "<metadata>chart of wholehand</metadata>";

struct PictureFile {
  std::string path;
  std::string svg;
};

// Writes each picture as write_whole_file does. Returns an empty string, or a sentence for the user that says why some are missing (no result depends
// on its pictures). `written` gets the paths of the written ones.
std::string write_pictures(const std::vector<PictureFile>& pictures, std::vector<std::string>* written = nullptr);

}  // namespace wholehand
