// SPDX-License-Identifier: MIT
#include "app/viewer/files.h"

#include <algorithm>
#include <array>
#include <utility>

namespace wholehand {

const EmbeddedFile* find_view_file(std::string_view path) {
  const auto files = view_files();
  const auto found = std::find_if(files.begin(), files.end(), [path](const EmbeddedFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

std::string_view content_type(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> TYPES{{{".html", "text/html; charset=utf-8"},
                                                                                {".css", "text/css; charset=utf-8"},
                                                                                {".js", "text/javascript; charset=utf-8"},
                                                                                {".json", "application/json"},
                                                                                {".svg", "image/svg+xml"},
                                                                                {".png", "image/png"}}};
  for (const auto& [ending, type] : TYPES) {
    if (path.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

}  // namespace wholehand
