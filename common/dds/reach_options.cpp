// SPDX-License-Identifier: Apache-2.0
#include "common/dds/reach_options.h"

#include <CLI/CLI.hpp>

namespace shoal::dds {

void AddReachOptions(CLI::App* app, Reach* reach) {
  app->add_option("--peer", reach->peer, "HOST[:PORT] of the servers instead of cluster.json's");
  app->add_option("--interface", reach->interface,
                  "network interface of this host instead of transport.interface");
  app->add_option("--secure", reach->secure,
                  "folder of credentials instead of cluster.json's (shoal secure init)");
}

}  // namespace shoal::dds
