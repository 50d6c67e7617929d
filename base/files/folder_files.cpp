// SPDX-License-Identifier: MIT
#include "base/files/folder_files.h"

#include "base/files/files.h"
#include "base/files/pictures.h"

namespace wholehand {

void check_folder_files(const std::string& folder, const char* command, std::span<const FolderTable> tables,
                        std::span<const char* const> pictures) {
  const std::string table = std::string("table of wholehand ") + command;
  for (const auto& [name, start] : tables) check_overwrites_kind(folder + "/" + name, start, table.c_str(), "-o");
  for (const char* picture : pictures)
    check_overwrites_marked(folder + "/" + picture, PICTURE_MARK, "picture of wholehand's", "-o");
}

}  // namespace wholehand
