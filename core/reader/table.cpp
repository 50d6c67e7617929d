// SPDX-License-Identifier: MIT
#include "core/reader/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text/error.h"
#include "base/text/printable.h"
#include "core/file_kind.h"
#include "core/scene.h"

namespace wholehand {
namespace {

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

// The title of a table inside another: "[hand]" and "thumb" make "[hand.thumb]"; the outermost one has no brackets.
std::string inner_title(std::string_view outer, std::string_view key) {
  if (outer.empty() || outer[0] != '[') return fmt::format("[{}]", key);
  const auto begin = outer.find_first_not_of('[');
  return fmt::format("[{}.{}]", outer.substr(begin, outer.find(']') - begin), key);
}

}  // namespace

SceneFile::SceneFile(std::string_view name) : name_(one_line(name)) {}

void SceneFile::refuse(Place place, const std::string& found, const std::string& allowed) const {
  throw usage_error(fmt::format("{}: {}; {}", text_of(place), found, allowed));
}

std::string SceneFile::text_of(Place place) const { return fmt::format("{}:{}:{}", name_, place.line, place.column); }

Place place_of(const toml::node& node) {
  const auto begin = node.source().begin;
  if (begin.line == 0) return {};
  return {static_cast<int>(begin.line), static_cast<int>(begin.column)};
}

std::string found(const toml::node& node) {
  if (const auto* value = node.as_integer()) return fmt::format("= {}", value->get());
  if (const auto* value = node.as_floating_point()) return fmt::format("= {}", value->get());
  if (const auto* value = node.as_string()) return "= " + in_quotes(value->get());
  if (const auto* value = node.as_boolean()) return fmt::format("= {}", value->get());
  return "is " + kind_of(node);
}

double read_number(const SceneFile& file, const toml::node& node, const std::string& what, const Quantity& quantity) {
  double value = 0;
  if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer->get());
  } else if (const auto* number = node.as_floating_point()) {
    value = number->get();
  } else {
    file.refuse(place_of(node), what + " " + found(node), "allowed: a number, " + describe(quantity));
  }
  // written so that a NaN is refused
  if (!(value >= quantity.low && value <= quantity.high)) {
    file.refuse(place_of(node), what + " " + found(node), "allowed: " + describe(quantity));
  }
  return to_si(value, quantity.unit);
}

void read_numbers(const SceneFile& file, const toml::node& node, const std::string& what, const std::string& form,
                  const Quantity& quantity, std::span<double> values) {
  const toml::array* array = node.as_array();
  if (!array) file.refuse(place_of(node), what + " " + found(node), fmt::format("allowed: {}, {} numbers", form, values.size()));
  if (array->size() != values.size()) {
    file.refuse(place_of(node), fmt::format("{} has {} entries", what, array->size()),
                fmt::format("allowed: {}, {} numbers", form, values.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = read_number(file, (*array)[i], what, quantity);
}

SceneTable::SceneTable(const SceneFile& file, const toml::table& table, std::string title, std::vector<std::string_view> keys)
    : file_(file), table_(table), title_(std::move(title)), keys_(std::move(keys)) {
  // the table is sorted by key; a reader looks from the top
  const toml::key* first = nullptr;
  for (const auto& [key, node] : table_) {
    if (std::find(keys_.begin(), keys_.end(), key.str()) != keys_.end()) continue;
    if (!first || key.source().begin < first->source().begin) first = &key;
  }
  if (!first) return;
  const auto begin = first->source().begin;
  const Place place = begin.line == 0 ? Place{} : Place{static_cast<int>(begin.line), static_cast<int>(begin.column)};
  file_.refuse(place, fmt::format("unknown key {} in {}", in_quotes(first->str()), title_),
               fmt::format("the nearest known key is '{}'", nearest_name(first->str(), keys_)));
}

const toml::node* SceneTable::find(std::string_view key) const {
  if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) {
    throw std::logic_error(fmt::format("{} is read for a key that it does not list: {}", title_, key));
  }
  return table_.get(key);
}

Place SceneTable::place(std::string_view key) const {
  const toml::node* node = find(key);
  return node ? place_of(*node) : place();
}

const toml::node& SceneTable::need(std::string_view key, const std::string& allowed) const {
  const toml::node* node = find(key);
  if (!node) file_.refuse(place(), fmt::format("{} lacks '{}'", title_, key), "allowed: " + allowed);
  return *node;
}

void SceneTable::read(std::string_view key, const Quantity& quantity, double& value) const {
  if (const toml::node* node = find(key)) value = read_number(file_, *node, std::string(key), quantity);
}

void SceneTable::read(std::string_view key, const Quantity& quantity, const std::string& form, std::span<double> values) const {
  if (const toml::node* node = find(key)) read_numbers(file_, *node, std::string(key), form, quantity, values);
}

void SceneTable::read(std::string_view key, IntegerRange range, std::int64_t& value) const {
  const toml::node* node = find(key);
  if (!node) return;
  const auto* integer = node->as_integer();
  if (!integer || integer->get() < range.low || integer->get() > range.high) {
    file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)),
                 fmt::format("allowed: a whole number, {} to {}", range.low, range.high));
  }
  value = integer->get();
}

void SceneTable::read_flag(std::string_view key, bool& value) const {
  const toml::node* node = find(key);
  if (!node) return;
  const auto* flag = node->as_boolean();
  if (!flag) file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)), "allowed: true or false");
  value = flag->get();
}

void SceneTable::read_text(std::string_view key, std::size_t largest, std::string& value, std::string_view remedy) const {
  const toml::node* node = find(key);
  if (!node) return;
  const auto* text = node->as_string();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  const bool has_control = text && std::any_of(text->get().begin(), text->get().end(), is_control);
  if (!text || text->get().empty() || text->get().size() > largest || has_control) {
    file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)),
                 fmt::format("allowed: a string of 1 to {} characters, without control characters{}{}", largest,
                             has_control && !remedy.empty() ? "; " : "", has_control ? remedy : ""));
  }
  value = text->get();
}

void SceneTable::read_path(std::string_view key, std::string& value) const {
  read_text(key, ranges::LARGEST_PATH, value, WRITE_SLASHES);
}

void SceneTable::read_name(std::string_view key, std::string& value) const {
  const toml::node* node = find(key);
  if (!node) return;
  const auto* text = node->as_string();
  if (!text || !is_plain_name(text->get())) {
    file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)),
                 fmt::format("allowed: a letter, then letters, digits, '_', '-' or '.', at most {} in all", ranges::LARGEST_NAME));
  }
  value = text->get();
}

void SceneTable::need(std::string_view key, const Quantity& quantity, double& value) const {
  value = read_number(file_, need(key, describe(quantity)), std::string(key), quantity);
}

void SceneTable::need(std::string_view key, const Quantity& quantity, const std::string& form, std::span<double> values) const {
  read_numbers(file_, need(key, form), std::string(key), form, quantity, values);
}

int SceneTable::choice_index(std::string_view key, const std::vector<const char*>& words) const {
  const toml::node* node = find(key);
  if (!node) return -1;
  const auto* text = node->as_string();
  std::string allowed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (text && text->get() == words[i]) return static_cast<int>(i);
    allowed += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 < words.size() ? ", " : " or ", words[i]);
  }
  file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)), "allowed: " + allowed);
}

const toml::array* SceneTable::array(std::string_view key, std::size_t smallest, std::size_t largest,
                                     const std::string& allowed) const {
  const toml::node* node = find(key);
  if (!node) return nullptr;
  const toml::array* array = node->as_array();
  if (!array) file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)), "allowed: " + allowed);
  if (array->size() < smallest || array->size() > largest) {
    file_.refuse(place_of(*node), fmt::format("{} has {} entries", key, array->size()),
                 fmt::format("allowed: {} to {} entries, {}", smallest, largest, allowed));
  }
  return array;
}

std::optional<SceneTable> SceneTable::table(std::string_view key, std::vector<std::string_view> keys) const {
  const toml::table* inner = bare_table(key, "a table");
  if (!inner) return std::nullopt;
  return SceneTable(file_, *inner, inner_title(title_, key), std::move(keys));
}

const toml::table* SceneTable::bare_table(std::string_view key, const std::string& allowed) const {
  const toml::node* node = find(key);
  if (!node) return nullptr;
  const toml::table* inner = node->as_table();
  if (!inner) file_.refuse(place_of(*node), fmt::format("{} {}", key, found(*node)), "allowed: " + allowed);
  return inner;
}

}  // namespace wholehand
