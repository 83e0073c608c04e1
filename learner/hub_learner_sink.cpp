// SPDX-License-Identifier: Apache-2.0
#include "learner/hub_learner_sink.h"

#include <chrono>

#include "common/wire/weights_parts.h"

namespace shoal::learner {
namespace {

// Each part has a place of its own in what the transport keeps for late joiners: the newest version
// takes the places of the one before. False: some part was not taken; a reader then lacks it and
// waits for the next version.
template <class Part>
bool SendParts(const WeightsMessage& weights, link::Writer<Part>& publisher) {
  bool sent = true;
  const auto parts = static_cast<uint32_t>(WeightsParts(weights.payload.size()));
  for (uint32_t part = 0; part < parts && sent; ++part) {
    sent = publisher.Write(PartOf<Part>(weights, part));
  }
  return sent;
}

}  // namespace

HubLearnerSink::HubLearnerSink(link::Hub& hub)
    : weights_(hub), evaluation_weights_(hub), metrics_(hub), progress_(hub) {}

bool HubLearnerSink::Publish(const WeightsMessage& weights) { return SendParts(weights, weights_); }

bool HubLearnerSink::WeightsArrived() { return weights_.WaitForAcks(std::chrono::milliseconds(0)); }

bool HubLearnerSink::Publish(const EvalWeightsMessage& weights) {
  return SendParts(weights, evaluation_weights_);
}

// A report that cannot be sent is no loss: the next one holds the same totals.
void HubLearnerSink::Publish(const MetricsMessage& report) { metrics_.Write(report); }

// The link keeps the last one for late joiners.
void HubLearnerSink::Publish(const LearnerProgress& progress) { progress_.Write(progress); }

}  // namespace shoal::learner
