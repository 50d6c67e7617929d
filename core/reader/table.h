// SPDX-License-Identifier: MIT
// Checked access to the tables of a scene file: every key is known, of the right type and in its range. Otherwise one line refuses the file, with the
// place, what was found and what is allowed.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/reader/ranges.h"
#include "core/reader/text.h"

namespace wholehand {

// Line and column in a file, from 1; columns count characters.
struct Place {
  int line = 1;
  int column = 1;
};

// The file being read, for messages.
class SceneFile {
 public:
  explicit SceneFile(std::string_view name);

  // Throws Error (usage): `name:line:column: found; allowed`.
  [[noreturn]] void refuse(Place place, const std::string& found, const std::string& allowed) const;

  // `name:line:column`, for checks after reading.
  std::string text_of(Place place) const;

 private:
  std::string name_;
};

// Where a node of the file begins.
Place place_of(const toml::node& node);

// Describes a node for messages: `= 5`, `= 'text'`, `is an array`.
std::string found(const toml::node& node);

// A finite number in its range, in SI. `what` names it in messages.
double read_number(const SceneFile& file, const toml::node& node, const std::string& what, const Quantity& quantity);

// As many numbers as `values` holds, in SI. `form` describes the array in messages, e.g. "[r, y]".
void read_numbers(const SceneFile& file, const toml::node& node, const std::string& what, const std::string& form,
                  const Quantity& quantity, std::span<double> values);

// One table with its allowed keys. Keeps references to the file and the parsed table.
class SceneTable {
 public:
  // `title` names the table in messages, e.g. "[hand]". Throws Error (usage) for the first key of the file that is not in `keys`.
  SceneTable(const SceneFile& file, const toml::table& table, std::string title, std::vector<std::string_view> keys);

  const SceneFile& file() const { return file_; }
  const std::string& title() const { return title_; }
  Place place() const { return place_of(table_); }
  Place place(std::string_view key) const;  // of the key's value; of the table if it is absent

  // The key's value, or null. The key must be one of the table's.
  const toml::node* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }

  // Throws Error (usage) unless the key is there.
  const toml::node& need(std::string_view key, const std::string& allowed) const;

  // Each leaves `value` unchanged if the key is absent.
  void read(std::string_view key, const Quantity& quantity, double& value) const;
  void read(std::string_view key, const Quantity& quantity, const std::string& form, std::span<double> values) const;
  void read(std::string_view key, IntegerRange range, std::int64_t& value) const;
  void read_flag(std::string_view key, bool& value) const;
  // `remedy`: for control characters.
  void read_text(std::string_view key, std::size_t largest, std::string& value, std::string_view remedy = "") const;
  void read_path(std::string_view key, std::string& value) const;
  void read_name(std::string_view key, std::string& value) const;

  // Each throws Error (usage) if the key is absent.
  void need(std::string_view key, const Quantity& quantity, double& value) const;
  void need(std::string_view key, const Quantity& quantity, const std::string& form, std::span<double> values) const;

  // One of a few words.
  template <class Choice>
  void read(std::string_view key, std::initializer_list<std::pair<const char*, Choice>> choices, Choice& value) const {
    std::vector<const char*> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    const int index = choice_index(key, words);
    if (index >= 0) value = choices.begin()[index].second;
  }

  // The array under a key with its size checked; null where the key is absent.
  const toml::array* array(std::string_view key, std::size_t smallest, std::size_t largest, const std::string& allowed) const;

  // The table under a key; nothing where the key is absent.
  std::optional<SceneTable> table(std::string_view key, std::vector<std::string_view> keys) const;
  // The bare TOML table of a key, for keys that only the file knows.
  const toml::table* bare_table(std::string_view key, const std::string& allowed) const;

 private:
  int choice_index(std::string_view key, const std::vector<const char*>& words) const;  // -1: absent

  const SceneFile& file_;
  const toml::table& table_;
  std::string title_;
  std::vector<std::string_view> keys_;
};

}  // namespace wholehand
