// SPDX-License-Identifier: Apache-2.0
// shoal-actor: one program, four uses: training actor, evaluation actor, evaluation of a
// checkpoint, description of what the actors of a configuration observe.
#pragma once

namespace shoal::actor {

// Runs what the command line asks for; returns the exit code. Throws Error (kUsage) on a command
// line that makes no sense, else as what was asked for does.
int RunActorProgram(int argc, char** argv);

}  // namespace shoal::actor
