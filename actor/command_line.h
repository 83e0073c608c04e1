// SPDX-License-Identifier: Apache-2.0
// The command line of `shoal-actor`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "actor/evaluation/evaluation.h"
#include "common/dds/run_endpoint.h"

namespace CLI {
class App;
}

namespace shoal::actor {

struct Options {
  std::string run, role = "train", config_json, checkpoint, json, progress;
  uint32_t id = 0;
  CheckpointEvaluation evaluation;
  FrameRecorder::Options frames;
  bool describe = false, stop_with_input = false;
  dds::EndpointOptions endpoint;
};

// Makes the parser, which writes to `options`. `options` must outlive the parser.
std::unique_ptr<CLI::App> MakeCommandLine(Options* options);

}  // namespace shoal::actor
