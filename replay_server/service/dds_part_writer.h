// SPDX-License-Identifier: Apache-2.0
// What a BatchSender writes to, on the network.
#pragma once

#include "common/dds/bus.h"
#include "common/dds/publisher.h"
#include "replay_server/service/batch_sender.h"

namespace shoal::replay {

class DdsPartWriter final : public PartWriter {
 public:
  // Borrows the bus.
  explicit DdsPartWriter(dds::Bus& bus) : parts_(bus), slots_(bus) {}
  bool Write(const BatchPart& part) override { return parts_.Write(part); }
  bool Write(const BatchSlot& slot) override { return slots_.Write(slot); }
  bool HasPartReader() override { return parts_.Matched() > 0; }
  bool HasSlotReader() override { return slots_.Matched() > 0; }

 private:
  dds::Publisher<BatchPart> parts_;
  dds::Publisher<BatchSlot> slots_;
};

}  // namespace shoal::replay
