// SPDX-License-Identifier: Apache-2.0
// The training actor's seams over DDS and this process's signals: each is an inbox, the subscriber
// that fills it and what is written beside it. Destruction ends the receive threads' callbacks
// before the inboxes they write to.
#pragma once

#include <cstdint>
#include <memory>

#include "actor/acting/host_weights.h"
#include "actor/loop/run_control.h"
#include "actor/sending/chunk_link.h"
#include "actor/sending/credit_inbox.h"
#include "common/base/stop.h"
#include "common/dds/publisher.h"
#include "common/dds/subscriber.h"
#include "common/wire/control_state.h"

namespace shoal::actor {

// Borrow the bus. Their methods are one thread's.
class DdsChunkLink final : public ChunkLink {
 public:
  DdsChunkLink(dds::Bus& bus, uint32_t actor, uint64_t session)
      : inbox_(actor, session),
        publisher_(bus),
        subscriber_(bus, [this](const CreditsMessage& m) { inbox_.OnMessage(m); }) {}

  std::optional<Credit> TakeCredit(SteadyTime deadline) override { return inbox_.Take(deadline); }
  // Without a matched reader a volatile writer's samples vanish.
  bool Connected() override { return publisher_.Matched() > 0; }
  bool Send(const TransitionChunk& chunk) override { return publisher_.Write(chunk); }

 private:
  CreditInbox inbox_;
  dds::Publisher<TransitionChunk> publisher_;
  dds::Subscriber<CreditsMessage> subscriber_;
};

inline HostWeights::Subscribe WeightsOver(dds::Bus& bus) {
  return [&bus](WeightsInbox& inbox) {
    return std::make_shared<dds::Subscriber<WeightsPart>>(
        bus, [&inbox](const WeightsPart& m) { inbox.OnMessage(m); });
  };
}

class DdsRunControl final : public RunControl {
 public:
  explicit DdsRunControl(dds::Bus& bus)
      : state_(Now()),
        subscriber_(bus, [this](const ControlMessage& m) { state_.OnMessage(m, Now()); }) {}

  RunState state() override { return state_.state(); }
  bool CoordinatorLost(SteadyTime now) override { return state_.CoordinatorLost(now); }
  bool StopRequested() override { return shoal::StopRequested(); }
  int StopRequests() override { return shoal::StopRequests(); }

 private:
  ControlState state_;
  dds::Subscriber<ControlMessage> subscriber_;
};

}  // namespace shoal::actor
