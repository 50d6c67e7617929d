// SPDX-License-Identifier: MIT
// The house's own rules, read from the sources: a folder includes those before it only, and no two files need each other.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

// A list of cmake/folders.cmake.
std::vector<std::string> cmake_list(const std::string& name) {
  const std::string text = file_text(fs::path(WHOLEHAND_SOURCE_DIR) / "cmake/folders.cmake"), head = "set(" + name;
  const std::size_t begin = text.find(head) + head.size();
  std::istringstream list(text.substr(begin, text.find(')', begin) - begin));
  return {std::istream_iterator<std::string>(list), {}};
}

// The folders in their order, and the doors of those that do not use each other.
struct House {
  std::vector<std::string> folders, wings;
};

House house() { return {cmake_list("WHOLEHAND_FOLDERS"), cmake_list("WHOLEHAND_WINGS")}; }

std::string door_of(const std::string& path) { return path.substr(0, path.find('/')); }

std::vector<std::string> doors(const House& all) {
  std::vector<std::string> found;
  for (const std::string& folder : all.folders)
    if (std::find(found.begin(), found.end(), door_of(folder)) == found.end()) found.push_back(door_of(folder));
  return found;
}

// The C++ files of the product, from the root: "core/grip.cpp".
std::vector<std::string> product_files() {
  const fs::path root = WHOLEHAND_SOURCE_DIR;
  std::vector<std::string> found;
  for (const std::string& door : doors(house()))
    for (const auto& entry : fs::recursive_directory_iterator(root / door)) {
      const std::string ending = entry.path().extension();
      if (ending == ".cpp" || ending == ".h") found.push_back(fs::relative(entry.path(), root).string());
    }
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

// The includes of every C++ file of the product.
std::vector<Include> all_includes() {
  std::vector<Include> found;
  for (const std::string& file : product_files()) {
    const auto here = includes_of(file, file_text(fs::path(WHOLEHAND_SOURCE_DIR) / file));
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

// The place of a file's folder in the order; past the end: it is in none of them.
std::size_t place_of(const std::string& file, const House& all) {
  std::size_t best = all.folders.size(), longest = 0;
  for (std::size_t i = 0; i < all.folders.size(); ++i) {
    const std::string& folder = all.folders[i];
    if (folder.size() > longest && file.starts_with(folder + "/")) best = i, longest = folder.size();
  }
  return best;
}

// A header and its source are one.
std::string stem_of(const std::string& file) { return file.substr(0, file.rfind('.')); }

// What an include does wrong; "" if nothing.
std::string fault_of(const Include& include, const House& all) {
  if (include.target.find('/') == std::string::npos) return "is not named from the root";
  const std::size_t from = place_of(include.file, all), to = place_of(include.target, all);
  if (to == all.folders.size()) return "is in no folder of the product";
  if (to > from) return "comes later";
  const auto is_wing = [&](const std::string& file) {
    return std::find(all.wings.begin(), all.wings.end(), door_of(file)) != all.wings.end();
  };
  const bool is_across = is_wing(include.file) && is_wing(include.target) && door_of(include.file) != door_of(include.target);
  return is_across ? "is of the other wing" : "";
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

TEST(Folders, IncludeThoseBeforeThemOnly) {
  const House all = house();
  ASSERT_GE(all.folders.size(), 30u);
  ASSERT_EQ(all.wings.size(), 2u);
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 500u);
  for (const Include& include : includes) EXPECT_EQ(fault_of(include, all), "") << include.file << " includes " << include.target;
}

TEST(Folders, NoTwoFilesNeedEachOther) {
  for (const std::string& circle : circles(all_includes())) ADD_FAILURE() << "a circle: " << circle;
}

// Neither test above would check a folder without a place in the order.
TEST(Folders, EveryFolderHasAPlace) {
  const House all = house();
  const std::vector<std::string> first = doors(all);
  for (const auto& entry : fs::directory_iterator(WHOLEHAND_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.starts_with('.') || name == "build" || name == "cmake" || name == "docs" ||
        name == "examples" || name == "tests")
      continue;
    EXPECT_NE(std::find(first.begin(), first.end(), name), first.end()) << name << "/ is no door (cmake/folders.cmake)";
  }
  const std::set<std::string> packages{"app/c/wholehand", "app/python/wholehand"};  // part of the folder above
  for (const std::string& file : product_files()) {
    const std::string folder = file.substr(0, file.rfind('/'));
    EXPECT_TRUE(packages.contains(folder) || std::find(all.folders.begin(), all.folders.end(), folder) != all.folders.end())
        << file << " is in no folder of WHOLEHAND_FOLDERS (cmake/folders.cmake)";
  }
}

// What other files list by name: the source archive of the Python package, the files and headers that clang-tidy checks, what the launcher watches,
// and the table of README.
TEST(Folders, NoListLacksADoor) {
  const fs::path root = WHOLEHAND_SOURCE_DIR;
  const std::string archive = "\n" + file_text(root / "MANIFEST.in"), tidy = file_text(root / ".clang-tidy");
  const std::size_t begin = tidy.find("\nHeaderFilterRegex: '/("), end = tidy.find(")/'", begin);
  ASSERT_NE(end, std::string::npos);
  const std::string headers = "|" + tidy.substr(begin + 23, end - begin - 23) + "|";
  const std::string ci = file_text(root / ".ci/run");
  const std::size_t checked = ci.find("^$PWD/("), after = ci.find(')', checked);
  ASSERT_NE(after, std::string::npos);
  const std::string tidied = "|" + ci.substr(checked + 7, after - checked - 7) + "|";
  const std::string launcher = file_text(root / "wholehand"), readme = file_text(root / "README.md");
  const std::size_t parts = launcher.find("\nparts='"), last = launcher.find("'\n", parts);
  ASSERT_NE(last, std::string::npos);
  const std::string watched = " " + launcher.substr(parts + 8, last - parts - 8) + " ";
  for (const std::string& door : doors(house())) {
    EXPECT_NE(archive.find("\ngraft " + door + "\n"), std::string::npos) << door << "/ is missing in MANIFEST.in";
    EXPECT_NE(watched.find(" " + door + " "), std::string::npos) << door << "/ is missing in the parts of the launcher";
    EXPECT_NE(readme.find("\n| `" + door + "/` |"), std::string::npos) << door << "/ is missing in README.md";
    if (door == "shaders") continue;  // whose headers are not C++ alone
    EXPECT_NE(headers.find("|" + door + "|"), std::string::npos) << door << "/ is missing in HeaderFilterRegex (.clang-tidy)";
    EXPECT_NE(tidied.find("|" + door + "|"), std::string::npos) << door << "/ is missing in .ci/run";
  }
}

// base/ would serve any program.
TEST(Folders, BaseKnowsNoGrip) {
  const std::regex word("\\b(grip|hand|vessel)s?\\b", std::regex::icase);
  for (const std::string& file : product_files()) {
    if (!file.starts_with("base/")) continue;
    const std::string text = file_text(fs::path(WHOLEHAND_SOURCE_DIR) / file);
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, word)) << file << " says " << found.str();
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
  const std::set<std::string> printers{"base/system/output.cpp", "base/system/progress.cpp"};
  for (const std::string& file : product_files()) {
    if (printers.contains(file)) continue;
    const std::string text = file_text(fs::path(WHOLEHAND_SOURCE_DIR) / file);
    EXPECT_EQ(printing_words(text), "") << file << " prints; base/system/output.h does";
  }
  EXPECT_EQ(printing_words("a(); std::fprintf(stderr, fmt::print(\"x\")); std::snprintf(b); output.put(c); std::fwrite(d)"),
            "fmt::print(;fprintf(;fwrite(;");
}

TEST(Folders, WhatIsWrongIsFound) {
  const House all{{"low/first", "low", "left/a", "right/b", "high"}, {"left", "right"}};
  const auto faults = [&](const std::string& file, const std::string& text) {
    std::string found;
    for (const Include& include : includes_of(file, text)) found += fault_of(include, all) + ";";
    return found;
  };
  EXPECT_EQ(faults("low/a.cpp", "#include \"low/b.h\"\n#include <high/b.h>\n// #include \"high/b.h\"\n"), ";");
  EXPECT_EQ(faults("low/a.cpp", "x\n  #  include \"high/b.h\"\n#include \"low/first/b.h\"\n"), "comes later;;");
  EXPECT_EQ(faults("low/first/a.cpp", "#include \"low/b.h\"\n"), "comes later;");
  EXPECT_EQ(faults("right/b/a.cpp", "#include \"left/a/b.h\"\n#include \"low/b.h\"\n"), "is of the other wing;;");
  EXPECT_EQ(faults("low/a.cpp", "#include \"tests/b.h\"\n#include \"a.h\"\n"),
            "is in no folder of the product;is not named from the root;");
  EXPECT_EQ(circles({{"a/x.cpp", "a/y.h"}, {"a/y.cpp", "a/z.h"}, {"a/z.h", "a/x.h"}, {"a/w.cpp", "a/x.h"}, {"a/x.cpp", "a/x.h"}}),
            std::vector<std::string>{"a/x a/y a/z"});
  EXPECT_TRUE(circles({{"a/x.cpp", "a/y.h"}, {"a/y.cpp", "a/z.h"}}).empty());
}

}  // namespace
}  // namespace wholehand
