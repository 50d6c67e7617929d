// SPDX-License-Identifier: MIT
// What a command writes into a folder that the user names: its own files are replaced, those of others are not.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace wholehand {

// A table or text of ours, by its name and by how it begins.
struct FolderTable {
  const char* name;
  std::string_view start;
};

// Throws Error (usage) where one of the tables or pictures is there, has something in it and is not of `command`.
void check_folder_files(const std::string& folder, const char* command, std::span<const FolderTable> tables,
                        std::span<const char* const> pictures);

}  // namespace wholehand
