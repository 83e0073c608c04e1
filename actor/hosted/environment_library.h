// SPDX-License-Identifier: Apache-2.0
// Environments in C++ that need no engine of Shoal's, from shared objects: docs/own_environment.md.
//
//   extern "C" void ShoalRegisterEnvironments();   calls AddEnvironment for each environment
//
// A library uses Shoal's functions as the program that loads it has them, and must be built from
// headers of the same version with the same compiler. Only the actors load it.
#pragma once

#include <memory>
#include <string>

#include "actor/hosted/raw_environment.h"
#include "common/tasks/environment_spaces.h"

namespace shoal::hosted {

// An environment of a library: what it observes, and how it moves.
class OwnEnvironment : public RawEnvironment {
 public:
  // Its spaces. `id` and `task` are filled in by the caller. `goal` states the reward, which
  // `shoal env check` and each start of a run compare with the rewards of an episode.
  virtual tasks::EnvironmentDescription Describe() const = 0;
  // Throws Error: an environment without pictures.
  RawPicture Render() override;
};

// `kwargs`: env.kwargs, the JSON text of an object; "{}" if the user gives none.
using EnvironmentMaker = std::unique_ptr<OwnEnvironment> (*)(const std::string& kwargs);

// Adds an environment; `shoal train --env LIBRARY.so:NAME` names it. At the start of a program,
// before threads. Throws Error (kUsage) when there is another one of that name.
void AddEnvironment(const std::string& name, EnvironmentMaker maker);

// The environment that `id` names: "/home/me/catch_light.so:CatchLight". Loads the library unless
// it is loaded. Throws Error (kUsage) naming what is missing, and those of the library.
std::unique_ptr<OwnEnvironment> MakeOwnEnvironment(const std::string& id,
                                                   const std::string& kwargs);

}  // namespace shoal::hosted
