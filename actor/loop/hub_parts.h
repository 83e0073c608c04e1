// SPDX-License-Identifier: Apache-2.0
// Implementations of the training actor's interfaces over the link and the process's signals. Each
// class consists of an inbox, the reader that fills the inbox, and a writer if the interface sends.
// Destruction ends the receive threads' callbacks before it destroys the inboxes.
#pragma once

#include <cstdint>
#include <memory>

#include "actor/acting/host_weights.h"
#include "actor/loop/run_control.h"
#include "actor/sending/chunk_link.h"
#include "actor/sending/credit_inbox.h"
#include "common/base/stop.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/wire/control_state.h"

namespace shoal::actor {

// Borrows the hub. One thread calls the methods.
class HubChunkLink final : public ChunkLink {
 public:
  HubChunkLink(link::Hub& hub, uint32_t actor, uint64_t session)
      : inbox_(actor, session),
        publisher_(hub),
        subscriber_(hub, [this](const CreditsMessage& m) { inbox_.OnMessage(m); }) {}

  std::optional<Credit> TakeCredit(SteadyTime deadline) override { return inbox_.Take(deadline); }
  // The writer is volatile: samples written without a matched reader are lost.
  bool Connected() override { return publisher_.Matched() > 0; }
  bool Send(const TransitionChunk& chunk) override { return publisher_.Write(chunk); }

 private:
  CreditInbox inbox_;
  link::Writer<TransitionChunk> publisher_;
  link::Reader<CreditsMessage> subscriber_;
};

inline HostWeights::Subscribe WeightsOver(link::Hub& hub) {
  return [&hub](WeightsInbox& inbox) {
    return std::make_shared<link::Reader<WeightsPart>>(
        hub, [&inbox](const WeightsPart& m) { inbox.OnMessage(m); });
  };
}

class HubRunControl final : public RunControl {
 public:
  explicit HubRunControl(link::Hub& hub)
      : state_(Now()),
        subscriber_(hub, [this](const ControlMessage& m) { state_.OnMessage(m, Now()); }) {}

  RunState state() override { return state_.state(); }
  bool CoordinatorLost(SteadyTime now) override { return state_.CoordinatorLost(now); }
  bool StopRequested() override { return shoal::StopRequested(); }
  int StopRequests() override { return shoal::StopRequests(); }

 private:
  ControlState state_;
  link::Reader<ControlMessage> subscriber_;
};

}  // namespace shoal::actor
