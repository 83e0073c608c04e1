#include "replay_server/service/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/build_info.h"
#include "common/dds/reach_options.h"

namespace shoal::replay {

std::unique_ptr<CLI::App> MakeCommandLine(Options* options) {
  auto app = std::make_unique<CLI::App>("Stores transitions and hands out batches for one run.",
                                        "shoal-replay");
  app->set_version_flag("--version", BuildVersion());
  app->add_option("--run", options->run, "run folder (config.json, cluster.json)")->required();
  dds::AddReachOptions(app.get(), &options->reach);
  return app;
}

}  // namespace shoal::replay
