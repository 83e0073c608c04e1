// SPDX-License-Identifier: Apache-2.0
// `shoal train` as a simulated coordinator runs it: the product's steps from the request to the end
// of the run (launch/run/training_run.cpp), over a link in memory and with simulated processes.
#pragma once

#include <filesystem>
#include <optional>

#include "common/link/hub.h"
#include "launch/run/coordinator.h"
#include "tests/simulation/blueprint.h"
#include "tests/simulation/simulated_processes.h"
#include "tests/simulation/story.h"

namespace shoal::simulation {

// A run: where its files are, and what takes part.
struct World {
  const Blueprint& blueprint;
  std::filesystem::path folder;
  SimulatedProcesses& processes;
  Story& story;
};

enum class Begin { kFresh, kOverwrite, kResume };

// Trains until the run ends; returns the exit code of `shoal train`. `clean` says whether every
// process left in order, once that is known. Throws Error.
int Train(const World& world, Begin begin, link::Hub& hub, std::optional<bool>* clean);

// Asks for the run as `shoal train --resume` does, and lets go of it. Throws Error where it is
// refused.
void AskForRun(const World& world);

// The body of a child process of the run.
int RunChild(const Blueprint& blueprint, const std::filesystem::path& folder, Story& story,
             const launch::ProcessSpec& spec, link::Hub& hub);

}  // namespace shoal::simulation
