// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/source_functions.h"

#include <algorithm>
#include <string_view>

#include "tests/layering/token_groups.h"

namespace shoal {
namespace {

class FunctionReader {
 public:
  explicit FunctionReader(const std::vector<SourceToken>& tokens) : tokens_(tokens) {}

  std::vector<SourceFunction> Read() {
    while (at_ < tokens_.size()) TakeDeclaration();
    return std::move(functions_);
  }

 private:
  std::string_view Text(size_t i) const {
    return i < tokens_.size() ? std::string_view(tokens_[i].text) : std::string_view();
  }

  // Reads to the end of a declaration, of a function's body, or of the opening of a scope. The
  // declarations of a namespace or type are then read like others, and its closing brace is
  // skipped.
  void TakeDeclaration() {
    const size_t begin = at_;
    size_t parameters = 0;  // index of their bracket
    bool has_value = false;
    while (at_ < tokens_.size()) {
      const std::string_view text = Text(at_);
      if (text == ";" || text == "}") break;
      if (text == ":" && IsAccess(Text(at_ - 1))) break;
      if (text == "template" && Text(at_ + 1) == "<") {
        at_ = BehindAngles(tokens_, at_ + 1);
      } else if (text == "operator") {
        // The "()" of a call operator is its name.
        at_ += Text(at_ + 1) == "(" ? 3 : 2;
        while (at_ < tokens_.size() && Text(at_) != "(") ++at_;
      } else if (text == "{") {
        if (OpensScope(begin)) break;
        if (TakeBraces(begin, parameters, has_value)) return;
      } else if (IsOpeningBracket(text)) {
        if (text == "(" && parameters == 0) parameters = at_;
        at_ = BehindGroup(tokens_, at_);
      } else {
        if (text == "=") has_value = true;
        ++at_;
      }
    }
    ++at_;
  }

  // A body, or the value of a variable or a member; whether it was a body.
  bool TakeBraces(size_t begin, size_t parameters, bool has_value) {
    const size_t open = at_;
    at_ = BehindGroup(tokens_, open);
    const bool is_body = parameters > 0 && !has_value && Text(at_) != "," && Text(at_) != "{";
    if (is_body) {
      functions_.push_back({.name = NameOf(begin, parameters),
                            .line = tokens_[open].line,
                            .lines = LinesOf(open, at_)});
    }
    return is_body;
  }

  // Physical lines of a body except those within tables and texts.
  int LinesOf(size_t begin, size_t end) const {
    int lines = tokens_[end - 1].line - tokens_[begin].line + 1;
    for (size_t i = begin + 1; i < end; ++i) {
      lines -= static_cast<int>(std::ranges::count(tokens_[i].text, '\n'));
      if (Text(i) != "{") continue;
      const size_t behind = BehindGroup(tokens_, i);
      const auto first = tokens_.begin() + static_cast<std::ptrdiff_t>(i);
      const auto last = tokens_.begin() + static_cast<std::ptrdiff_t>(behind);
      if (std::ranges::find(first, last, ";", &SourceToken::text) != last) continue;
      lines -= tokens_[behind - 1].line - tokens_[i].line;
      i = behind - 1;
    }
    return lines;
  }

  static bool IsAccess(std::string_view text) {
    return text == "public" || text == "protected" || text == "private";
  }

  // A namespace, a block with another linkage, or a type with members; `begin` starts it.
  bool OpensScope(size_t begin) const {
    size_t i = begin;
    while (i < at_) {
      if (Text(i) == "template" && Text(i + 1) == "<") {
        i = BehindAngles(tokens_, i + 1);
      } else if (Text(i) == "inline" || Text(i) == "typedef") {
        ++i;
      } else {
        break;
      }
    }
    if (Text(i) == "namespace") return true;
    if (Text(i) == "extern" && Text(i + 1).starts_with('"')) return i + 2 == at_;
    if (Text(i) != "class" && Text(i) != "struct" && Text(i) != "union") return false;
    for (; i < at_; ++i) {
      if (Text(i) == "alignas" || Text(i) == "[") i = BehindGroup(tokens_, i + 1) - 1;
      if (Text(i) == "(" || Text(i) == "=") return false;
    }
    return true;
  }

  // The words before the parameters. Of a macro's call (TEST), and of a constructor without a path,
  // also what the brackets hold.
  std::string NameOf(size_t begin, size_t parameters) const {
    size_t first = parameters;
    for (size_t i = begin; i < parameters; ++i) {
      if (Text(i) == "operator") first = i;  // whose name are tokens of any kind
    }
    while (first > begin && IsPartOfName(first - 1) &&
           !(tokens_[first - 1].IsIdentifier() && tokens_[first].IsIdentifier())) {
      --first;
    }
    const size_t end = first == begin ? BehindGroup(tokens_, parameters) : parameters;
    std::string name;
    for (size_t i = first; i < end; ++i) {
      name += tokens_[i].text;
      if (tokens_[i].text == ",") name += ' ';
    }
    return name;
  }

  bool IsPartOfName(size_t i) const {
    return Text(i) == "::" || Text(i) == "~" || tokens_[i].IsIdentifier();
  }

  const std::vector<SourceToken>& tokens_;
  size_t at_ = 0;
  std::vector<SourceFunction> functions_;
};

}  // namespace

std::vector<SourceFunction> FunctionsOf(const SourceText& text) {
  return FunctionReader(text.tokens).Read();
}

}  // namespace shoal
