// SPDX-License-Identifier: MIT
#include "sweeps/rank/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/text/error.h"
#include "base/text/nearest_name.h"
#include "base/text/text.h"
#include "core/scene.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t LARGEST_CONDITION = 4096;  // characters
constexpr int DEEPEST = 64;                      // parentheses and nots within each other

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

[[noreturn]] void refuse(std::size_t column, const std::string& what) {
  throw usage_error(fmt::format("--where, column {}: {}", column, what));
}

}  // namespace

// seen from outside, since WhereParser, a friend of a class that is, has one
struct WhereToken {
  enum class Type { end, name, number, symbol } type = Type::end;
  std::string text;
  std::size_t column = 1;
  double number = 0;
};

static std::string shown(const WhereToken& token) {
  return token.type == WhereToken::Type::end ? "the end" : fmt::format("'{}'", token.text);
}

class WhereTokens {
 public:
  explicit WhereTokens(const std::string& text) : text_(text) {
    if (text.size() > LARGEST_CONDITION)
      refuse(LARGEST_CONDITION, fmt::format("a condition has at most {} characters", LARGEST_CONDITION));
    take();
  }
  const WhereToken& next() const { return next_; }
  bool is(std::string_view text) const { return next_.type != WhereToken::Type::end && next_.text == text; }

  WhereToken take() {
    WhereToken token = std::move(next_);
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
    next_ = {WhereToken::Type::end, "", at_ + 1, 0};
    if (at_ == text_.size()) return token;
    const char c = text_[at_];
    const bool is_number = is_digit(c) || ((c == '.' || c == '-' || c == '+') && at_ + 1 < text_.size() &&
                                           (is_digit(text_[at_ + 1]) || text_[at_ + 1] == '.'));
    if (is_number) {
      read_number();
    } else if (is_name_start(c)) {
      read_name();
    } else {
      read_symbol();
    }
    return token;
  }

 private:
  void read_number() {
    const char* begin = text_.data() + at_ + (text_[at_] == '+');
    const char* end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(begin, end, next_.number);
    const bool is_whole = error == std::errc() && (rest == end || (!is_name_start(*rest) && *rest != '.'));
    if (!is_whole) refuse(next_.column, "this number cannot be read; write 12, 0.5 or 2e-3");
    next_.type = WhereToken::Type::number;
    put(static_cast<std::size_t>(rest - text_.data()));
  }

  void read_name() {
    std::size_t end = at_;
    while (end < text_.size() && (is_name_start(text_[end]) || is_digit(text_[end]))) ++end;
    next_.type = WhereToken::Type::name;
    put(end);
  }

  void read_symbol() {
    static constexpr std::string_view SYMBOLS[] = {"<=", ">=", "==", "!=", "<", ">", "(", ")", "&"};
    const std::string_view rest = std::string_view(text_).substr(at_);
    for (const auto& [wrong, right] : {std::pair{"&&", "and"}, {"||", "or"}}) {
      if (rest.starts_with(wrong)) refuse(next_.column, fmt::format("'{}' is written '{}' here", wrong, right));
    }
    for (const std::string_view symbol : SYMBOLS) {
      if (!rest.starts_with(symbol)) continue;
      next_.type = WhereToken::Type::symbol;
      put(at_ + symbol.size());
      return;
    }
    if (rest[0] == '=') refuse(next_.column, "'=' is written '==' here");
    if (rest[0] == '!') refuse(next_.column, "'!' is written 'not' here");
    const auto byte = static_cast<unsigned char>(rest[0]);
    const std::string found = byte > 0x20 && byte < 0x7F ? std::string(1, rest[0]) : fmt::format("\\x{:02x}", byte);
    refuse(next_.column, fmt::format("'{}' means nothing here; known: < <= > >= == != & ( ) and or not min max", found));
  }

  void put(std::size_t end) {
    next_.text = text_.substr(at_, end - at_);
    at_ = end;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  WhereToken next_;
};

class WhereParser {
 public:
  WhereParser(const std::string& text, const std::vector<WhereName>& names, Where& where)
      : tokens_(text), names_(names), where_(where) {}

  void parse() {
    const int node = condition_of(alternatives());
    where_.root_ = where_.root_ < 0 ? node : add({Operation::both, where_.root_, node, {}, {}});
    if (tokens_.next().type != WhereToken::Type::end)
      refuse(tokens_.next().column, fmt::format("found {}; expected 'and', 'or' or the end", shown(tokens_.next())));
  }

 private:
  using Operation = Where::Operation;

  // A condition, or a value that may still become a side of a comparison.
  struct Part {
    int node = -1;  // -1: an operand
    Where::Operand operand;
    const WhereName* name = nullptr;  // of the operand; null: a number
    std::size_t column = 1;
    std::string text;
  };

  int add(Where::Node node) {
    where_.nodes_.push_back(std::move(node));
    return static_cast<int>(where_.nodes_.size()) - 1;
  }

  static Part condition(int node, std::size_t column) {
    Part part;
    part.node = node;
    part.column = column;
    return part;
  }

  // The node of a part that must be a condition.
  int condition_of(const Part& part) {
    if (part.node >= 0) return part.node;
    const bool is_condition = part.name && (part.operand.is_masked || part.name->kind != WhereKind::number);
    if (!is_condition)
      refuse(part.column, fmt::format("{} is a number and not a condition; compare it: {} > 0", part.text, part.text));
    return add({Operation::truth, -1, -1, part.operand, {}});
  }

  Part alternatives() { return chain("or", Operation::either, &WhereParser::conjunction); }
  Part conjunction() { return chain("and", Operation::both, &WhereParser::negation); }

  Part chain(const char* word, Operation operation, Part (WhereParser::*next)()) {
    Part part = (this->*next)();
    while (tokens_.is(word)) {
      tokens_.take();
      const int first = condition_of(part), second = condition_of((this->*next)());
      part = condition(add({operation, first, second, {}, {}}), part.column);
    }
    return part;
  }

  Part negation() {
    if (!tokens_.is("not")) return comparison();
    const std::size_t column = tokens_.take().column;
    const Depth depth(depth_, column);
    return condition(add({Operation::negation, condition_of(negation()), -1, {}, {}}), column);
  }

  Part comparison() {
    const Part left = masked();
    Operation operation{};
    if (!read_comparison(operation)) return left;
    const Part right = masked();
    for (const Part* side : {&left, &right}) {
      if (side->node >= 0) refuse(side->column, "a condition cannot be compared; join conditions by 'and' and 'or'");
    }
    Operation again{};
    if (const std::size_t column = tokens_.next().column; read_comparison(again))
      refuse(column, "two comparisons in a row; write a < b and b < c");
    Where::Node node{operation, -1, -1, left.operand, right.operand};
    unite(left, right, node.right);
    unite(right, left, node.left);
    return condition(add(node), left.column);
  }

  bool read_comparison(Operation& operation) {
    static constexpr std::pair<std::string_view, Operation> COMPARISONS[] = {{"<", Operation::less},   {"<=", Operation::at_most},
                                                                             {">", Operation::more},   {">=", Operation::at_least},
                                                                             {"==", Operation::equal}, {"!=", Operation::unequal}};
    for (const auto& [symbol, meaning] : COMPARISONS) {
      if (!tokens_.is(symbol)) continue;
      tokens_.take();
      operation = meaning;
      return true;
    }
    return false;
  }

  // Converts `other`, compared with a name, into the units of the name's value, exactly as a scene's numbers, so that == finds them.
  static void unite(const Part& side, const Part& other, Where::Operand& operand) {
    if (!side.name) return;
    if (other.name) {
      if (side.name->units != other.name->units || side.name->unit != other.name->unit)
        refuse(side.column, fmt::format("{} and {} have different units", side.text, other.text));
    } else if (side.name->unit == WhereUnit::mm) {
      operand.number /= 1e3;
    } else if (side.name->unit == WhereUnit::deg) {
      operand.number = radians(operand.number);
    }
  }

  Part masked() {
    Part part = primary();
    if (!tokens_.is("&")) return part;
    const std::size_t column = tokens_.take().column;
    if (part.node >= 0 || !part.name || part.name->kind != WhereKind::mask || part.operand.is_masked)
      refuse(column, fmt::format("'&' takes a mask on its left{}", known_masks()));
    const WhereToken token = tokens_.take();
    const double largest = std::numeric_limits<std::uint32_t>::max();
    if (token.type != WhereToken::Type::number || !(token.number >= 0 && token.number <= largest) ||
        token.number != std::floor(token.number))
      refuse(token.column, fmt::format("found {}; expected the bits of a mask, a whole number", shown(token)));
    part.operand.mask = static_cast<std::uint32_t>(token.number);
    part.operand.is_masked = true;
    part.text += " & " + token.text;
    return part;
  }

  Part primary() {
    const WhereToken token = tokens_.take();
    if (token.type == WhereToken::Type::number || token.text == "inf") {
      Part part;
      part.operand.number = token.type == WhereToken::Type::number ? token.number : std::numeric_limits<double>::infinity();
      part.column = token.column;
      part.text = token.text;
      return part;
    }
    if (token.type == WhereToken::Type::symbol && token.text == "(") {
      const Depth depth(depth_, token.column);
      Part part = alternatives();
      close(token);
      part.column = token.column;
      return part;
    }
    const bool is_word = token.text == "and" || token.text == "or" || token.text == "not";
    if (token.type != WhereToken::Type::name || is_word)
      refuse(token.column, fmt::format("found {}; expected a name or a number", shown(token)));
    if ((token.text == "min" || token.text == "max") && tokens_.is("(")) return folded(token);
    return named(token, WhereFold::none);
  }

  void close(const WhereToken& opening) {
    if (!tokens_.is(")"))
      refuse(tokens_.next().column,
             fmt::format("found {}; expected the ')' for the '(' of column {}", shown(tokens_.next()), opening.column));
    tokens_.take();
  }

  // min(name) and max(name).
  Part folded(const WhereToken& function) {
    const WhereToken opening = tokens_.take(), token = tokens_.take();
    if (token.type != WhereToken::Type::name)
      refuse(token.column, fmt::format("found {}; expected the name of a variable in {}()", shown(token), function.text));
    Part part = named(token, function.text == "min" ? WhereFold::least : WhereFold::largest);
    close(opening);
    part.column = function.column;
    part.text = fmt::format("{}({})", function.text, part.text);
    return part;
  }

  Part named(const WhereToken& token, WhereFold fold) {
    const auto found = std::find_if(names_.begin(), names_.end(), [&](const WhereName& n) { return n.name == token.text; });
    if (found == names_.end()) refuse_unknown(token);
    if (!found->refusal.empty()) refuse(token.column, fmt::format("{} {}", token.text, found->refusal));
    if (!found->over.empty() && fold == WhereFold::none) {
      refuse(token.column,
             fmt::format("{0} has a value for each {1}; write max({0}) or min({0}), over all of them", token.text, found->over));
    }
    const WhereValue value{found->source, found->over.empty() ? WhereFold::none : fold};
    auto& values = where_.values_;
    auto place = std::find(values.begin(), values.end(), value);
    if (place == values.end()) place = values.insert(values.end(), value);
    Part part;
    part.operand.value = static_cast<int>(place - values.begin());
    part.name = &*found;
    part.column = token.column;
    part.text = token.text;
    return part;
  }

  [[noreturn]] void refuse_unknown(const WhereToken& token) const {
    std::vector<std::string_view> known;
    for (const WhereName& name : names_) known.push_back(name.name);
    const std::string nearest = nearest_name(token.text, known);
    known.clear();
    for (const WhereName& name : names_) {
      if (name.unit == WhereUnit::own && name.refusal.empty()) known.push_back(name.name);
    }
    refuse(token.column,
           fmt::format("there is no value '{}'; the nearest is '{}'; known: {}, lengths also with _mm, angles with _deg",
                       token.text.substr(0, 60), nearest, joined(known, ", ")));
  }

  std::string known_masks() const {
    std::vector<std::string_view> masks;
    for (const WhereName& name : names_) {
      if (name.kind == WhereKind::mask && name.refusal.empty()) masks.push_back(name.name);
    }
    return masks.empty() ? "" : fmt::format(": {}", joined(masks, ", "));
  }

  // Counts the nesting, because each level takes stack.
  struct Depth {
    Depth(int& count, std::size_t column) : depth(count) {
      if (++depth > DEEPEST) refuse(column, fmt::format("more than {} nested parentheses", DEEPEST));
    }
    ~Depth() { --depth; }
    int& depth;
  };

  WhereTokens tokens_;
  const std::vector<WhereName>& names_;
  Where& where_;
  int depth_ = 0;
};

Where::Where(const std::vector<std::string>& texts, const std::vector<WhereName>& names) {
  for (const std::string& text : texts) WhereParser(text, names, *this).parse();
}

double Where::number_of(const Operand& operand, const double* values) {
  if (operand.value < 0) return operand.number;
  const double value = values[operand.value];
  return operand.is_masked ? static_cast<double>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) & operand.mask)
                           : value;
}

bool Where::holds(int at, const double* values) const {
  const Node& node = nodes_[static_cast<std::size_t>(at)];
  switch (node.operation) {
    case Operation::both:
      return holds(node.first, values) && holds(node.second, values);
    case Operation::either:
      return holds(node.first, values) || holds(node.second, values);
    case Operation::negation:
      return !holds(node.first, values);
    default:
      break;
  }
  const double left = number_of(node.left, values), right = number_of(node.right, values);
  switch (node.operation) {
    case Operation::less:
      return left < right;
    case Operation::at_most:
      return left <= right;
    case Operation::more:
      return left > right;
    case Operation::at_least:
      return left >= right;
    case Operation::equal:
      return left == right;
    case Operation::unequal:
      return left < right || left > right;
    default:
      return left != 0;
  }
}

}  // namespace wholehand::sweeps
