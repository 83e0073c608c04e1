// SPDX-License-Identifier: Apache-2.0
// Learner sink that sends over the link.
#pragma once

#include "common/link/hub.h"
#include "common/link/metrics_writer.h"
#include "common/link/writer.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

class HubLearnerSink final : public LearnerSink {
 public:
  explicit HubLearnerSink(link::Hub& hub);  // borrows the hub

  bool Publish(const WeightsMessage& weights) override;
  bool WeightsArrived() override;
  bool Publish(const EvalWeightsMessage& weights) override;
  void Publish(const MetricsMessage& report) override;
  void Publish(const LearnerProgress& progress) override;

 private:
  link::Writer<WeightsPart> weights_;
  link::Writer<EvalWeightsPart> evaluation_weights_;
  link::MetricsWriter<LearnerMetrics> metrics_;
  link::Writer<LearnerProgress> progress_;
};

}  // namespace shoal::learner
