// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>
#include <string_view>

#include "actor/hosted_parts.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-actor", [&] {
    const std::span<char*> words(argv, size_t(argc));
    const bool shows = std::ranges::count(words, std::string_view("--frames")) > 0;
    return shoal::actor::RunActorProgram(argc, argv, shoal::actor::WorldOrLibraryParts(shows));
  });
}
