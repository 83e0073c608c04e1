// SPDX-License-Identifier: Apache-2.0
// The run's view as a page that Prometheus scrapes: http://ADDRESS:PORT/metrics.
//
//   shoal_NAME{run, role, id, host}    every metric of docs/monitoring.md
//   shoal_process_up{...}              1; 0 if the process has not reported for a while
//   shoal_run_env_steps{run}, shoal_run_updates{run}
#pragma once

#include <memory>
#include <string>

#include "common/wire/messages.h"

namespace shoal::launch {

// Serves on its own threads until destruction.
class PrometheusEndpoint {
 public:
  // `where`: "ADDRESS:PORT", or "PORT" for 127.0.0.1. Throws Error if the text has another form, or
  // if the program cannot listen at the address (the port is taken, or the address does not belong
  // to this host).
  explicit PrometheusEndpoint(const std::string& where);
  ~PrometheusEndpoint();
  PrometheusEndpoint(const PrometheusEndpoint&) = delete;
  PrometheusEndpoint& operator=(const PrometheusEndpoint&) = delete;

  // Throws the errors of the constructor, without listening.
  static void Check(const std::string& where);
  // "http://127.0.0.1:9464/metrics"
  std::string Url() const;
  // Replaces the view that is served. Any thread.
  void Update(const RunViewMessage& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::launch
