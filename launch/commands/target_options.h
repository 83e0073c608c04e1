// The options that say which run a command is about.
#pragma once

#include "launch/watch/run_target.h"

namespace CLI {
class App;
}

namespace shoal::launch {

// Adds --run, --peer, --secure and --run-dir. `options` must live as long as the command line.
void AddTargetOptions(CLI::App& command, TargetOptions* options);

}  // namespace shoal::launch
