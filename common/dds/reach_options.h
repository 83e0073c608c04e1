// SPDX-License-Identifier: Apache-2.0
// The options that every program of a run takes for its Reach.
#pragma once

#include "common/dds/reach.h"

namespace CLI {
class App;
}

namespace shoal::dds {

// --peer, --interface and --secure; `reach` is filled when `app` parses and has to live until then.
void AddReachOptions(CLI::App* app, Reach* reach);

}  // namespace shoal::dds
