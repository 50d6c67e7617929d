// SPDX-License-Identifier: MIT
// Files that a command writes into a folder that the user names: it replaces its own files, never others.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace wholehand {

// A table or text of ours, with its name and its first bytes.
struct FolderTable {
  const char* name;
  std::string_view start;
};

// Throws Error (usage) if one of the tables or pictures exists, is not empty and is not `command`'s.
void check_folder_files(const std::string& folder, const char* command, std::span<const FolderTable> tables,
                        std::span<const char* const> pictures);

}  // namespace wholehand
