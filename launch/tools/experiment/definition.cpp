// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/definition.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/former_keys.h"
#include "common/config/shared_data.h"
#include "common/tasks/task_library.h"
#include "common/tasks/task_registry.h"
#include "launch/tools/experiment/json_members.h"
#include "launch/tools/experiment/reference.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr char kDefinitionSchema[] = "shoal-experiment-definition-1";
constexpr char kKind[] = "experiments";

// Keys that the experiment sets: name, folder and final evaluation of its runs.
constexpr std::array kOwnKeys = {"seed", "run_name", "run_dir", "preset", "eval.final_episodes"};

// The keys of a member, under their present names, so that definitions of different versions can be
// compared.
ordered_json ReadKeys(JsonMembers& members, const std::string& name) {
  const ordered_json* value = members.Find(name);
  ordered_json keys = ordered_json::object();
  if (value == nullptr) return keys;
  if (!value->is_object()) members.Refuse(name, *value, "an object {KEY: VALUE}");
  for (const auto& [key, setting] : value->items()) {
    const std::string present(PresentName(key));
    if (keys.contains(present)) {
      throw UsageError("{}: {}: key '{}' given twice", members.source(), name, present);
    }
    keys[present] = setting;
  }
  return keys;
}

std::vector<Arm> ReadArms(JsonMembers& members, const std::string& source) {
  const ordered_json& list = members.Need("arms");
  if (!list.is_array() || list.empty()) members.Refuse("arms", list, "a list of at least one arm");
  std::vector<Arm> arms;
  std::set<std::string> names;
  for (const ordered_json& entry : list) {
    const std::string where = fmt::format("{}: arm {}", source, arms.size() + 1);
    JsonMembers arm(entry, where);
    arms.push_back({.name = arm.Text("name", ""), .set = ReadKeys(arm, "set")});
    arm.RefuseOthers();
    const std::string& name = arms.back().name;
    if (!IsFileName(name)) {
      throw UsageError("{}: name '{}': expected letters, digits, '.', '_', '-'", where, name);
    }
    if (!names.insert(name).second) throw UsageError("{}: name '{}' is given twice", where, name);
  }
  return arms;
}

std::vector<int64_t> ReadSeeds(JsonMembers& members) {
  const ordered_json& list = members.Need("seeds");
  const char* const expected = "a list of different integers of at least 0";
  if (!list.is_array() || list.empty()) members.Refuse("seeds", list, expected);
  std::vector<int64_t> seeds;
  for (const ordered_json& seed : list) {
    const auto number = NaturalNumber(seed);
    if (!number || std::ranges::count(seeds, *number) > 0) members.Refuse("seeds", list, expected);
    seeds.push_back(*number);
  }
  return seeds;
}

std::vector<std::string> ReadTransfer(JsonMembers& members) {
  const ordered_json* list = members.Find("transfer");
  std::vector<std::string> tasks;
  if (list == nullptr) return tasks;
  if (!list->is_array()) members.Refuse("transfer", *list, "a list of tasks");
  for (const ordered_json& task : *list) {
    if (!task.is_string()) members.Refuse("transfer", *list, "a list of tasks");
    tasks.push_back(task.get<std::string>());
  }
  return tasks;
}

std::vector<int64_t> ReadFrames(JsonMembers& members) {
  const ordered_json* list = members.Find("frames");
  if (list == nullptr) return {};
  const auto frames = IncreasingNumbers(*list);
  if (!frames) members.Refuse("frames", *list, "a list of increasing integers of at least 1");
  return *frames;
}

std::string ReadReferenceName(JsonMembers& members) {
  const ordered_json* name = members.Find("reference");
  if (name == nullptr) return "";
  // A path would have another meaning in another working folder.
  if (!name->is_string() || !IsFileName(name->get<std::string>())) {
    members.Refuse("reference", *name, "the name of a reference (letters, digits, '.', '_', '-')");
  }
  return name->get<std::string>();
}

// Converts {"learner.batch": 8} to {"learner": {"batch": 8}}, the form that ApplyJson takes.
json Nested(const ordered_json& set, const std::string& source) {
  json nested = json::object();
  for (const auto& [key, value] : set.items()) {
    if (std::ranges::find(kOwnKeys, key) != kOwnKeys.end()) {
      throw UsageError("{}: key '{}' is the experiment's own", source, key);
    }
    const size_t dot = key.find('.');
    if (dot == std::string::npos) {
      if (value.is_object()) {
        throw UsageError("{}: key '{}': expected dotted keys, as '{}.KEY'", source, key, key);
      }
      nested[key] = json(value);
    } else {
      nested[key.substr(0, dot)][key.substr(dot + 1)] = json(value);
    }
  }
  return nested;
}

// Prints notes about former names of keys. `holder` may have keys in its member "set".
void NoteFormerNames(const ordered_json& holder) {
  const auto set = holder.find("set");
  if (set == holder.end()) return;
  for (const auto& [key, value] : set->items()) NoteFormerName(key);
}

}  // namespace

Definition ParseDefinition(const ordered_json& object, const std::string& source,
                           const std::string& stem) {
  JsonMembers members(object, source);
  members.NeedSchema(kDefinitionSchema);
  Definition definition;
  definition.name = members.Text("name", stem);
  if (!IsFileName(definition.name)) {
    throw UsageError("{}: name '{}': expected letters, digits, '.', '_', '-'", source,
                     definition.name);
  }
  members.Need("base");
  definition.base = members.Text("base", "");
  definition.question = members.Text("question", "");
  definition.set = ReadKeys(members, "set");
  definition.arms = ReadArms(members, source);
  definition.seeds = ReadSeeds(members);
  if (const ordered_json* episodes = members.Find("final_episodes")) {
    const auto number = NaturalNumber(*episodes);
    if (!number || *number < 1 || *number > 100'000) {
      members.Refuse("final_episodes", *episodes, "an integer in 1..100000");
    }
    definition.final_episodes = static_cast<int>(*number);
  }
  if (const ordered_json* target = members.Find("target_success")) {
    const bool fits =
        target->is_number() && target->get<double>() > 0 && target->get<double>() <= 1;
    if (!fits) members.Refuse("target_success", *target, "a rate in (0, 1]");
    definition.target_success = target->get<double>();
  }
  definition.transfer = ReadTransfer(members);
  definition.frames = ReadFrames(members);
  definition.reference = ReadReferenceName(members);
  members.RefuseOthers();
  return definition;
}

Definition ReadDefinition(const fs::path& file) {
  const std::string text = ReadFile(file);
  ParseStrictJson(text, file);  // refuses broken text and duplicate keys
  const auto object = ParseBoundedJson<ordered_json>(text);
  Definition definition = ParseDefinition(object, file, file.stem());
  NoteFormerNames(object);
  for (const ordered_json& arm : object.at("arms")) NoteFormerNames(arm);
  return definition;
}

ordered_json ToJson(const Definition& definition) {
  ordered_json arms = ordered_json::array();
  for (const Arm& arm : definition.arms) arms.push_back({{"name", arm.name}, {"set", arm.set}});
  ordered_json object{
      {"schema", kDefinitionSchema}, {"name", definition.name}, {"base", definition.base}};
  if (!definition.question.empty()) object["question"] = definition.question;
  object["set"] = definition.set;
  object["arms"] = arms;
  object["seeds"] = definition.seeds;
  if (definition.final_episodes) object["final_episodes"] = *definition.final_episodes;
  object["target_success"] = definition.target_success;
  if (!definition.transfer.empty()) object["transfer"] = definition.transfer;
  if (!definition.frames.empty()) object["frames"] = definition.frames;
  if (!definition.reference.empty()) object["reference"] = definition.reference;
  return object;
}

std::vector<std::string> ListDefinitions() { return ListSharedData(kKind); }

fs::path FindDefinition(const std::string& file_or_name) {
  return FindFileOrSharedData(kKind, "experiment", file_or_name);
}

Config ResolveBase(const Definition& definition, const std::string& source,
                   const std::vector<std::string>& defaults) {
  Config base;
  ApplyAssignments(defaults, &base);
  try {
    ApplyFile(FindPreset(definition.base), &base);
    base.preset = definition.base;
  } catch (const Error& e) {
    throw UsageError("{}: base: {}", source, e.what());
  }
  const std::string where = source + ": set";
  ApplyJson(Nested(definition.set, where), where, &base);
  if (definition.final_episodes) base.eval.final_episodes = *definition.final_episodes;
  return base;
}

void CheckTransfer(const Definition& definition, const std::string& source) {
  for (const std::string& task : definition.transfer) {
    try {
      tasks::FindTask(task);
    } catch (const Error& e) {
      throw UsageError("{}: transfer: {}", source, e.what());
    }
  }
}

void CheckReference(const Definition& definition, const std::string& source) {
  if (definition.reference.empty()) return;
  try {
    ReadReference(FindReference(definition.reference));
  } catch (const Error& e) {
    throw UsageError("{}: reference: {}", source, e.what());
  }
}

Config ArmConfig(const Config& base, const Arm& arm, const std::string& source) {
  const std::string where = fmt::format("{}: arm '{}'", source, arm.name);
  Config config = base;
  ApplyJson(Nested(arm.set, where), where, &config);
  try {
    Validate(config);
    tasks::LoadTaskLibrary(config.task_library);
    if (config.env.id.empty()) tasks::FindTask(config.task);
    const EnvConfig &now = config.env, &before = base.env;
    if (now.id != before.id || now.python != before.python || now.folder != before.folder) {
      throw UsageError(
          "env.id, env.python and env.folder: expected them in the experiment's set: its arms have "
          "one environment");
    }
  } catch (const Error& e) {
    throw UsageError("{}: {}", where, e.what());
  }
  return config;
}

}  // namespace shoal::launch
