// SPDX-License-Identifier: Apache-2.0
// The outlet over DDS.
#pragma once

#include "common/dds/bus.h"
#include "common/dds/metrics_publisher.h"
#include "common/dds/publisher.h"
#include "learner/outlet.h"

namespace shoal::learner {

class DdsOutlet final : public Outlet {
 public:
  explicit DdsOutlet(dds::Bus& bus);  // borrows the bus

  bool Publish(const WeightsMessage& weights) override;
  bool WeightsArrived() override;
  bool Publish(const EvalWeightsMessage& weights) override;
  void Publish(const MetricsMessage& report) override;
  void Publish(const LearnerProgress& progress) override;

 private:
  dds::Publisher<WeightsPart> weights_;
  dds::Publisher<EvalWeightsPart> evaluation_weights_;
  dds::MetricsPublisher<LearnerMetrics> metrics_;
  dds::Publisher<LearnerProgress> progress_;
};

}  // namespace shoal::learner
