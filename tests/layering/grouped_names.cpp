// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/grouped_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "common/base/files.h"
#include "tests/layering/source_names.h"
#include "tests/layering/source_tokens.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

struct File {
  std::vector<SourceName> names;
  std::vector<std::string> includes;  // those that are in the tree
  std::map<std::string, int> free_names;
};

// Reads each file once.
class Tree {
 public:
  explicit Tree(const fs::path& root) : root_(root) {}

  const File& Get(const std::string& path) {
    const auto [entry, is_new] = files_.try_emplace(path);
    if (!is_new) return entry->second;
    const std::string text = ReadFile(root_ / path);
    File& file = entry->second;
    file.names = NamesOf(text);
    const SourceText tokens = ReadSource(text);
    file.free_names = FreeNames(tokens);
    for (const std::string& include : tokens.includes) {
      if (fs::exists(root_ / include)) file.includes.push_back(include);
    }
    return file;
  }

  // All headers of the tree that `path` includes, directly or not.
  std::set<std::string> HeadersOf(const std::string& path) {
    std::set<std::string> headers;
    std::vector<std::string> pending = Get(path).includes;
    while (!pending.empty()) {
      const std::string header = pending.back();
      pending.pop_back();
      if (!headers.insert(header).second) continue;
      std::ranges::copy(Get(header).includes, std::back_inserter(pending));
    }
    return headers;
  }

 private:
  fs::path root_;
  std::map<std::string, File> files_;
};

struct Place {
  std::string file;
  SourceName name;

  std::string Text() const { return fmt::format("{}:{}", file, name.line); }
};

bool IsImport(NameKind kind) {
  return kind == NameKind::kAlias || kind == NameKind::kImport || kind == NameKind::kMacro;
}

// Found by the types of their arguments, and never used as a pointer.
bool IsOverloadedHook(const std::string& name) {
  return name.starts_with("operator ") || name == "PrintTo" || name == "to_json" ||
         name == "from_json";
}

bool SayTheSame(const SourceName& a, const SourceName& b) {
  return IsImport(a.kind) && IsImport(b.kind) && a.text == b.text;
}

bool CollideInOneScope(const SourceName& a, const SourceName& b) {
  if (IsOverloadedHook(a.name) || SayTheSame(a, b)) return false;
  if (a.kind == NameKind::kType && b.kind == NameKind::kType) {
    return a.is_internal || (a.is_definition && b.is_definition);
  }
  return a.is_internal && b.is_internal;
}

// "shoal" of "shoal::(unnamed)"; a name that nothing has where there is no unnamed namespace.
std::string Around(const std::string& scope) {
  const std::string end = std::string("::") + kUnnamedScope;
  if (scope == kUnnamedScope) return "";
  return scope.ends_with(end) ? scope.substr(0, scope.size() - end.size()) : scope + "::?";
}

// Names of one target's sources, by scope and name.
class Target {
 public:
  Target(std::string name, const std::vector<std::string>& sources, Tree* tree)
      : name_(std::move(name)), tree_(tree) {
    for (const std::string& source : sources) {
      headers_[source] = tree->HeadersOf(source);
      for (const SourceName& found : tree->Get(source).names) {
        places_[{found.scope, found.name}].push_back({source, found});
        if (found.kind == NameKind::kLocal) locals_[found.name].push_back({source, found});
      }
    }
    for (const auto& [source, headers] : headers_) {
      for (const std::string& header : headers) readers_[header].push_back(source);
    }
    for (const auto& [header, readers] : readers_) {
      for (const SourceName& found : tree->Get(header).names) {
        if (found.kind != NameKind::kMacro && found.kind != NameKind::kLocal) {
          in_headers_[{found.scope, found.name}].push_back({header, found});
        }
      }
    }
  }

  std::vector<std::string> Collisions() {
    for (const auto& [key, places] : places_) {
      for (const Place& place : places) {
        for (const Place& other : places) {
          if (&place < &other && CollideInOneScope(place.name, other.name)) Report(place, other);
        }
        if (place.name.is_internal && place.name.kind != NameKind::kMacro) FindAround(place);
        if (place.name.is_internal && place.name.kind == NameKind::kValue) FindLocals(place);
        if (place.name.is_internal && place.name.kind == NameKind::kValue) FindUses(place);
      }
    }
    return {collisions_.begin(), collisions_.end()};
  }

 private:
  // Names of another source in the namespace around an unnamed one.
  void FindAround(const Place& place) {
    if (IsOverloadedHook(place.name.name)) return;
    const std::pair<std::string, std::string> around(Around(place.name.scope), place.name.name);
    if (const auto found = places_.find(around); found != places_.end()) {
      for (const Place& other : found->second) {
        if (other.name.kind != NameKind::kLocal && !SayTheSame(place.name, other.name))
          Report(place, other);
      }
    }
    const auto found = in_headers_.find(around);
    if (found == in_headers_.end()) return;
    for (const Place& other : found->second) {
      const std::vector<std::string>& readers = readers_.at(other.file);
      // A source that includes the header itself compiles with it.
      if (std::ranges::find(readers, place.file) == readers.end()) Report(place, other);
    }
  }

  void FindLocals(const Place& place) {
    const auto found = locals_.find(place.name.name);
    if (found == locals_.end()) return;
    for (const Place& other : found->second) {
      if (other.name.scope.starts_with(place.name.scope)) Report(place, other);
    }
  }

  void FindUses(const Place& place) {
    for (const auto& [source, headers] : headers_) {
      const std::map<std::string, int>& free_names = tree_->Get(source).free_names;
      const auto use = free_names.find(place.name.name);
      if (use == free_names.end()) continue;
      SourceName name = place.name;
      name.line = use->second;
      Report(place, {source, name});
    }
  }

  void Report(const Place& a, const Place& b) {
    if (a.file == b.file) return;
    collisions_.insert(fmt::format("{}: {} in {} and {}", name_, a.name.name,
                                   std::min(a.Text(), b.Text()), std::max(a.Text(), b.Text())));
  }

  using Key = std::pair<std::string, std::string>;  // scope, name

  std::string name_;
  Tree* tree_;
  std::map<Key, std::vector<Place>> places_, in_headers_;
  std::map<std::string, std::vector<Place>> locals_;
  std::map<std::string, std::set<std::string>> headers_;     // by source
  std::map<std::string, std::vector<std::string>> readers_;  // sources by header
  std::set<std::string> collisions_;
};

}  // namespace

GroupedSources ReadGroupedSources(const fs::path& file) {
  GroupedSources targets;
  std::istringstream lines(ReadFile(file));
  for (std::string target, source; lines >> target >> source;) targets[target].push_back(source);
  return targets;
}

std::vector<std::string> FindCollisions(const fs::path& root, const GroupedSources& targets) {
  Tree tree(root);
  std::vector<std::string> collisions;
  for (const auto& [name, sources] : targets) {
    if (sources.size() > 1) {
      std::ranges::copy(Target(name, sources, &tree).Collisions(), std::back_inserter(collisions));
    }
  }
  return collisions;
}

}  // namespace shoal
