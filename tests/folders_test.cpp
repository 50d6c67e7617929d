// SPDX-License-Identifier: MIT
// The house's own rules, read from the sources: a folder includes lower floors only, and no two files need each other.
// sanitizers: none
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

// WHOLEHAND_FLOORS of cmake/folders.cmake.
std::map<std::string, int> floors() {
  const std::string text = file_text(fs::path(WHOLEHAND_SOURCE_DIR) / "cmake/folders.cmake");
  const std::size_t begin = text.find("set(WHOLEHAND_FLOORS"), end = text.find(')', begin);
  const std::string list = text.substr(begin, end - begin);
  const std::regex entry("([a-z]+)=([0-9]+)");
  std::map<std::string, int> found;
  for (std::sregex_iterator it(list.begin(), list.end(), entry), last; it != last; ++it) found[(*it)[1]] = std::stoi((*it)[2]);
  return found;
}

struct Include {
  std::string file;    // from the root: "core/grip.cpp"
  std::string target;  // as it is written: "core/hand.h"
};

std::vector<Include> includes_of(const std::string& file, const std::string& text) {
  static const std::regex line("(?:^|\n)[ \t]*#[ \t]*include[ \t]*\"([^\"\n]+)\"");
  std::vector<Include> found;
  for (std::sregex_iterator it(text.begin(), text.end(), line), last; it != last; ++it) found.push_back({file, (*it)[1]});
  return found;
}

// The includes of every C++ file of the folders that have a floor.
std::vector<Include> all_includes() {
  std::vector<Include> found;
  for (const auto& [folder, floor] : floors())
    for (const auto& entry : fs::directory_iterator(fs::path(WHOLEHAND_SOURCE_DIR) / folder)) {
      const std::string ending = entry.path().extension();
      if (ending != ".cpp" && ending != ".h") continue;
      const auto here = includes_of(folder + "/" + entry.path().filename().string(), file_text(entry.path()));
      found.insert(found.end(), here.begin(), here.end());
    }
  return found;
}

std::string folder_of(const std::string& file) { return file.substr(0, file.find('/')); }
// A header and its source are one.
std::string stem_of(const std::string& file) { return file.substr(0, file.rfind('.')); }

// What an include does wrong; "" if nothing.
std::string fault_of(const Include& include, const std::map<std::string, int>& floors) {
  const std::string from = folder_of(include.file), to = folder_of(include.target);
  const auto floor = floors.find(from), other = floors.find(to);
  if (include.target.find('/') == std::string::npos) return "is not named from the root";
  if (other == floors.end()) return "is in no folder of the product";
  if (from == to) return "";
  return other->second < floor->second ? "" : "goes up or sideways";
}

// The files of each circle, by stems, in one line; empty where there is none.
std::vector<std::string> circles(const std::vector<Include>& includes) {
  std::map<std::string, std::set<std::string>> uses;
  for (const Include& include : includes)
    if (stem_of(include.file) != stem_of(include.target)) uses[stem_of(include.file)].insert(stem_of(include.target));
  // whom each reaches; the graph is small
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [start, targets] : uses) {
    std::vector<std::string> waiting(targets.begin(), targets.end());
    std::set<std::string>& seen = reached[start];
    while (!waiting.empty()) {
      const std::string next = waiting.back();
      waiting.pop_back();
      if (!seen.insert(next).second || !uses.contains(next)) continue;
      waiting.insert(waiting.end(), uses[next].begin(), uses[next].end());
    }
  }
  std::set<std::string> lines;
  for (const auto& [start, seen] : reached) {
    if (!seen.contains(start)) continue;
    std::string line;
    for (const std::string& other : seen)
      if (reached.contains(other) && reached[other].contains(start)) line += (line.empty() ? "" : " ") + other;
    lines.insert(line);
  }
  return {lines.begin(), lines.end()};
}

TEST(Folders, IncludeLowerFloorsOnly) {
  const auto floor = floors();
  ASSERT_GE(floor.size(), 14u);
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 500u);
  for (const Include& include : includes) EXPECT_EQ(fault_of(include, floor), "") << include.file << " includes " << include.target;
}

TEST(Folders, NoTwoFilesNeedEachOther) {
  for (const std::string& circle : circles(all_includes())) ADD_FAILURE() << "a circle: " << circle;
}

// Neither test above would check a folder without a floor.
TEST(Folders, EveryFolderHasAFloor) {
  const auto floor = floors();
  for (const auto& entry : fs::directory_iterator(WHOLEHAND_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.starts_with('.') || name == "build" || name == "cmake" || name == "docs" ||
        name == "examples" || name == "tests")
      continue;
    EXPECT_TRUE(floor.contains(name)) << name << "/ is missing in WHOLEHAND_FLOORS (cmake/folders.cmake)";
  }
}

// What other files list by name: the source archive of the Python package, and the headers that clang-tidy checks.
TEST(Folders, NoListLacksOne) {
  const fs::path root = WHOLEHAND_SOURCE_DIR;
  const std::string archive = "\n" + file_text(root / "MANIFEST.in"), tidy = file_text(root / ".clang-tidy");
  const std::size_t begin = tidy.find("\nHeaderFilterRegex: '/("), end = tidy.find(")/'", begin);
  ASSERT_NE(end, std::string::npos);
  const std::string headers = "|" + tidy.substr(begin + 23, end - begin - 23) + "|";
  for (const auto& [folder, floor] : floors()) {
    EXPECT_NE(archive.find("\ngraft " + folder + "\n"), std::string::npos) << folder << "/ is missing in MANIFEST.in";
    if (folder == "include" || folder == "shaders") continue;  // whose headers are not C++ alone
    EXPECT_NE(headers.find("|" + folder + "|"), std::string::npos) << folder << "/ is missing in HeaderFilterRegex (.clang-tidy)";
  }
}

// Words of `text` that print, and would let a name of a file or a device through as it is.
std::string printing_words(const std::string& text) {
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::string found;
  for (const std::string word : {"fmt::print(", "std::cout", "std::cerr", "std::clog", "printf(", "vprintf(", "fprintf(",
                                 "vfprintf(", "dprintf(", "fputs(", "puts(", "fputc(", "putc(", "putchar(", "fwrite(", "perror("})
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      if (at == 0 || !is_letter(text[at - 1])) found += word + ";";
  return found;
}

TEST(Folders, PrintAtOneDoor) {
  // both make what they print printable; progress draws on a terminal
  const std::set<std::string> doors{"system/output.cpp", "system/progress.cpp"};
  for (const auto& [folder, floor] : floors())
    for (const auto& entry : fs::directory_iterator(fs::path(WHOLEHAND_SOURCE_DIR) / folder)) {
      const std::string name = folder + "/" + entry.path().filename().string(), ending = entry.path().extension();
      if ((ending != ".cpp" && ending != ".h") || doors.contains(name)) continue;
      EXPECT_EQ(printing_words(file_text(entry.path())), "") << name << " prints; system/output.h does";
    }
  EXPECT_EQ(printing_words("a(); std::fprintf(stderr, fmt::print(\"x\")); std::snprintf(b); output.put(c); std::fwrite(d)"),
            "fmt::print(;fprintf(;fwrite(;");
}

TEST(Folders, WhatIsWrongIsFound) {
  const std::map<std::string, int> floor{{"low", 1}, {"beside", 1}, {"high", 2}};
  const auto faults = [&](const std::string& text) {
    std::string all;
    for (const Include& include : includes_of("low/a.cpp", text)) all += fault_of(include, floor) + ";";
    return all;
  };
  EXPECT_EQ(faults("#include \"low/a.h\"\n#include <high/b.h>\n// #include \"high/b.h\"\n"), ";");
  EXPECT_EQ(faults("#include \"high/b.h\"\n"), "goes up or sideways;");
  EXPECT_EQ(faults("x\n  #  include \"beside/b.h\"\n"), "goes up or sideways;");
  EXPECT_EQ(faults("#include \"tests/b.h\"\n#include \"a.h\"\n"), "is in no folder of the product;is not named from the root;");
  EXPECT_EQ(circles({{"a/x.cpp", "a/y.h"}, {"a/y.cpp", "a/z.h"}, {"a/z.h", "a/x.h"}, {"a/w.cpp", "a/x.h"}, {"a/x.cpp", "a/x.h"}}),
            std::vector<std::string>{"a/x a/y a/z"});
  EXPECT_TRUE(circles({{"a/x.cpp", "a/y.h"}, {"a/y.cpp", "a/z.h"}}).empty());
}

}  // namespace
}  // namespace wholehand
