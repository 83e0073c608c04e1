#include "learner/dds_outlet.h"

#include <chrono>

namespace shoal::learner {

DdsOutlet::DdsOutlet(dds::Bus& bus) : weights_(bus), evaluation_weights_(bus), metrics_(bus) {}

bool DdsOutlet::Publish(const WeightsMessage& weights) { return weights_.Write(weights); }

bool DdsOutlet::WeightsArrived() { return weights_.WaitForAcks(std::chrono::milliseconds(0)); }

bool DdsOutlet::Publish(const EvalWeightsMessage& weights) {
  return evaluation_weights_.Write(weights);
}

// A report that cannot be sent is no loss: the next one holds the same totals.
void DdsOutlet::Publish(const MetricsMessage& report) { metrics_.Write(report); }

}  // namespace shoal::learner
