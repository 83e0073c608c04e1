// SPDX-License-Identifier: Apache-2.0
#include "launch/run/environment_choice.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "actor/hosted/hosted_spec.h"
#include "common/base/error.h"
#include "common/base/search_path.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kPythonFile[] = ".py:";

// Does not resolve links: the python of a virtual environment is a link, and Python finds the
// environment by the path of that link.
std::string Absolute(const std::string& path) { return fs::absolute(path).lexically_normal(); }

std::string OnSearchPath(const std::string& program) {
  if (const auto file = FindOnSearchPath(program)) return Absolute(*file);
  throw UsageError("env.python: there is no {} on the PATH; expected the path of an interpreter",
                   program);
}

std::string ChoosePython(const std::string& asked) {
  if (asked.empty()) {
    const char* active = std::getenv("VIRTUAL_ENV");
    const fs::path of_active = fs::path(active == nullptr ? "" : active) / "bin/python";
    if (active != nullptr && IsExecutable(of_active)) return Absolute(of_active);
    return OnSearchPath("python3");
  }
  if (asked.find('/') == std::string::npos) return OnSearchPath(asked);
  if (IsExecutable(asked)) return Absolute(asked);
  throw UsageError("env.python '{}' is no program; expected the path of a Python interpreter",
                   asked);
}

}  // namespace

void CompleteEnvironmentKeys(Config* config) {
  EnvConfig& env = config->env;
  if (env.id.empty()) return;
  const std::string library = tasks::LibraryOf(env.id);
  if (const size_t at = env.id.rfind(kPythonFile); at != std::string::npos || !library.empty()) {
    const std::string file = library.empty() ? env.id.substr(0, at + 3) : library;
    const std::string name = env.id.substr(file.size() + 1);
    if (!fs::exists(file)) throw UsageError("env.id '{}': file '{}' does not exist", env.id, file);
    if (name.empty()) {
      throw UsageError("env.id '{}': expected the name of an environment after the colon", env.id);
    }
    env.id = fmt::format("{}:{}", Absolute(file), name);
  } else if (env.id.ends_with(".py") || env.id.ends_with(".so")) {
    throw UsageError("env.id '{}': expected {}:NAME, an environment of the file", env.id, env.id);
  }
  if (library.empty()) {
    env.python = ChoosePython(env.python);
    env.folder = Absolute(env.folder.empty() ? "." : env.folder);
  } else if (!env.python.empty()) {
    throw UsageError("env.python: no Python runs the environment {}; expected the key unset",
                     env.id);
  }
  config->task = tasks::TaskNameOf(env.id);
}

EnvironmentDefaults DefaultsFor(const tasks::EnvironmentDescription& environment) {
  EnvironmentDefaults defaults;
  const std::vector<std::string> images = hosted::ImagesOf(environment);
  if (images.empty()) {
    defaults.preset = "state";
    defaults.reason = "it observes no image";
  } else {
    defaults.preset = "pixels";
    defaults.reason = fmt::format("it observes {}", fmt::join(images, ", "));
    const auto is_grey = [&](const std::string& name) {
      return ImageLayoutOf(*environment.Find(name))->channels == 1;
    };
    if (std::ranges::all_of(images, is_grey)) {
      defaults.assignments.emplace_back("observation.grey=true");
    }
  }
  if (environment.goal) defaults.assignments.emplace_back("observation.goal_mode=both");
  return defaults;
}

}  // namespace shoal::launch
