// SPDX-License-Identifier: Apache-2.0
// shoal-pictures: compares quality native with the engine's own renderer, over random states of
// every task and camera, and prints JSON (docs/worlds.md).
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "common/image/png.h"
#include "tests/actor/worlds/pictures/picture_comparison.h"

namespace {

using namespace shoal;

int Run(int argc, char** argv) {
  CLI::App app("Compares quality native with the engine's own renderer.", "shoal-pictures");
  int states = 8;
  std::string strip;
  std::vector<std::string> tasks;
  app.add_option("--states", states, "Random states of each task and camera")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--task", tasks, "Tasks; default: one of each physics half");
  app.add_option(
      "--strip", strip,
      "A PNG of the tasks, the engine's pictures above ours, in place of the comparison");
  if (const auto exit_code = ParseCommandLine(&app, argc, argv)) return *exit_code;
  if (tasks.empty()) tasks = worlds::TasksOfAllWorlds();
  if (!strip.empty()) {
    const worlds::PictureStrip drawn = worlds::DrawStrip(tasks);
    image::WritePng(strip, drawn.width, drawn.height, 3, drawn.pixels);
    return 0;
  }
  std::vector<worlds::CameraComparison> comparisons;
  for (const std::string& task : tasks) {
    for (worlds::CameraComparison& camera : worlds::ComparePictures(task, states)) {
      std::cerr << camera.task << " " << camera.camera << "\n";
      comparisons.push_back(std::move(camera));
    }
  }
  std::cout << worlds::ToJson(comparisons).dump(1) << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return GuardMain("shoal-pictures", [&] { return Run(argc, argv); });
}
