// SPDX-License-Identifier: Apache-2.0
#include "common/dds/endpoint_options.h"

#include <CLI/CLI.hpp>

namespace shoal::dds {

void AddEndpointOptions(CLI::App* app, EndpointOptions* options) {
  app->add_option("--peer", options->peer, "HOST[:PORT] of the servers instead of cluster.json's");
  app->add_option("--interface", options->interface,
                  "network interface of this host instead of transport.interface");
  app->add_option("--secure", options->secure,
                  "folder of credentials instead of cluster.json's (shoal secure init)");
}

}  // namespace shoal::dds
