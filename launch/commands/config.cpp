// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/config/config_io.h"
#include "common/config/config_schema.h"
#include "launch/commands/commands.h"

namespace shoal::launch {

void AddConfigCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "config", "Print a table of every configuration key: default, range, meaning.");
  const auto schema = std::make_shared<bool>(false);
  command->add_flag("--schema", *schema,
                    "Print a JSON Schema (2020-12) of presets and configuration files instead");
  command->callback([=] {
    *chosen = [=] {
      std::cout << (*schema ? ConfigSchema().dump(2) + "\n" : DescribeKeys()) << std::flush;
      return 0;
    };
  });
}

}  // namespace shoal::launch
