// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "launch/tools/commands/commands.h"
#include "launch/tools/project/new_project.h"

namespace shoal::launch {

void AddNewCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand("new",
                                         "Create a project as a starting point: a task, a preset "
                                         "and an experiment that build against this Shoal.");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "Folder to make; an existing one is refused")->required();
  command->callback([=] {
    *chosen = [=] {
      NewProject(*folder);
      std::cout << *folder << ": " << NextSteps(*folder) << "\n" << std::flush;
      return 0;
    };
  });
}

}  // namespace shoal::launch
