// SPDX-License-Identifier: Apache-2.0
#include "launch/run/control_sender.h"

namespace shoal::launch {

ControlSender::ControlSender(link::Hub& hub, const LiveSettings& settings) : writer_(hub) {
  settings.AddTo(&order_);
}

void ControlSender::Order(RunState state) {
  order_.state = state;
  Renew();
}

void ControlSender::Order(const LiveSettings& settings) {
  settings.AddTo(&order_);
  Renew();
}

void ControlSender::Renew() {
  ++order_.epoch;
  sent_.reset();
}

void ControlSender::Beat(SteadyTime now) {
  if (sent_ && now - *sent_ < kPeriod) return;
  order_.time = WallTimeSeconds();
  if (writer_.Write(order_)) sent_ = now;
}

}  // namespace shoal::launch
