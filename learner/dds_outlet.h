// The outlet over DDS.
#pragma once

#include "common/dds/bus.h"
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

 private:
  dds::Publisher<WeightsMessage> weights_;
  dds::Publisher<EvalWeightsMessage> evaluation_weights_;
  dds::Publisher<MetricsMessage> metrics_;
};

}  // namespace shoal::learner
