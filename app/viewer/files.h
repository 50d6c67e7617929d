// SPDX-License-Identifier: MIT
// The viewer's page: the files of app/viewer/page/ and three.js, embedded by the build (cmake/embed_files.cmake).
#pragma once

#include <span>
#include <string_view>

namespace wholehand {

struct EmbeddedFile {
  std::string_view path;  // below app/viewer/, with slashes
  std::string_view bytes;
};

std::span<const EmbeddedFile> view_files();

// The file of that path, or null; its content type for a browser, by its ending.
const EmbeddedFile* find_view_file(std::string_view path);
std::string_view content_type(std::string_view path);

}  // namespace wholehand
