// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/commands.h"

#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>

namespace shoal {
namespace {

bool GoesOn(const std::string& text) {
  static const std::regex loop("(^|[;\n] *)(for|while) "), done("(^|[;\n] *)done\\b");
  const auto count = [&](const std::regex& what) {
    return std::distance(std::sregex_iterator(text.begin(), text.end(), what), {});
  };
  return text.ends_with('\\') || std::ranges::count(text, '\'') % 2 == 1 ||
         count(loop) > count(done);
}

bool IsShell(const Block& block) {
  const bool transcript =
      block.language.empty() && !block.lines.empty() && block.lines[0].starts_with("$ ");
  return block.language == "sh" || transcript;
}

}  // namespace

std::vector<Command> CommandsOf(const Block& block) {
  std::vector<Command> commands;
  if (!IsShell(block)) return commands;
  bool open = false;
  for (size_t i = 0; i < block.lines.size(); ++i) {
    std::string line = block.lines[i];
    if (!open && block.language != "sh") {
      if (!line.starts_with("$ ")) continue;  // what the command before said
      line.erase(0, 2);
    }
    if (!open && (line.empty() || line.starts_with("#"))) continue;
    if (open) {
      commands.back().text += "\n" + line;
    } else {
      commands.push_back({block.line + static_cast<int>(i), line});
    }
    open = GoesOn(commands.back().text);
  }
  return commands;
}

std::vector<std::vector<std::string>> OwnCalls(const std::string& text) {
  static const std::regex goes_on("\\\\\n"), comment("(^|\\s)#[^\n]*"),
      end("[;\n|>]|&&|\\b(do|done)\\b");
  static const std::regex program("(.*/)?(shoal(-actor|-learner|-replay)?)"), variable("\\w+=.*");
  std::string plain = std::regex_replace(text, goes_on, " ");
  plain = std::regex_replace(plain, comment, "");
  std::vector<std::vector<std::string>> calls;
  std::sregex_token_iterator part(plain.begin(), plain.end(), end, -1);
  for (; part != std::sregex_token_iterator(); ++part) {
    std::istringstream stream(*part);
    std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    const auto is_variable = [&](const std::string& word) {
      return std::regex_match(word, variable);
    };
    words.erase(words.begin(), std::ranges::find_if_not(words, is_variable));
    std::smatch match;
    if (words.empty()) continue;
    const std::string first = words[0];
    const bool own = std::regex_match(first, match, program);
    if (!own && first != "./run") continue;
    if (own) words[0] = match[2];
    calls.push_back(words);
  }
  return calls;
}

}  // namespace shoal
