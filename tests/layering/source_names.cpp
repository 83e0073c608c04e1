// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/source_names.h"

#include <algorithm>
#include <cctype>

#include "tests/layering/source_tokens.h"
#include "tests/layering/token_groups.h"

namespace shoal {
namespace {

bool IsMacroLike(std::string_view text) {
  return text.size() > 2 && std::ranges::all_of(text, [](unsigned char c) {
           return std::isupper(c) || std::isdigit(c) || c == '_';
         });
}

std::string Joined(const std::vector<SourceToken>& tokens, size_t begin, size_t end) {
  std::string text;
  for (size_t i = begin; i < std::min(end, tokens.size()); ++i) {
    if (!text.empty()) text += ' ';
    text += tokens[i].text;
  }
  return text;
}

// Reads declarations one by one. `tokens` end where the file ends.
class Reader {
 public:
  explicit Reader(const std::vector<SourceToken>& tokens) : tokens_(tokens) {}

  std::vector<SourceName> Names() {
    while (at_ < tokens_.size()) TakeStatement();
    return std::move(names_);
  }

 private:
  std::string_view Text(size_t i) const {
    return i < tokens_.size() ? std::string_view(tokens_[i].text) : std::string_view();
  }
  bool IsName(size_t i) const { return i < tokens_.size() && tokens_[i].IsIdentifier(); }

  void TakeStatement() {
    if (Text(at_) == "}") {
      if (!scopes_.empty()) scopes_.pop_back();
      ++at_;
    } else if (Text(at_) == ";") {
      ++at_;
    } else if (Text(at_) == "inline" && Text(at_ + 1) == "namespace") {
      ++at_;
    } else if (Text(at_) == "namespace") {
      TakeNamespace();
    } else if (Text(at_) == "extern" && Text(at_ + 1).starts_with('"') && Text(at_ + 2) == "{") {
      scopes_.push_back("");
      at_ += 3;
    } else {
      const size_t begin = at_;
      at_ = BehindDeclaration(begin);
      TakeDeclaration(begin, at_);
      TakeLocalConstants(begin, at_);
    }
  }

  void TakeNamespace() {
    size_t i = at_ + 1;
    std::string path;
    while (i < tokens_.size() && Text(i) != "{" && Text(i) != "=") path += Text(i++);
    if (Text(i) == "=") {
      const size_t begin = i + 1;
      while (i < tokens_.size() && Text(i) != ";") ++i;
      Add(path, NameKind::kImport, at_, true, Joined(tokens_, begin, i));
    } else {
      scopes_.push_back(path.empty() ? kUnnamedScope : path);
    }
    at_ = i + 1;
  }

  // Behind the `;`, or the body of a function.
  size_t BehindDeclaration(size_t i) const {
    const bool is_type = IsTypeKey(BehindPrefixes(i));
    bool has_parameters = false, has_value = false;
    while (i < tokens_.size()) {
      const std::string_view text = Text(i);
      if (text == ";") return i + 1;
      if (text == "operator") {
        i = BehindOperatorName(i);
        continue;
      }
      if (text == "=") has_value = true;
      if (text == "(") has_parameters = true;
      if (!IsOpeningBracket(text)) {
        ++i;
        continue;
      }
      i = BehindGroup(tokens_, i);
      const bool is_body = text == "{" && has_parameters && !has_value && !is_type;
      if (is_body && Text(i) != "," && Text(i) != "{") return i;
    }
    return i;
  }

  // Index of the parameters' "(", which the "()" of a call operator is not, or of the ";".
  size_t BehindOperatorName(size_t i) const {
    while (i < tokens_.size() && Text(i) != ";" && (Text(i) != "(" || Text(i + 1) == ")")) {
      i += Text(i) == "(" ? 2 : 1;
    }
    return i;
  }

  size_t BehindPrefixes(size_t i) const {
    while (true) {
      if (Text(i) == "template" && Text(i + 1) == "<") {
        i = BehindAngles(tokens_, i + 1);
      } else if (Text(i) == "[" && Text(i + 1) == "[") {
        i = BehindGroup(tokens_, i);
      } else if ((Text(i) == "alignas" || Text(i) == "__attribute__") && Text(i + 1) == "(") {
        i = BehindGroup(tokens_, i + 1);
      } else {
        return i;
      }
    }
  }

  bool IsTypeKey(size_t i) const {
    return Text(i) == "class" || Text(i) == "struct" || Text(i) == "union" || Text(i) == "enum";
  }

  void TakeDeclaration(size_t begin, size_t end) {
    begin = BehindPrefixes(begin);
    const std::string_view first = Text(begin);
    if (first == "using") return TakeUsing(begin, end);
    if (first == "typedef") {
      Add(std::string(Text(end - 2)), NameKind::kAlias, begin, true, Joined(tokens_, begin, end));
    } else if (first == "concept") {
      Add(std::string(Text(begin + 1)), NameKind::kType, begin + 1, true);
    } else if (IsTypeKey(begin)) {
      TakeType(begin, end);
    } else if (IsMacroLike(first) && Text(begin + 1) == "(") {
      TakeMacroCall(begin);
    } else if (first != "static_assert" && first != "friend" && first != "asm" &&
               !(first == "extern" && Text(begin + 1) == "template")) {
      TakeDeclarators(begin, end);
    }
  }

  void TakeUsing(size_t begin, size_t end) {
    if (Text(begin + 1) == "namespace") return;
    if (Text(begin + 2) == "=") {
      Add(std::string(Text(begin + 1)), NameKind::kAlias, begin, true,
          Joined(tokens_, begin + 3, end - 1));
      return;
    }
    size_t path = begin + 1;
    for (size_t i = begin + 1; i < end; ++i) {
      if (Text(i) != "," && Text(i) != ";") continue;
      if (Text(path) == "::") ++path;  // "::testing::Each" and "testing::Each" are one
      Add(std::string(Text(i - 1)), NameKind::kImport, i - 1, true, Joined(tokens_, path, i));
      path = i + 1;
    }
  }

  void TakeType(size_t begin, size_t end) {
    const bool is_enum = Text(begin) == "enum";
    const bool is_scoped = is_enum && (Text(begin + 1) == "class" || Text(begin + 1) == "struct");
    const size_t name = BehindPrefixes(begin + (is_scoped ? 2 : 1));
    size_t body = name;
    while (body < end && Text(body) != "{" && Text(body) != "(" && Text(body) != "=") ++body;
    const bool has_body = Text(body) == "{";
    const std::string_view after = Text(name + 1);
    if (!has_body && after != ";") return TakeDeclarators(begin, end);  // "struct stat file;"
    if (IsName(name) && after != "::" && after != "<") {
      Add(std::string(Text(name)), NameKind::kType, name, has_body);
    }
    if (!has_body) return;
    const size_t behind = BehindGroup(tokens_, body);
    if (is_enum && !is_scoped) {
      for (size_t i = body + 1; i + 1 < behind; ++i) {
        if (IsName(i) && (Text(i - 1) == "{" || Text(i - 1) == ",")) {
          Add(std::string(Text(i)), NameKind::kValue, i);
        }
      }
    }
    if (Text(behind) != ";") TakeDeclarators(behind - 1, end);
  }

  // Adds the names that TEST(Suite, Name) or MATCHER_P(Name, ...) define.
  void TakeMacroCall(size_t begin) {
    const std::string first(Text(begin + 2));
    if (Text(begin).starts_with("TEST")) {
      Add(first + "_" + std::string(Text(begin + 4)) + "_Test", NameKind::kType, begin);
    } else if (Text(begin).starts_with("MATCHER")) {
      Add(first, NameKind::kFunction, begin);
    }
  }

  void TakeDeclarators(size_t begin, size_t end) {
    bool is_static = false, is_const = false;
    size_t i = begin;
    const auto stops = [&](size_t k) {
      static constexpr std::string_view kStops[] = {"(", "=", "{", "[", ";", ","};
      return std::ranges::find(kStops, Text(k)) != std::end(kStops);
    };
    for (; i < end && !stops(i); ++i) {
      if (Text(i) == "operator") return TakeOperator(i);
      if (Text(i) == "static") is_static = true;
      if (Text(i) == "const" || Text(i) == "constexpr") is_const = true;
      if (Text(i) == "inline" || Text(i) == "extern") is_const = false;
      if (Text(i) == "<") i = BehindAngles(tokens_, i) - 1;
    }
    while (i < end) {
      const bool is_function = Text(i) == "(";
      // A qualified name is of something that has been declared elsewhere.
      if (IsName(i - 1) && Text(i - 2) != "::" && i - 1 > begin) {
        Add(std::string(Text(i - 1)), is_function ? NameKind::kFunction : NameKind::kValue, i - 1);
        names_.back().is_internal |= is_static || (is_const && !is_function);
      }
      if (is_function) return;
      while (i < end && Text(i) != ",")
        i = IsOpeningBracket(Text(i)) ? BehindGroup(tokens_, i) : i + 1;
      while (++i < end && !stops(i)) {
      }
    }
  }

  // `constexpr int kName = 1;` in a body: a name behind a type and before a value.
  void TakeLocalConstants(size_t begin, size_t end) {
    // Members are no local names: those of a type's own body do not count.
    const int members = IsTypeKey(BehindPrefixes(begin)) ? 1 : 0;
    int depth = 0;
    for (size_t i = begin; i < end; ++i) {
      const std::string_view text = Text(i), before = Text(i - 1), after = Text(i + 1);
      if (text == "{") ++depth;
      if (text == "}") --depth;
      if (depth <= members) continue;
      if (text.size() < 2 || text[0] != 'k' || !std::isupper(text[1])) continue;
      const bool has_value = after == "=" || after == "{";
      const bool has_type = (IsName(i - 1) && before != "return") ||
                            (has_value && (before == ">" || before == "*" || before == "&"));
      if (has_type && (has_value || after == "[" || after == ";")) {
        Add(std::string(text), NameKind::kLocal, i);
        names_.back().is_internal = false;
      }
    }
  }

  void TakeOperator(size_t i) {
    if (Text(i - 1) == "::") return;
    Add(Joined(tokens_, i, BehindOperatorName(i)), NameKind::kFunction, i);
  }

  void Add(std::string name, NameKind kind, size_t token, bool is_definition = true,
           std::string text = {}) {
    std::string scope;
    for (const std::string& part : scopes_) {
      if (!scope.empty() && !part.empty()) scope += "::";
      scope += part;
    }
    const bool is_internal = scope.find(kUnnamedScope) != std::string::npos;
    names_.push_back({.scope = scope,
                      .name = std::move(name),
                      .kind = kind,
                      .is_internal = is_internal,
                      .is_definition = is_definition,
                      .line = tokens_[std::min(token, tokens_.size() - 1)].line,
                      .text = std::move(text)});
  }

  const std::vector<SourceToken>& tokens_;
  size_t at_ = 0;
  std::vector<std::string> scopes_;
  std::vector<SourceName> names_;
};

}  // namespace

std::vector<SourceName> NamesOf(std::string_view source) {
  SourceText text = ReadSource(source);
  std::vector<SourceName> names = Reader(text.tokens).Names();
  for (SourceMacro& macro : text.macros) {
    names.push_back({.scope = {},
                     .name = std::move(macro.name),
                     .kind = NameKind::kMacro,
                     .is_internal = true,
                     .line = macro.line,
                     .text = std::move(macro.text)});
  }
  return names;
}

}  // namespace shoal
