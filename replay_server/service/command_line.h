// SPDX-License-Identifier: Apache-2.0
// The command line of `shoal-replay`.
#pragma once

#include <memory>
#include <string>

#include "common/dds/run_endpoint.h"

namespace CLI {
class App;
}

namespace shoal::replay {

struct Options {
  std::string run;  // folder
  dds::EndpointOptions endpoint;
};

// `options` must outlive the command line.
std::unique_ptr<CLI::App> MakeCommandLine(Options* options);

}  // namespace shoal::replay
