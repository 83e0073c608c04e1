// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_io.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/one_line.h"
#include "common/base/random.h"
#include "common/config/config_keys.h"
#include "common/config/former_keys.h"
#include "common/config/key_value.h"
#include "common/config/meant_key.h"
#include "common/config/nearest_key.h"
#include "common/config/value_json.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

using internal::Key;
using nlohmann::json;

// The text as JSON. Bytes that are not UTF-8 become replacement characters.
std::string Quoted(const std::string& text) {
  return json(text).dump(-1, ' ', /*ensure_ascii=*/false, json::error_handler_t::replace);
}

// A configuration is written as JSON, which is UTF-8. Text from files was checked when it was
// parsed.
bool IsUtf8(const std::string& text) {
  try {
    json(text).dump();
    return true;
  } catch (const json::type_error&) {
    return false;
  }
}

// The part of a value that an error quotes.
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

void Assign(const Key& key, const json& value, const std::string& source, Config* config) {
  if (!internal::AssignValue(key, value, config)) Refuse(key, value, source);
}

const Key* FindKey(std::string_view path) {
  const auto key = std::ranges::find(internal::Keys(), PresentName(path), &Key::path);
  return key == internal::Keys().end() ? nullptr : &*key;
}

bool IsSection(std::string_view path) {
  const std::string prefix = std::string(path) + ".";
  return std::ranges::any_of(internal::Keys(),
                             [&](const Key& key) { return key.path.starts_with(prefix); });
}

// A hint at the key that was probably meant: by another program's name, else by the spelling.
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

// Applies the keys of one text, which may use former names.
class KeyApplication {
 public:
  // `notes`: a line on stderr for each former name. Borrows `config`.
  KeyApplication(std::string source, bool notes, Config* config)
      : source_(std::move(source)), notes_(notes), config_(config) {}

  void ApplySection(const json& object, const std::string& prefix) {
    for (const auto& [name, value] : object.items()) {
      const std::string path = prefix + name;
      if (name.find('.') != std::string::npos) {
        throw UsageError("{}: key '{}': sections are nested objects in JSON, not dotted names",
                         source_, path);
      }
      if (const Key* key = FindKey(path)) {
        Take(*key, path);
        Assign(*key, value, source_, config_);
      } else if (!IsSection(path)) {
        RefuseUnknown(path, source_);
      } else if (!value.is_object()) {
        throw UsageError("{}: {} = {}: expected an object of keys", source_, path, Shown(value));
      } else {
        ApplySection(value, path + ".");
      }
    }
  }

  // Refuses a key that occurs twice in the text, under one name or two.
  void Take(const Key& key, const std::string& path) {
    if (!seen_.insert(key.path).second) {
      const std::string also = path == key.path ? "" : fmt::format(" (as '{}')", path);
      throw UsageError("{}: key '{}' given twice{}", source_, key.path, also);
    }
    if (notes_) NoteFormerName(path);
  }

 private:
  const std::string source_;
  const bool notes_;
  Config* const config_;
  std::set<std::string_view> seen_;
};

void ApplyObject(const json& object, const std::string& source, bool notes, Config* config) {
  if (!object.is_object()) throw UsageError("{}: expected one JSON object of keys", source);
  KeyApplication(source, notes, config).ApplySection(object, "");
}

// The value of an assignment: JSON if the text is JSON, else the text itself.
// observation.quality=fast thus needs no quotes.
json AssignedValue(const Key& key, const std::string& text) {
  Config scratch;
  if (std::holds_alternative<std::string*>(key.slot(scratch)) && !text.starts_with('"'))
    return text;
  json value = ParseBoundedJson<json>(text);
  return value.is_discarded() ? json(text) : value;
}

// Whether the key influences what a run computes. Other keys say how long it goes on, where it is
// stored, and which processor computes it: a run may change its device when it is resumed.
bool PartOfIdentity(std::string_view path) {
  return path != "preset" && path != "run_name" && path != "run_dir" && path != "env_steps" &&
         path != "learner.device" && !path.starts_with("stop.");
}

nlohmann::ordered_json KeysToJson(const Config& config, bool (*wanted)(std::string_view)) {
  Config copy = config;  // slots are pointers to mutable members
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
  ApplyObject(object, source, /*notes=*/true, config);
}

void ApplyStoredJson(const json& object, const std::string& source, Config* config) {
  ApplyObject(object, source, /*notes=*/false, config);
}

void ApplyFile(const std::string& path, Config* config) {
  json object = ParseStrictJson(ReadFile(path), path);
  // `$schema` tells an editor which keys exist (config_schema.h).
  if (object.is_object() && object.contains("$schema") && object["$schema"].is_string()) {
    object.erase("$schema");
  }
  // A run's config.json may be used as a configuration. The members that describe the run are not
  // keys.
  const bool of_a_run =
      object.is_object() && object.contains("schema") && object["schema"] == kConfigSchema;
  if (of_a_run) {
    for (const char* name : {"schema", "spec", "spec_hash", "config_hash"}) object.erase(name);
  }
  ApplyObject(object, path, /*notes=*/!of_a_run, config);
}

void ApplyAssignments(const std::vector<std::string>& assignments, Config* config) {
  KeyApplication application("--set", /*notes=*/true, config);
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
    application.Take(*key, path);
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
