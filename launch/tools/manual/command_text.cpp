// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/manual/command_text.h"

#include <CLI/CLI.hpp>
#include <regex>

#include "common/config/config_io.h"
#include "common/config/key_description.h"
#include "common/tasks/task_registry.h"
#include "launch/tools/experiment/definition.h"
#include "launch/tools/experiment/reference.h"

namespace shoal::launch {
namespace {

std::vector<Word> Split(std::string text, const std::string& separator) {
  std::vector<Word> words;
  for (size_t at = 0; at != std::string::npos;) {
    at = text.find(separator);
    words.push_back({text.substr(0, at), ""});
    if (at != std::string::npos) text.erase(0, at + separator.size());
  }
  return words;
}

std::vector<Word> Named(const std::vector<std::string>& names) {
  std::vector<Word> words;
  words.reserve(names.size());
  for (const std::string& name : names) words.push_back({name, ""});
  return words;
}

// Keys in the form "learner.batch=".
std::vector<Word> Assignments() {
  std::vector<Word> words;
  for (const KeyDescription& key : DescribeEachKey()) {
    words.push_back({std::string(key.path) + "=", std::string(key.meaning)});
  }
  return words;
}

// Reads choices from "fast | reference" at the start of a meaning, or from the type
// "TEXT:{train,eval}".
std::vector<Word> Choices(const std::string& type, const std::string& meaning) {
  std::smatch match;
  if (std::regex_search(type, match, std::regex("\\{([^}]*)\\}"))) return Split(match[1], ",");
  if (std::regex_search(meaning, match, std::regex("^([a-z0-9-]+( \\| [a-z0-9-]+)+)"))) {
    return Split(match[1], " | ");
  }
  return {};
}

// The known values of an option or argument with this name.
std::vector<Word> KnownValues(const std::string& name, const std::string& type,
                              const std::string& meaning) {
  if (name == "--preset") return Named(ListPresets());
  if (name == "--set" || name == "assignment") return Assignments();
  if (name == "--task" || name == "task") return Named(tasks::TaskNames());
  if (name == "experiment") return Named(ListDefinitions());
  if (name == "--reference") return Named(ListReferences());
  return Choices(type, meaning);
}

// Call it twice for an option that may also be positional: once for each form.
OptionText DescribeOption(const CLI::Option& option, bool positional) {
  const CLI::Formatter formatter;
  OptionText text;
  text.name = formatter.make_option_name(&option, positional);
  text.takes = formatter.make_option_opts(&option);
  text.takes.erase(0, text.takes.find_first_not_of(' '));
  text.meaning = option.get_description();
  text.takes_value = option.get_items_expected_max() > 0;
  if (!positional) {
    for (const std::string& flag : option.get_snames()) text.flags.push_back("-" + flag);
    for (const std::string& flag : option.get_lnames()) text.flags.push_back("--" + flag);
  }
  if (text.takes_value) {
    text.values = KnownValues(text.flags.empty() ? text.name : text.flags.back(),
                              option.get_type_name(), text.meaning);
  }
  return text;
}

}  // namespace

CommandText DescribeCommand(const CLI::App& app, const std::string& name) {
  CommandText text{.name = name,
                   .meaning = app.get_description(),
                   .usage = CLI::Formatter().make_usage(&app, name),
                   .options = {},
                   .commands = {}};
  const std::string label = "Usage: ";
  if (text.usage.starts_with(label)) text.usage.erase(0, label.size());
  text.usage.erase(text.usage.find_last_not_of('\n') + 1);
  // Options without a group are for other programs and hidden from --help.
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* one) { return !one->get_group().empty(); })) {
    if (option->get_positional()) text.options.push_back(DescribeOption(*option, true));
    if (option->nonpositional()) text.options.push_back(DescribeOption(*option, false));
  }
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); })) {
    text.commands.push_back(DescribeCommand(*command, name + " " + command->get_name()));
  }
  return text;
}

std::vector<const CommandText*> AllCommands(const CommandText& command) {
  std::vector<const CommandText*> all = {&command};
  for (const CommandText& below : command.commands) {
    const auto more = AllCommands(below);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace shoal::launch
