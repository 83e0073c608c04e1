// SPDX-License-Identifier: Apache-2.0
#include "common/base/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/nearest_name.h"

namespace shoal {
namespace {

bool IsOption(const std::string& word) {
  const bool number =
      word.size() > 1 && (std::isdigit(static_cast<unsigned char>(word[1])) != 0 || word[1] == '.');
  return word.size() > 1 && word[0] == '-' && !number;
}

// The command and, if unknown options fall through to them, the commands above it.
std::vector<const CLI::App*> Levels(const CLI::App* command) {
  std::vector<const CLI::App*> levels{command};
  while (levels.back()->get_fallthrough() && levels.back()->get_parent() != nullptr) {
    levels.push_back(levels.back()->get_parent());
  }
  return levels;
}

const CLI::Option* FindOption(const CLI::App* command, const std::string& name) {
  for (const CLI::App* level : Levels(command)) {
    if (const CLI::Option* option = level->get_option_no_throw(name)) return option;
  }
  return nullptr;
}

// "shoal env render"
std::string NameOf(const CLI::App* command) {
  const CLI::App* above = command->get_parent();
  return (above == nullptr ? "" : NameOf(above) + " ") + command->get_name();
}

// An unknown option, and the command it was given to.
struct Said {
  const CLI::App* command;
  std::string option;  // empty: every option is known
};

// The first option that its command does not know. If there is none, the command that the words
// select.
Said FindUnknownOption(const CLI::App* app, const std::vector<std::string>& words) {
  const CLI::App* command = app;
  for (size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (!IsOption(words[i])) {
      for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; })) {
        if (below->get_name() != words[i]) continue;
        command = below;
        break;
      }
      continue;
    }
    const std::string name = words[i].substr(0, words[i].find('='));
    const CLI::Option* option = FindOption(command, name);
    if (option == nullptr) return {command, name};
    if (name.size() < words[i].size()) continue;
    // The option's values are neither options nor commands.
    for (int values = option->get_items_expected_max();
         values > 0 && i + 1 < words.size() && !IsOption(words[i + 1]); --values) {
      ++i;
    }
  }
  return {command, ""};
}

// Text such as "; nearest is '--seed'". Compares without dashes, because all options begin with
// them.
std::string NearestOption(const CLI::App* command, const std::string& option) {
  std::vector<std::string> names;
  for (const CLI::App* level : Levels(command)) {
    for (const CLI::Option* one : level->get_options()) {
      if (!one->get_group().empty()) {
        names.insert(names.end(), one->get_lnames().begin(), one->get_lnames().end());
      }
    }
  }
  const std::string nearest = NearestName(option.substr(option.find_first_not_of('-')), names);
  return nearest.empty() ? "" : fmt::format("; nearest is '--{}'", nearest);
}

[[noreturn]] void Refuse(const CLI::App* app, const CLI::ParseError& error,
                         const std::vector<std::string>& words, const WordHint& hint) {
  const auto [command, option] = FindUnknownOption(app, words);
  const std::string name = NameOf(command);
  // GuardMain already prints the program's name.
  const std::string where = command == app ? "" : name.substr(app->get_name().size() + 1) + ": ";
  if (!option.empty()) {
    std::string near = hint ? hint(*command, option) : "";
    if (near.empty()) near = NearestOption(command, option);
    throw UsageError("{}unknown option '{}'{} (see {} --help)", where, option, near, name);
  }
  const std::vector<std::string> remaining = app->remaining(/*recurse=*/true);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) &&
      !remaining.empty()) {
    throw UsageError("{}unexpected argument '{}'{} (see {} --help)", where, remaining[0],
                     hint ? hint(*command, remaining[0]) : "", name);
  }
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    const std::string usage = CLI::Formatter().make_usage(command, name);  // "Usage: shoal ..."
    const size_t at = usage.find(name);
    throw UsageError("{}{}; usage: {}", where, error.what(),
                     usage.substr(at, usage.find('\n', at) - at));
  }
  throw UsageError("{}{} (see {} --help)", where, error.what(), name);
}

}  // namespace

void AddVersion(CLI::App* app) {
  app->set_version_flag("--version", fmt::format("{} {} ({}), licence {}", app->get_name(),
                                                 BuildVersion(), BuildCommit(), kLicence));
}

std::optional<int> ParseCommandLine(CLI::App* app, const std::vector<std::string>& words,
                                    const WordHint& hint) {
  try {
    // CLI11 takes the last word first.
    app->parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::Success& e) {
    return app->exit(e);
  } catch (const CLI::ParseError& e) {
    Refuse(app, e, words, hint);
  }
  return std::nullopt;
}

std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv) {
  return ParseCommandLine(app, std::vector<std::string>(argv + 1, argv + argc));
}

}  // namespace shoal
