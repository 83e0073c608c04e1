// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/source_tokens.h"

#include <algorithm>
#include <cctype>

namespace shoal {
namespace {

bool IsWordCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool IsSpace(char c) { return std::isspace(static_cast<unsigned char>(c)); }

class Tokenizer {
 public:
  explicit Tokenizer(std::string_view source) : source_(source) {}

  SourceText Read() {
    bool at_line_start = true;
    while (at_ < source_.size()) {
      const char c = source_[at_];
      if (c == '\n') {
        at_line_start = true;
        Skip(1);
      } else if (IsSpace(c)) {
        Skip(1);
      } else if (StartsWith("//")) {
        SkipTo(source_.find('\n', at_));
      } else if (StartsWith("/*")) {
        const size_t end = source_.find("*/", at_ + 2);
        SkipTo(end == std::string_view::npos ? end : end + 2);
      } else if (c == '#' && at_line_start) {
        TakeDirective();
      } else {
        at_line_start = false;
        TakeToken();
      }
    }
    return std::move(text_);
  }

 private:
  bool StartsWith(std::string_view start) const {
    return source_.substr(at_, start.size()) == start;
  }

  void SkipTo(size_t end) { Skip(std::min(end, source_.size()) - at_); }

  void Skip(size_t count) {
    const std::string_view skipped = source_.substr(at_, count);
    line_ += static_cast<int>(std::ranges::count(skipped, '\n'));
    at_ += skipped.size();
  }

  void TakeDirective() {
    size_t end = source_.find('\n', at_);
    while (end != std::string_view::npos && source_[end - 1] == '\\') {
      end = source_.find('\n', end + 1);
    }
    end = std::min(end, source_.size());
    std::string_view line = source_.substr(at_ + 1, end - at_ - 1);
    const std::string_view directive = Word(&line);
    if (directive == "define") {
      const std::string name(Word(&line));
      text_.macros.push_back({.name = name, .text = std::string(line), .line = line_});
    } else if (directive == "undef") {
      const std::string_view name = Word(&line);
      std::erase_if(text_.macros, [&](const SourceMacro& macro) { return macro.name == name; });
    } else if (directive == "include" && line.find('"') != std::string_view::npos) {
      line.remove_prefix(line.find('"') + 1);
      text_.includes.emplace_back(line.substr(0, line.find('"')));
    }
    SkipTo(end);
  }

  static std::string_view Word(std::string_view* line) {
    while (!line->empty() && IsSpace(line->front())) line->remove_prefix(1);
    size_t length = 0;
    while (length < line->size() && IsWordCharacter((*line)[length])) ++length;
    const std::string_view word = line->substr(0, length);
    line->remove_prefix(length);
    return word;
  }

  void TakeToken() {
    const char c = source_[at_];
    size_t length = 1;
    if (StartsWith("R\"")) {
      const size_t open = source_.find('(', at_);
      std::string close(1, ')');  // of R"x( ... )x"
      close.append(source_.substr(at_ + 2, open - at_ - 2)).push_back('"');
      const size_t end = source_.find(close, open);
      length = std::min(end, source_.size()) - at_ + close.size();
    } else if (c == '"' || c == '\'') {
      while (at_ + length < source_.size() && source_[at_ + length] != c) {
        length += source_[at_ + length] == '\\' ? 2 : 1;
      }
      ++length;
      while (at_ + length < source_.size() && IsWordCharacter(source_[at_ + length])) ++length;
    } else if (IsWordCharacter(c)) {
      // The ' of 1'000 belongs to the number.
      const bool is_number = std::isdigit(static_cast<unsigned char>(c));
      while (at_ + length < source_.size() && (IsWordCharacter(source_[at_ + length]) ||
                                               (is_number && source_[at_ + length] == '\'')))
        ++length;
    } else if (StartsWith("::") || StartsWith("->") || StartsWith("<<") || StartsWith("<=") ||
               StartsWith(">=") || StartsWith("==") || StartsWith("!=")) {
      length = 2;
    }
    text_.tokens.push_back({.text = std::string(source_.substr(at_, length)), .line = line_});
    Skip(length);
  }

  std::string_view source_;
  size_t at_ = 0;
  int line_ = 1;
  SourceText text_;
};

}  // namespace

bool SourceToken::IsIdentifier() const {
  return IsWordCharacter(text.front()) && !std::isdigit(static_cast<unsigned char>(text.front()));
}

std::map<std::string, int> FreeNames(const SourceText& text) {
  std::map<std::string, int> names;
  std::string_view before;
  for (const SourceToken& token : text.tokens) {
    const std::string& name = token.text;
    const bool is_constant = name.size() > 1 && name[0] == 'k' && std::isupper(name[1]) != 0;
    const bool is_small = std::islower(static_cast<unsigned char>(name.front())) && !is_constant;
    if (is_small && token.text.back() != '_' && before != "." && before != "->" && before != "::") {
      names.try_emplace(token.text, token.line);
    }
    before = token.text;
  }
  return names;
}

SourceText ReadSource(std::string_view source) { return Tokenizer(source).Read(); }

}  // namespace shoal
