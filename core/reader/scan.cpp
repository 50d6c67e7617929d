// SPDX-License-Identifier: MIT
#include "core/reader/scan.h"

#include <fmt/format.h>

#include <string>

namespace wholehand {
namespace {

// Knows strings, comments and brackets, enough to distinguish a header from an array and a dot in a key from one in a text.
class Scanner {
 public:
  Scanner(const SceneFile& file, std::string_view text) : file_(file), text_(text) {}

  void run() {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = first_ = 3;  // a byte order mark is no character
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        check_beginning(c);
        skip_string(c);
      } else if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else if (c == '[' && !in_value_) {
        enter_header();
      } else if (is_letter(c) && begins_value()) {
        skip_word();
      } else {
        note(c);
        step();
      }
    }
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool is_beyond_ascii() const { return static_cast<unsigned char>(peek()) >= 0x80; }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
  static bool is_of_word(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

  void step() {
    const auto byte = static_cast<unsigned char>(text_[at_]);
    if (byte == '\n') {
      place_ = {place_.line + 1, 1};
    } else if ((byte & 0xC0) != 0x80) {
      ++place_.column;
    }
    ++at_;
  }

  // Follows keys, values and nesting, and counts the parts of keys.
  void note(char c) {
    if (is_beyond_ascii()) file_.refuse(place_, "a non-ASCII character outside strings and comments", "allowed: TOML 1.0");
    if (c == '=') {
      if (!in_key_) file_.refuse(place_, "'=' in a value", "allowed: TOML 1.0");
      in_key_ = false;
      in_value_ = true;
    } else if (c == '[' || c == '{') {
      check_beginning(c);
      open_ += c;
      in_key_ = c == '{';
    } else if (c == ']' || c == '}') {
      close(c);
    } else if (c == ',') {
      in_key_ = !open_.empty() && open_.back() == '{';
    } else if (c == '\n' && open_.empty()) {
      in_key_ = true;
      in_value_ = false;
    }
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') {
      parts_ = 1;
    } else if (c == '.' && ++parts_ > ranges::LARGEST_KEY_DEPTH) {
      file_.refuse(place_, fmt::format("a key of more than {} parts", ranges::LARGEST_KEY_DEPTH), "allowed: keys of docs/scene.md");
    }
  }

  // A string, array or inline table begins after a space, a bracket, a comma, an = or, as part of a key, a dot. After anything else (9"a") the parser
  // would continue what it has begun, and not see a string there.
  void check_beginning(char c) const {
    const char before = at_ == 0 ? '\n' : text_[at_ - 1];
    const bool is_apart =
        is_space(before) || before == '=' || before == '[' || before == '{' || before == ',' || (in_key_ && before == '.');
    if (is_apart || at_ == first_) return;
    const bool is_quote = c == '"' || c == '\'';
    file_.refuse(place_,
                 fmt::format("{} directly after '{}'{}", c, before,
                             is_quote ? ": a quote is missing before it, or this one is too many" : ""),
                 "allowed: TOML 1.0");
  }

  // Whether a value or an entry of an array begins here, or a text directly behind a quote, where it has none.
  bool begins_value() const {
    if (in_key_) return false;
    std::size_t end = at_;
    while (end > 0 && is_space(text_[end - 1])) --end;
    const char before = end == 0 ? '\n' : text_[end - 1];
    return before == '=' || before == '[' || before == ',' || (end == at_ && (before == '"' || before == '\''));
  }

  // A value that is a word outside quotes: true, false, inf and nan are the only ones.
  void skip_word() {
    const Place begin = place_;
    std::string word;
    for (; at_ < text_.size() && is_of_word(text_[at_]); step()) word += text_[at_];
    if (word == "true" || word == "false" || word == "inf" || word == "nan") return;
    file_.refuse(begin, fmt::format("{} is outside quotes: a quote is missing", in_quotes(word)),
                 "allowed: texts in quotes, as name = \"cup\"");
  }

  void close(char c) {
    if (open_.empty()) return;  // of a header, or an error that the parser reports
    if (open_.back() != (c == ']' ? '[' : '{')) {
      file_.refuse(place_, fmt::format("found '{}', but '{}' is open", c, open_.back()), "allowed: TOML 1.0");
    }
    open_.pop_back();
  }

  // [key] or [[key]]: passes the brackets, and sees that a key or a closing bracket follows.
  void enter_header() {
    parts_ = 1;
    step();
    if (peek() == '[') step();
    while (peek() == ' ' || peek() == '\t') step();
    const char c = peek();
    const bool is_key =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '"' || c == '\'';
    if (!is_key && c != ']' && at_ < text_.size()) file_.refuse(place_, "a table header without a key", "allowed: TOML 1.0");
  }

  // Leaves the scan behind the closing quotes.
  void skip_string(char quote) {
    const std::string delimiter(3, quote);
    const bool is_long = text_.substr(at_, 3) == delimiter;
    const Place begin = place_;
    for (int i = 0; i < (is_long ? 3 : 1); ++i) step();
    while (at_ < text_.size()) {
      if (is_long ? text_.substr(at_, 3) == delimiter : text_[at_] == quote) {
        for (int i = 0; i < (is_long ? 3 : 1); ++i) step();
        while (is_long && peek() == quote) step();  // a long string may end in one or two quotes of its own
        return;
      }
      if (!is_long && text_[at_] == '\n') break;
      if (quote == '"' && text_[at_] == '\\') {
        step();
        skip_escaped(is_long);
      } else {
        step();
      }
    }
    file_.refuse(begin, fmt::format("the closing {} of this text is missing", is_long ? delimiter : std::string(1, quote)),
                 is_long ? "allowed: the same three quotes at the end of the text"
                         : "allowed: the same quote at the end of the text, in the same line");
  }

  // What follows a backslash: one character, or in a long string the spaces and line ends that it swallows.
  void skip_escaped(bool is_long) {
    if (is_long && is_space(peek())) {
      while (is_space(peek())) step();
    } else if (at_ < text_.size() && text_[at_] != '\n' && !is_beyond_ascii()) {
      step();
    }
    if (is_beyond_ascii())
      file_.refuse(place_, "a backslash before a non-ASCII character", "allowed: TOML 1.0 without such a backslash");
  }

  const SceneFile& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t first_ = 0;  // where the text begins
  Place place_;
  bool in_key_ = true;     // before the = of a key
  bool in_value_ = false;  // behind the = of a line's key, until the line or its brackets end
  std::string open_;       // brackets and braces of a value that wait to be closed
  std::size_t parts_ = 1;  // of the key under way
};

}  // namespace

void scan_scene(const SceneFile& file, std::string_view text) { Scanner(file, text).run(); }

}  // namespace wholehand
