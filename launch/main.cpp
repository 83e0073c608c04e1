// SPDX-License-Identifier: Apache-2.0
// shoal: the command line. See launch/commands.
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "launch/commands/command_line.h"

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal", [&] { return shoal::launch::RunCommandLine(argc, argv); });
}
