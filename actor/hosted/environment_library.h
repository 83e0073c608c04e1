// SPDX-License-Identifier: Apache-2.0
// User environments in C++, loaded from shared objects: docs/own_environment.md.
//
//   extern "C" void ShoalRegisterEnvironments();   calls AddEnvironment for each environment
//
// A library uses the Shoal functions of the loading program. The library must therefore be built
// with the same compiler and with headers of the same version. Only actors load libraries.
#pragma once

#include <memory>
#include <string>

#include "actor/hosted/raw_environment.h"
#include "common/tasks/environment_spaces.h"

namespace shoal::hosted {

// An environment of a library.
class OwnEnvironment : public RawEnvironment {
 public:
  // Describes the environment's spaces. The caller fills in `id` and `task`. `goal` states the
  // reward; `shoal env check` and each start of a run compare `goal` with the rewards of an
  // episode.
  virtual tasks::EnvironmentDescription Describe() const = 0;
  // The default implementation throws Error: the environment has no pictures.
  RawPicture Render() override;
};

// `kwargs`: the value of env.kwargs, the JSON text of an object; "{}" if the key is not set.
using EnvironmentMaker = std::unique_ptr<OwnEnvironment> (*)(const std::string& kwargs);

// Registers an environment for `shoal train --env LIBRARY.so:NAME`. Call it at the start of a
// program, before threads start. Throws Error (kUsage) if the name is already registered.
void AddEnvironment(const std::string& name, EnvironmentMaker maker);

// Makes the environment that `id` names: "/home/me/catch_light.so:CatchLight". Loads the library
// unless it is already loaded. Throws Error (kUsage) naming the missing file or environment, and
// the environments of the library.
std::unique_ptr<OwnEnvironment> MakeOwnEnvironment(const std::string& id,
                                                   const std::string& kwargs);

}  // namespace shoal::hosted
