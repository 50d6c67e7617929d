// SPDX-License-Identifier: MIT
#include "system/folder_files.h"

#include "system/files.h"
#include "system/pictures.h"

namespace wholehand {

bool is_there(const std::string& folder, const FolderTable& table) { return begins_with(folder + "/" + table.name, table.start); }

void check_folder_files(const std::string& folder, const char* command, std::span<const FolderTable> tables,
                        std::span<const char* const> pictures) {
  const std::string table = std::string("table of wholehand ") + command;
  for (const auto& [name, start] : tables) check_overwrites_kind(folder + "/" + name, start, table.c_str(), "-o");
  for (const char* picture : pictures) check_overwrites_picture(folder + "/" + picture, is_there(folder, tables.front()));
}

}  // namespace wholehand
