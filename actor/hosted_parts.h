// SPDX-License-Identifier: Apache-2.0
// The parts of an actor that plays a user's environments, in Python or in C++.
#pragma once

#include <functional>
#include <memory>

#include "actor/hosted/raw_environment.h"
#include "actor/program.h"
#include "common/config/config.h"
#include "common/tasks/environment_description.h"

namespace shoal::actor {

// An environment and the description of its spaces.
struct OpenedEnvironment {
  tasks::EnvironmentDescription description;  // without the facts that are found only by playing
  std::unique_ptr<hosted::RawEnvironment> raw;
};

// The purpose for which an environment is opened.
enum class Purpose {
  kPlay,
  kShow,      // plays and renders pictures
  kDescribe,  // also finds out whether Shoal can compute the rewards for other goals
};

// Opens the environment of config.env. Throws Error.
using EnvironmentOpener = std::function<OpenedEnvironment(const Config&, Purpose)>;

// `shows`: the environments of this process will render pictures.
ActorParts HostedParts(EnvironmentOpener open, bool shows);

// Environments of a library (actor/hosted/environment_library.h).
ActorParts LibraryParts(bool shows);

// Shoal's own worlds or environments of a library, depending on the configuration.
ActorParts WorldOrLibraryParts(bool shows);

}  // namespace shoal::actor
