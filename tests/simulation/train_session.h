// SPDX-License-Identifier: Apache-2.0
// `shoal train` of a simulated coordinator: the real steps from the request to the end of the run
// (launch/run/training_run.cpp), with a link in memory and simulated processes.
#pragma once

#include <filesystem>
#include <optional>

#include "common/link/hub.h"
#include "launch/run/coordinator.h"
#include "tests/simulation/blueprint.h"
#include "tests/simulation/simulated_processes.h"
#include "tests/simulation/story.h"

namespace shoal::simulation {

// A run: its folder and its parts.
struct World {
  const Blueprint& blueprint;
  std::filesystem::path folder;
  SimulatedProcesses& processes;
  Story& story;
};

enum class Begin { kFresh, kOverwrite, kResume };

// Trains until the run ends. Returns the exit code of `shoal train`. Sets `clean`, as soon as this
// is known, to whether every process ended cleanly. Throws Error.
int Train(const World& world, Begin begin, link::Hub& hub, std::optional<bool>* clean);

// Opens the run like `shoal train --resume` and closes it again. Throws Error if the run is
// refused.
void AskForRun(const World& world);

// The main function of a child process of the run. Returns the exit code.
int RunChild(const Blueprint& blueprint, const std::filesystem::path& folder, Story& story,
             const launch::ProcessSpec& spec, link::Hub& hub);

}  // namespace shoal::simulation
