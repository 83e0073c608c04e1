// SPDX-License-Identifier: Apache-2.0
// Sink of the training loop's messages to other processes.
#pragma once

#include "common/wire/messages.h"

namespace shoal::learner {

// One thread. Messages are copied before a call returns.
class LearnerSink {
 public:
  virtual ~LearnerSink() = default;

  // Weights for acting. False: not sent; send newer ones later.
  virtual bool Publish(const WeightsMessage& weights) = 0;
  // Whether every reader has the weights published last. A writer that does not wait for this
  // starves slow readers, which then get nothing but ever newer beginnings.
  virtual bool WeightsArrived() = 0;
  // Weights for an evaluation. False: not sent; send them again.
  virtual bool Publish(const EvalWeightsMessage& weights) = 0;
  virtual void Publish(const MetricsMessage& report) = 0;
  virtual void Publish(const LearnerProgress& progress) = 0;
};

}  // namespace shoal::learner
