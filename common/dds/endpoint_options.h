// SPDX-License-Identifier: Apache-2.0
// Command-line options for the endpoint of a program in a run.
#pragma once

#include "common/dds/run_endpoint.h"

namespace CLI {
class App;
}

namespace shoal::dds {

// Adds --peer, --interface and --secure. `app` writes `options` when it parses the command line, so
// `options` must live until then.
void AddEndpointOptions(CLI::App* app, EndpointOptions* options);

}  // namespace shoal::dds
