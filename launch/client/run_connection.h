// SPDX-License-Identifier: Apache-2.0
// A client of a run in another process: a participant of the run's network and a RunClient on it.
#pragma once

#include "common/dds/bus.h"
#include "launch/client/run_client.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {

// One thread.
class RunConnection {
 public:
  // Joins the run's network. Throws Error.
  explicit RunConnection(const RunTarget& target);

  RunClient& client() { return client_; }

 private:
  dds::Bus bus_;
  RunClient client_;
};

}  // namespace shoal::launch
