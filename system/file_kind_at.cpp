// SPDX-License-Identifier: MIT
#include "system/file_kind_at.h"

#include <filesystem>
#include <fstream>

namespace wholehand {

FileKind file_kind_at(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return FileKind::unknown;
  std::string head(64 << 10, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  return file_kind(head, failed ? head.size() : size);
}

}  // namespace wholehand
