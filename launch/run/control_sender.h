// SPDX-License-Identifier: Apache-2.0
// Sends the coordinator's orders to the processes of its run. The repetition of the newest order is
// the coordinator's heartbeat.
#pragma once

#include <chrono>
#include <optional>

#include "common/base/clock.h"
#include "common/link/writer.h"
#include "common/wire/messages.h"
#include "launch/run/live_settings.h"

namespace shoal::launch {

// One thread.
class ControlSender {
 public:
  // Begins with the state "running". Borrows the hub. Throws Error.
  ControlSender(link::Hub& hub, const LiveSettings& settings);

  RunState state() const { return order_.state; }

  // Sets a new order, which the next Beat sends.
  void Order(RunState state);
  void Order(const LiveSettings& settings);

  // Sends the order if it is new or kPeriod old. An order that could not be sent is sent by the
  // next call.
  void Beat(SteadyTime now);

  static constexpr std::chrono::milliseconds kPeriod{300};

 private:
  void Renew();

  link::Writer<ControlMessage> writer_;
  ControlMessage order_{.epoch = 1};
  std::optional<SteadyTime> sent_;  // empty: `order_` is new
};

}  // namespace shoal::launch
