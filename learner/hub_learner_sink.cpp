// SPDX-License-Identifier: Apache-2.0
#include "learner/hub_learner_sink.h"

#include <chrono>

#include "common/wire/weights_parts.h"

namespace shoal::learner {
namespace {

// Each part has its own place in the history that the transport keeps for late joiners, so the
// newest version replaces the preceding one. False: a part was not accepted. A reader that lacks a
// part waits for the next version.
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

// A report that cannot be sent is not lost: the next one contains the same totals.
void HubLearnerSink::Publish(const MetricsMessage& report) { metrics_.Write(report); }

// The link keeps the latest progress for late joiners.
void HubLearnerSink::Publish(const LearnerProgress& progress) { progress_.Write(progress); }

}  // namespace shoal::learner
