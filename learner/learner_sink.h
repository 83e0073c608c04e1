// SPDX-License-Identifier: Apache-2.0
// Sink of the training loop's messages to other processes.
#pragma once

#include "common/wire/messages.h"

namespace shoal::learner {

// One thread. Messages are copied before a call returns.
class LearnerSink {
 public:
  virtual ~LearnerSink() = default;

  // Weights for acting. Returns false if they were not sent; send newer weights later.
  virtual bool Publish(const WeightsMessage& weights) = 0;
  // Whether every reader has received the weights published last. A writer that does not wait for
  // this starves slow readers, which then receive only the beginnings of ever newer weights.
  virtual bool WeightsArrived() = 0;
  // Weights for an evaluation. Returns false if they were not sent; send the same weights again.
  virtual bool Publish(const EvalWeightsMessage& weights) = 0;
  virtual void Publish(const MetricsMessage& report) = 0;
  virtual void Publish(const LearnerProgress& progress) = 0;
};

}  // namespace shoal::learner
