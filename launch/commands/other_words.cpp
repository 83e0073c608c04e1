// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/other_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/base/nearest_name.h"
#include "common/config/config_io.h"
#include "common/config/meant_key.h"
#include "common/tasks/task_registry.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

constexpr char kTrain[] = "train", kJson[] = "--json";
constexpr char kTaskKey[] = "task", kEnvironmentKey[] = "env.id";

struct Advice {
  std::vector<std::string_view> commands;
  std::string_view text;
};

const std::vector<Advice>& Table() {
  static const std::vector<Advice> table{
      {{"log", "logs", "tail"}, "logs are in RUN/logs; shoal attach RUN follows a run"},
      {{"list", "ls", "ps", "status"}, "shoal runs lists runs, shoal env list tasks"},
      {{"enjoy", "play", "view", "render", "visualize", "rollout"},
       "shoal film RUN films a policy, shoal eval RUN evaluates it, shoal env render draws a task"},
      {{"record", "video"}, "shoal film RUN films a policy"},
      {{"evaluate", "test"}, "shoal eval RUN evaluates a policy on fresh episodes"},
      {{"tensorboard", "curves"},
       "tensorboard --logdir runs shows curves; so do shoal web and shoal plot RUN"},
      {{"monitor", "watch", "dashboard", "ui"}, "shoal top RUN, or shoal web in a browser"},
      {{"kill", "cancel", "abort"}, "shoal stop RUN stops a run cleanly"},
      {{"resume", "continue"}, "shoal train --resume RUN continues a run"},
      {{"sweep", "tune", "benchmark"}, "shoal experiment run FILE runs arms x seeds"},
      {{"init", "create"}, "shoal new FOLDER makes a project"},
      {{"doctor", "info"}, "shoal check checks this machine"},
      {{"envs", "tasks"}, "shoal env list lists tasks"},
      {{"presets"}, "shoal train --help lists presets"},
      {{"keys", "params"}, "shoal config lists keys"},
      {{"run", "start", "learn"}, "shoal train --preset NAME"},
      {{"version"}, "shoal --version"},
      {{"help"}, "shoal --help; of a command: shoal COMMAND --help"}};
  return table;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::count(names, name) > 0;
}

// Hint for an option of `train` that corresponds to no single key.
std::string HintForKey(const std::string& option) {
  const MeantKey meant = FindMeantKey(option.substr(option.find_first_not_of('-')));
  if (meant.key.empty()) return meant.note.empty() ? "" : "; " + meant.note;
  return fmt::format("; nearest in meaning is --set {}=VALUE{}{}", meant.key,
                     meant.note.empty() ? "" : ", ", meant.note);
}

// Hint for a word to `train`, which takes options only.
std::string HintForTrainWord(const std::string& word) {
  if (Contains(ListPresets(), word)) return "; it is a preset: --preset " + word;
  if (Contains(tasks::TaskNames(), word)) return "; it is a task: --task " + word;
  if (word.ends_with(".json")) return "; a file of keys is given by --config " + word;
  if (word.find('=') != std::string::npos) return "; keys are set by --set " + word;
  if (IsRun(word)) return "; it is a run, which --resume continues";
  return NearestHint(word, ListPresets());
}

// Whether the value of --env is a task of Shoal's or of the user's task library, which is not
// loaded yet.
bool IsTask(const std::vector<std::string>& words, const std::string& value) {
  const auto names_library = [](const std::string& word) {
    return word.find("task_library") != std::string::npos;
  };
  return Contains(tasks::TaskNames(), value) || std::ranges::any_of(words, names_library);
}

bool IsName(const std::string& word) { return word.size() > 2 && word.starts_with("--"); }

// The value of the option at `*i`, after "=" or in the next word. Moves `*i` to the option's last
// word.
std::string ValueOf(const std::vector<std::string>& words, const std::string& name, size_t* i) {
  if (name.size() < words[*i].size()) return words[*i].substr(name.size() + 1);
  if (*i + 1 == words.size() || IsName(words[*i + 1])) {
    throw UsageError("train: {}: expected a value", name);
  }
  return words[++*i];
}

std::vector<std::string> KeysAsAssignments(const CLI::App& train,
                                           const std::vector<std::string>& words) {
  std::vector<std::string> taken;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    const CLI::Option* option = IsName(name) ? train.get_option_no_throw(name) : nullptr;
    if (option == nullptr && IsName(name)) {
      const MeantKey meant = FindMeantKey(name.substr(2));
      if (meant.same) {
        const std::string value = ValueOf(words, name, &i);
        const bool hosted = meant.key == kTaskKey && name != "--task" && !IsTask(words, value);
        taken.insert(taken.end(), {"--set", (hosted ? kEnvironmentKey : meant.key) + "=" + value});
        continue;
      }
    }
    taken.push_back(words[i]);
    const bool value_follows = option != nullptr && option->get_items_expected_max() > 0 &&
                               name.size() == words[i].size() && i + 1 < words.size();
    if (value_follows) taken.push_back(words[++i]);
  }
  return taken;
}

// The (sub-)command named by the leading words.
const CLI::App& CommandOf(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    const auto below =
        command->get_subcommands([&](const CLI::App* one) { return one->get_name() == word; });
    if (below.empty()) break;
    command = below[0];
  }
  return *command;
}

}  // namespace

std::string HintForCommand(const std::string& command, const std::vector<std::string>& names) {
  for (const Advice& advice : Table()) {
    if (std::ranges::count(advice.commands, command) > 0) return fmt::format("; {}", advice.text);
  }
  return NearestHint(command, names);
}

std::string HintForWord(const CLI::App& command, const std::string& word) {
  if (command.get_name() != kTrain) return "";
  return word.starts_with('-') ? HintForKey(word) : HintForTrainWord(word);
}

std::vector<std::string> AsCommandsTakeThem(const CLI::App& app, std::vector<std::string> words) {
  const CLI::App& command = CommandOf(app, words);
  if (command.get_name() == kTrain) return KeysAsAssignments(command, words);
  const CLI::Option* json = command.get_option_no_throw(kJson);
  if (json == nullptr || json->get_items_expected_max() > 0) return words;
  const auto flag = std::ranges::find(words, kJson);
  if (flag != words.end() && flag + 1 != words.end() && flag[1] == "-") words.erase(flag + 1);
  return words;
}

}  // namespace shoal::launch
