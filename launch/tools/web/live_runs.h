// SPDX-License-Identifier: Apache-2.0
// Connections to the running runs that a page shows. LiveRuns joins the network of a run at the
// first request for the run, and leaves the network some time after the last request. Runs that no
// page shows are not joined.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/mutex.h"
#include "launch/client/run_connection.h"

namespace shoal::launch {

// Any thread. Requests about one run are answered one after the other.
class LiveRuns {
 public:
  static constexpr std::chrono::seconds kUnwatched{15};  // time without requests before leaving
  static constexpr size_t kMost = 4;  // connections; the least recently used is closed

  // `secure`: folder of credentials; empty = as each run's cluster.json says.
  explicit LiveRuns(const std::string& secure) : secure_(secure) {}

  // The run's newest view. The first call for a run waits up to 5 s for the view. Throws Error if
  // the run is not running, or if its coordinator does not answer or is silent.
  RunViewMessage View(const std::filesystem::path& run);
  // Sends an order: see RunClient::Order.
  ReplyMessage Order(const std::filesystem::path& run, const std::string& verb,
                     const std::vector<std::string>& arguments);
  // Leaves runs that no page shows any more. Call every few seconds.
  void LeaveUnwatched(SteadyTime now);
  // Number of joined runs.
  size_t size() const;

 private:
  struct Line {
    Mutex mutex;
    std::unique_ptr<RunConnection> connection SHOAL_GUARDED_BY(mutex);
    std::optional<RunViewMessage> view SHOAL_GUARDED_BY(mutex);
    SteadyTime heard SHOAL_GUARDED_BY(mutex){};
    SteadyTime asked{};  // guarded by LiveRuns::mutex_
  };

  std::shared_ptr<Line> LineTo(const std::filesystem::path& run);
  // The client of a line; joins the run's network if there is no client yet.
  RunClient& Client(const std::filesystem::path& run, Line& line) SHOAL_REQUIRES(line.mutex);

  const std::string secure_;
  mutable Mutex mutex_;
  std::map<std::filesystem::path, std::shared_ptr<Line>> lines_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace shoal::launch
