// SPDX-License-Identifier: Apache-2.0
#include "learner/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/dds/endpoint_options.h"

namespace shoal::learner {

std::unique_ptr<CLI::App> MakeCommandLine(Options* options) {
  auto app = std::make_unique<CLI::App>("Trains the policy of a run on batches from its replay.",
                                        "shoal-learner");
  AddVersion(app.get());
  app->add_option("--run", options->run, "run folder (config.json, cluster.json)")->required();
  dds::AddEndpointOptions(app.get(), &options->endpoint);
  return app;
}

}  // namespace shoal::learner
