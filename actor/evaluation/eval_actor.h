// SPDX-License-Identifier: Apache-2.0
// The evaluation actor: plays the parameters that the learner hands out for evaluation.
#pragma once

#include <cstdint>
#include <filesystem>

#include "actor/acting/weights_inbox.h"
#include "actor/evaluation/evaluation.h"
#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "common/link/metrics_writer.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/wire/control_state.h"
#include "common/wire/metrics_report.h"

namespace shoal::actor {

// Members are in construction order: readers end before what they write to.
class EvalActor {
 public:
  // For the run in `folder`; `make`: as the Evaluator's. One thread constructs and runs it. Borrows
  // the hub. Throws Error.
  EvalActor(const std::filesystem::path& folder, link::Hub& hub,
            const EnvironmentFactory& make = MakeEnvironments);

  // Evaluates until told to stop (0) or the coordinator is gone (1). Throws Error.
  int Run();

 private:
  // One weights version for the whole evaluation; newer ones wait in the inbox.
  void Evaluate(const ReceivedWeights& weights);

  // Throws Error at the deadline. The learner's parameters stay on offer: the next process of this
  // role plays the evaluation again.
  void Send(const EvalMessage& message);

  void WarnOfOvertaken();

  void Report(const char* state);

  const RunConfig run_;
  Evaluator evaluator_;
  MetricsReport report_;
  WeightsInbox weights_;
  ControlState control_;
  link::Writer<EvalMessage> eval_publisher_;
  link::MetricsWriter<EvalMetrics> metrics_publisher_;
  link::Reader<EvalWeightsPart> weights_subscriber_;
  link::Reader<ControlMessage> control_subscriber_;
  uint64_t evaluations_ = 0, env_steps_ = 0, overtaken_said_ = 0;
  double evaluating_seconds_ = 0;
};

}  // namespace shoal::actor
