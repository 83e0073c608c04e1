// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "actor/worlds/physics_library.h"
#include "actor/worlds/tools/contact_sheet.h"
#include "actor/worlds/tools/render_task.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/image/png.h"
#include "launch/commands/commands.h"
#include "launch/commands/env_tasks.h"
#include "launch/commands/target_options.h"

namespace shoal::launch {
namespace {

int Render(const worlds::RenderRequest& request, const std::string& png) {
  const worlds::Picture picture = worlds::RenderTask(request);
  image::WritePng(png, picture.width, picture.height, 3, picture.pixels);
  std::cout << png << ": " << request.task << ", camera " << picture.camera << ", " << picture.width
            << "x" << picture.height << ", "
            << (request.goal ? "the goal reached"
                             : fmt::format("after {} env steps", request.env_steps))
            << "\n";
  return 0;
}

int DrawSheet(const worlds::ContactSheetRequest& request, const std::string& png) {
  CheckWritable(png);
  const worlds::Picture sheet = worlds::DrawContactSheet(worlds::PlanContactSheet(), request);
  image::WritePng(png, sheet.width, sheet.height, 3, sheet.pixels);
  std::cout << png << ": every task, camera and quality, " << sheet.width << "x" << sheet.height
            << "\n";
  return 0;
}

void AddRender(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand(
      "render", "Draw one picture of a task, or of all tasks, cameras and qualities.");
  const auto request = std::make_shared<worlds::RenderRequest>();
  const auto whole = std::make_shared<bool>(false);
  const auto sheet = std::make_shared<worlds::ContactSheetRequest>();
  const auto png = std::make_shared<std::string>();
  CLI::Option* task = command->add_option("task", request->task, "Task, e.g. FetchReachDense");
  command->add_option("--camera", request->camera, "Camera of the task; its first by default");
  ExpectPng(command->add_option("--png", *png, "File to write")->required());
  command->add_option("--steps", request->env_steps, "Random env steps before the picture")
      ->capture_default_str();
  command->add_option("--seed", request->seed, "Seed of the goal and the actions")
      ->capture_default_str();
  command->add_option("--quality", request->quality, "fast | native | reference")
      ->capture_default_str();
  command->add_option("--width", request->width, "Pixels")->capture_default_str();
  command->add_option("--height", request->height, "Pixels")->capture_default_str();
  command->add_option("--model", request->model, "Another MJCF file for the task");
  command->add_flag("--goal", request->goal,
                    "Draw the goal reached, as observation.goal_mode = image shows it");
  const auto segments = std::make_shared<bool>(false), depths = std::make_shared<bool>(false);
  CLI::Option* segmentation = command->add_flag("--segmentation", *segments,
                                                "Draw each geom in one colour (quality native)");
  CLI::Option* depth =
      command
          ->add_flag("--depth", *depths, "Draw depths in grey, the nearest white (quality native)")
          ->excludes(segmentation);
  CLI::Option* all = command
                         ->add_flag("--contact-sheet", *whole,
                                    "Draw all tasks, cameras and qualities in one picture")
                         ->excludes(task);
  for (const char* other :
       {"--goal", "--camera", "--steps", "--quality", "--width", "--height", "--model"}) {
    all->excludes(command->get_option(other));
  }
  all->excludes(segmentation)->excludes(depth);
  command->add_option("--tile", sheet->side, "Side of each picture of a contact sheet in pixels")
      ->needs(all)
      ->capture_default_str();
  command->callback([=] {
    if (!*whole && task->count() == 0) {
      throw UsageError("env render: expected a task or --contact-sheet");
    }
    sheet->seed = request->seed;
    if (*segments) request->output = worlds::PainterOutput::kSegments;
    if (*depths) request->output = worlds::PainterOutput::kDepths;
    *chosen = [=] { return *whole ? DrawSheet(*sheet, *png) : Render(*request, *png); };
  });
}

}  // namespace

void AddEnvCommand(CLI::App& app, Action* chosen) {
  CLI::App* env = app.add_subcommand("env", "Describe, check and draw environments.");
  env->require_subcommand(1);
  env->fallthrough();  // --task-library is also accepted after the sub-command's arguments
  env->add_option_function<std::string>(
         "--task-library", [](const std::string& path) { worlds::LoadTasks(path); },
         "Shared object that defines further tasks (docs/own_task.md)")
      ->trigger_on_parse();
  AddEnvTaskCommands(*env, chosen);
  AddEnvCheckCommand(*env, chosen);
  AddRender(*env, chosen);
}

}  // namespace shoal::launch
