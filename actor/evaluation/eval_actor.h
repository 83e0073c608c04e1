// SPDX-License-Identifier: Apache-2.0
// The evaluation actor: plays episodes with the parameters that the learner sends for evaluation.
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

// Members are in construction order, so readers are destroyed before the inboxes they write to.
class EvalActor {
 public:
  // Plays the evaluations of the run in `folder`. `make`: see Evaluator. The same thread constructs
  // the actor and calls Run. Borrows the hub. Throws Error.
  EvalActor(const std::filesystem::path& folder, link::Hub& hub,
            const EnvironmentFactory& make = MakeEnvironments);

  // Evaluates until a stop is requested (returns 0) or the coordinator is lost (returns 1). Throws
  // Error.
  int Run();

 private:
  // Plays a whole evaluation with one weights version; newer versions wait in the inbox.
  void Evaluate(const ReceivedWeights& weights);

  // Sends a message. Throws Error if the message is not sent before the deadline. The learner keeps
  // sending the parameters, so the next process of this role plays the evaluation again.
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
