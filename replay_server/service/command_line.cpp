#include "replay_server/service/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/build_info.h"

namespace shoal::replay {

std::unique_ptr<CLI::App> MakeCommandLine(Options* options) {
  auto app = std::make_unique<CLI::App>("Stores transitions and hands out batches for one run.",
                                        "shoal-replay");
  app->set_version_flag("--version", BuildVersion());
  app->add_option("--run", options->run, "run folder (config.json, cluster.json)")->required();
  app->add_option("--peer", options->reach.peer,
                  "HOST[:PORT] of the servers instead of cluster.json's");
  app->add_option("--interface", options->reach.interface,
                  "network interface of this host instead of transport.interface");
  app->add_option("--secure", options->reach.secure,
                  "folder of credentials instead of cluster.json's (shoal secure init)");
  return app;
}

}  // namespace shoal::replay
