// SPDX-License-Identifier: Apache-2.0
// Sink of the training loop's messages to other processes.
#pragma once

#include "common/wire/messages.h"

namespace shoal::learner {

// Only one thread may use a sink. Messages are copied before a call returns.
class LearnerSink {
 public:
  virtual ~LearnerSink() = default;

  // Sends weights for acting. Returns false if the weights were not sent; the caller then sends
  // newer weights later.
  virtual bool Publish(const WeightsMessage& weights) = 0;
  // Whether every reader has received all parts of the weights that were sent last. If the learner
  // always sends new weights before this is true, slow readers never receive complete weights.
  virtual bool WeightsArrived() = 0;
  // Sends weights for an evaluation. Returns false if the weights were not sent; the caller then
  // sends the same weights again.
  virtual bool Publish(const EvalWeightsMessage& weights) = 0;
  virtual void Publish(const MetricsMessage& report) = 0;
  virtual void Publish(const LearnerProgress& progress) = 0;
};

}  // namespace shoal::learner
