// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/environment_library.h"

#include <fmt/ranges.h>

#include <map>

#include "common/base/error.h"
#include "common/tasks/environment_description.h"
#include "common/tasks/task_library.h"

namespace shoal::hosted {
namespace {

std::map<std::string, EnvironmentMaker>& Makers() {
  static std::map<std::string, EnvironmentMaker> makers;
  return makers;
}

}  // namespace

RawPicture OwnEnvironment::Render() {
  throw RuntimeError("the environment draws no pictures: it has no Render");
}

void AddEnvironment(const std::string& name, EnvironmentMaker maker) {
  if (name.empty() || maker == nullptr) {
    throw UsageError("AddEnvironment: environment '{}': expected a name and a function", name);
  }
  if (!Makers().emplace(name, maker).second) {
    throw UsageError("there is an environment '{}' already", name);
  }
}

std::unique_ptr<OwnEnvironment> MakeOwnEnvironment(const std::string& id,
                                                   const std::string& kwargs) {
  const std::string library = tasks::LibraryOf(id);
  tasks::CallEntryPoint(library, {.function = "ShoalRegisterEnvironments",
                                  .key = "env.id",
                                  .page = "docs/own_environment.md"});
  const std::string name = id.substr(library.size() + 1);
  const auto maker = Makers().find(name);
  if (maker == Makers().end()) {
    std::vector<std::string> known;
    known.reserve(Makers().size());
    for (const auto& [known_name, make] : Makers()) known.push_back(known_name);
    throw UsageError("env.id: '{}' has no environment '{}'; expected {}", library, name,
                     fmt::join(known, ", "));
  }
  std::unique_ptr<OwnEnvironment> environment = maker->second(kwargs);
  if (environment == nullptr) {
    throw UsageError("env.id '{}': the function given to AddEnvironment returned no environment",
                     id);
  }
  return environment;
}

}  // namespace shoal::hosted
