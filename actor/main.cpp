// SPDX-License-Identifier: Apache-2.0
#include "actor/program.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-actor", [&] {
    return shoal::actor::RunActorProgram(argc, argv, shoal::actor::WorldParts());
  });
}
