// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_io.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/one_line.h"
#include "common/base/random.h"
#include "common/config/config_keys.h"
#include "common/config/meant_key.h"
#include "common/config/nearest_key.h"
#include "common/config/value_json.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

using internal::Key;
using nlohmann::json;
using Intervals = std::map<std::string, std::array<double, 2>>;

// Text as JSON, with a replacement character for what is not UTF-8.
std::string Quoted(const std::string& text) {
  return json(text).dump(-1, ' ', /*ensure_ascii=*/false, json::error_handler_t::replace);
}

// A configuration ends in JSON, which holds nothing else; its files have been checked when parsed.
bool IsUtf8(const std::string& text) {
  try {
    json(text).dump();
    return true;
  } catch (const json::type_error&) {
    return false;
  }
}

// The part of a value that a refusal quotes.
std::string Shown(const json& value) { return Shortened(value.dump(), 200); }

[[noreturn]] void Refuse(const Key& key, const json& value, const std::string& source) {
  if (std::holds_alternative<internal::FileName>(key.rule) && value.is_string() &&
      value.get_ref<const std::string&>().size() > internal::kLongestFileName) {
    throw UsageError("{}: {} = {}: too long with {} characters, expected at most {}", source,
                     key.path, Shown(value), value.get_ref<const std::string&>().size(),
                     internal::kLongestFileName);
  }
  throw UsageError("{}: {} = {}: expected {}", source, key.path, Shown(value),
                   internal::Expected(key));
}

bool IsFileName(const std::string& text) {
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
  };
  return !text.empty() && text.size() <= internal::kLongestFileName && text[0] != '.' &&
         text[0] != '-' && std::ranges::all_of(text, allowed);
}

// Does the key's rule allow a value that already has the right type?
struct Allows {
  const internal::Rule& rule;

  bool operator()(bool) const { return true; }
  bool operator()(int64_t value) const {
    const auto* range = std::get_if<internal::IntegerRange>(&rule);
    return range == nullptr || (value >= range->low && value <= range->high);
  }
  bool operator()(double value) const {
    const auto* range = std::get_if<internal::RealRange>(&rule);
    if (range == nullptr) return true;
    return (range->low_open ? value > range->low : value >= range->low) &&
           (range->high_open ? value < range->high : value <= range->high);
  }
  bool operator()(const std::string& value) const {
    if (const auto* choices = std::get_if<internal::Choices>(&rule)) {
      return std::ranges::find(choices->words, value) != choices->words.end();
    }
    if (const auto* name = std::get_if<internal::FileName>(&rule)) {
      return IsFileName(value) || (name->optional && value.empty());
    }
    return true;
  }
};

// 1e5 is an integer, too; beyond 2^53 a real number does not tell neighbours apart.
json AsInteger(const json& value) {
  if (!value.is_number_float()) return value;
  const double number = value.get<double>();
  constexpr double kExact = 9007199254740992;
  if (std::abs(number) > kExact || number != std::trunc(number)) return value;
  return static_cast<int64_t>(number);
}

// Reads one JSON value as T; false when it has another type, does not fit T, or breaks the rule.
template <class T>
bool Read(const json& value, const internal::Rule& rule, T* out) {
  const Allows allows{rule};
  if constexpr (std::is_same_v<T, bool>) {
    if (!value.is_boolean()) return false;
    *out = value.get<bool>();
    return true;
  } else if constexpr (std::is_integral_v<T>) {
    const json integer = AsInteger(value);
    if (!integer.is_number_integer()) return false;
    const bool too_large = integer.is_number_unsigned() &&
                           integer.get<uint64_t>() > uint64_t(std::numeric_limits<int64_t>::max());
    if (too_large || !allows(integer.get<int64_t>())) return false;
    *out = static_cast<T>(integer.get<int64_t>());
    return true;
  } else if constexpr (std::is_floating_point_v<T>) {
    if (!value.is_number() || !allows(value.get<double>())) return false;
    *out = value.get<double>();
    return true;
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!value.is_string() || !allows(value.get_ref<const std::string&>())) return false;
    *out = value.get<std::string>();
    return true;
  } else if constexpr (std::is_same_v<T, StateBlocks>) {
    return internal::ReadStateBlocks(value, out);
  } else if constexpr (std::is_same_v<T, KeywordArguments>) {
    if (!value.is_object()) return false;
    out->json = value.dump();
    return true;
  } else if constexpr (std::is_same_v<T, Schedule>) {
    double constant = 0;
    if (Read(value, rule, &constant)) {
      *out = Schedule::Constant(constant);
      return true;
    }
    if (!value.is_string()) return false;
    const auto schedule = ParseSchedule(value.get_ref<const std::string&>());
    if (!schedule || !allows(schedule->start) || !allows(schedule->end)) return false;
    *out = *schedule;
    return true;
  } else if constexpr (std::is_same_v<T, Intervals>) {
    if (!value.is_object()) return false;
    Intervals intervals;
    for (const auto& [name, bounds] : value.items()) {
      if (!bounds.is_array() || bounds.size() != 2) return false;
      auto& [low, high] = intervals[name];
      if (!Read(bounds[0], rule, &low) || !Read(bounds[1], rule, &high) || low > high) return false;
    }
    *out = std::move(intervals);
    return true;
  } else if constexpr (std::is_same_v<T, std::map<std::string, CustomCamera>>) {
    return internal::ReadCustomCameras(value, out);
  } else {
    if (!value.is_array()) return false;
    T list;
    for (const json& element : value) {
      typename T::value_type item{};
      if (!Read(element, rule, &item)) return false;
      list.push_back(item);
    }
    *out = std::move(list);
    return true;
  }
}

void Assign(const Key& key, const json& value, const std::string& source, Config* config) {
  const auto read = [&](auto* slot) { return Read(value, key.rule, slot); };
  if (!std::visit(read, key.slot(*config))) Refuse(key, value, source);
}

// Former names of keys, which files of older runs and experiments have, and today's names.
constexpr std::pair<std::string_view, std::string_view> kFormerNames[] = {
    {"ppo.normalise_observations", "learner.normalise_vectors"}};

const Key* FindKey(std::string_view path) {
  const auto former = std::ranges::find(kFormerNames, path, [](auto& name) { return name.first; });
  if (former != std::end(kFormerNames)) path = former->second;
  const auto key = std::ranges::find(internal::Keys(), path, &Key::path);
  return key == internal::Keys().end() ? nullptr : &*key;
}

bool IsSection(std::string_view path) {
  const std::string prefix = std::string(path) + ".";
  return std::ranges::any_of(internal::Keys(),
                             [&](const Key& key) { return key.path.starts_with(prefix); });
}

// A hint at the key that was meant: by another program's name, else by the spelling.
std::string HintFor(const std::string& path) {
  const MeantKey meant = FindMeantKey(path);
  if (meant.same) return fmt::format("it is called '{}' here", meant.key);
  if (!meant.key.empty()) {
    return fmt::format("nearest in meaning is '{}', {}", meant.key, meant.note);
  }
  if (!meant.note.empty()) return meant.note;
  const std::string nearest = internal::NearestKey(path);
  return nearest.empty() ? "nothing known is near it (--print-config lists all)"
                         : "nearest is '" + nearest + "'";
}

[[noreturn]] void RefuseUnknown(const std::string& path, const std::string& source) {
  throw UsageError("{}: unknown key '{}', {}", source, path, HintFor(path));
}

void ApplySection(const json& object, const std::string& prefix, const std::string& source,
                  Config* config) {
  for (const auto& [name, value] : object.items()) {
    const std::string path = prefix + name;
    if (name.find('.') != std::string::npos) {
      throw UsageError("{}: key '{}': sections are nested objects in JSON, not dotted names",
                       source, path);
    }
    if (const Key* key = FindKey(path)) {
      Assign(*key, value, source, config);
    } else if (!IsSection(path)) {
      RefuseUnknown(path, source);
    } else if (!value.is_object()) {
      throw UsageError("{}: {} = {}: expected an object of keys", source, path, Shown(value));
    } else {
      ApplySection(value, path + ".", source, config);
    }
  }
}

// The value of an assignment: JSON where it is JSON, else the text itself, so that
// observation.quality=fast needs no quotes.
json AssignedValue(const Key& key, const std::string& text) {
  Config scratch;
  if (std::holds_alternative<std::string*>(key.slot(scratch)) && !text.starts_with('"'))
    return text;
  json value = ParseBoundedJson<json>(text);
  return value.is_discarded() ? json(text) : value;
}

// Keys that say how long a run goes on or where it lies, not what it computes.
bool PartOfIdentity(std::string_view path) {
  return path != "preset" && path != "run_name" && path != "run_dir" && path != "env_steps" &&
         !path.starts_with("stop.");
}

nlohmann::ordered_json KeysToJson(const Config& config, bool (*wanted)(std::string_view)) {
  Config copy = config;  // slots are mutable pointers
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Key& key : internal::Keys()) {
    if (!wanted(key.path)) continue;
    const size_t dot = key.path.find('.');
    const std::string name(key.path.substr(dot == std::string_view::npos ? 0 : dot + 1));
    auto& section =
        dot == std::string_view::npos ? object : object[std::string(key.path.substr(0, dot))];
    std::visit([&](const auto* slot) { section[name] = *slot; }, key.slot(copy));
  }
  return object;
}

}  // namespace

void ApplyJson(const json& object, const std::string& source, Config* config) {
  if (!object.is_object()) throw UsageError("{}: expected one JSON object of keys", source);
  ApplySection(object, "", source, config);
}

void ApplyFile(const std::string& path, Config* config) {
  json object = ParseStrictJson(ReadFile(path), path);
  // Tells an editor what keys there are (config_schema.h).
  if (object.is_object() && object.contains("$schema") && object["$schema"].is_string()) {
    object.erase("$schema");
  }
  // A run's config.json may be used as a configuration; what describes the run is not a key.
  if (object.is_object() && object.contains("schema") && object["schema"] == kConfigSchema) {
    for (const char* name : {"schema", "spec", "spec_hash", "config_hash"}) object.erase(name);
  }
  ApplyJson(object, path, config);
}

void ApplyAssignments(const std::vector<std::string>& assignments, Config* config) {
  std::set<std::string> seen;
  for (const std::string& assignment : assignments) {
    if (!IsUtf8(assignment)) {
      throw UsageError("--set {}: expected text in UTF-8", Quoted(assignment));
    }
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set {}: expected KEY=VALUE", Shortened(assignment, 200));
    }
    const std::string path = assignment.substr(0, equals);
    const Key* key = FindKey(path);
    if (key == nullptr && IsSection(path)) {
      throw UsageError("--set {}: '{}' is a section; set one of its keys", assignment, path);
    }
    if (key == nullptr) RefuseUnknown(path, "--set");
    if (!seen.insert(path).second) throw UsageError("--set: key '{}' given twice", path);
    Assign(*key, AssignedValue(*key, assignment.substr(equals + 1)), "--set", config);
  }
}

nlohmann::ordered_json ToJson(const Config& config) {
  return KeysToJson(config, [](std::string_view) { return true; });
}

uint64_t ConfigHash(const Config& config) {
  const std::string text = KeysToJson(config, PartOfIdentity).dump();
  return HashBytes(text.data(), text.size());
}

}  // namespace shoal
