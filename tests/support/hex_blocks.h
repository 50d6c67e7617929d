// SPDX-License-Identifier: MIT
// Bytes that a page of docs/ shows: each block "```hex NAME"; `#` starts a comment.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace wholehand {

inline std::map<std::string, std::vector<std::uint8_t>> hex_blocks(const std::string& page) {
  std::map<std::string, std::vector<std::uint8_t>> blocks;
  std::ifstream file(std::string(WHOLEHAND_SOURCE_DIR "/docs/") + page);
  std::string name;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```hex ")) {
      name = line.substr(7);
    } else if (line.starts_with("```")) {
      name.clear();
    } else if (!name.empty()) {
      std::istringstream words(line.substr(0, line.find('#')));
      for (std::string word; words >> word;) blocks[name].push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    }
  }
  return blocks;
}

}  // namespace wholehand
