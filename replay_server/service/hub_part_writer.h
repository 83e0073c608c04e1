// SPDX-License-Identifier: Apache-2.0
// Writes the batches of a BatchSender to the link.
#pragma once

#include "common/link/hub.h"
#include "common/link/writer.h"
#include "replay_server/service/batch_sender.h"

namespace shoal::replay {

class HubPartWriter final : public PartWriter {
 public:
  // Borrows the hub.
  explicit HubPartWriter(link::Hub& hub) : parts_(hub), slots_(hub) {}
  bool Write(const BatchPart& part) override { return parts_.Write(part); }
  bool Write(const BatchSlot& slot) override { return slots_.Write(slot); }
  bool HasPartReader() override { return parts_.Matched() > 0; }
  bool HasSlotReader() override { return slots_.Matched() > 0; }

 private:
  link::Writer<BatchPart> parts_;
  link::Writer<BatchSlot> slots_;
};

}  // namespace shoal::replay
