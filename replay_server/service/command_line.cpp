// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/dds/endpoint_options.h"

namespace shoal::replay {

std::unique_ptr<CLI::App> MakeCommandLine(Options* options) {
  auto app = std::make_unique<CLI::App>("Stores transitions and hands out batches for one run.",
                                        "shoal-replay");
  AddVersion(app.get());
  app->add_option("--run", options->run, "run folder (config.json, cluster.json)")->required();
  dds::AddEndpointOptions(app.get(), &options->endpoint);
  return app;
}

}  // namespace shoal::replay
