// SPDX-License-Identifier: Apache-2.0
// Command-line options with which a program of a run finds its endpoint.
#pragma once

#include "common/dds/run_endpoint.h"

namespace CLI {
class App;
}

namespace shoal::dds {

// Adds --peer, --interface and --secure. `app` fills `options` when it parses, so `options` must
// live until then.
void AddEndpointOptions(CLI::App* app, EndpointOptions* options);

}  // namespace shoal::dds
