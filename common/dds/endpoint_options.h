// SPDX-License-Identifier: Apache-2.0
// The options that every program of a run takes to find its endpoint.
#pragma once

#include "common/dds/run_endpoint.h"

namespace CLI {
class App;
}

namespace shoal::dds {

// --peer, --interface and --secure; `options` is filled when `app` parses and has to live until
// then.
void AddEndpointOptions(CLI::App* app, EndpointOptions* options);

}  // namespace shoal::dds
