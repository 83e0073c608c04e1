// SPDX-License-Identifier: Apache-2.0
// `shoal web`: serves the page.
#pragma once

#include <memory>
#include <string>

#include "launch/watch/listen_address.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {

struct WebOptions {
  std::string run{};  // name within run_dir, or folder: the page shows this one only; empty = all
  std::string run_dir = "runs";
  std::string secure{};    // folder of credentials; empty = as each run's cluster.json says
  ListenAddress listen{};  // port 0: one of the system's choice
};

class WebServer {
 public:
  // Listens, and answers on threads of its own until destruction, which waits for none of them
  // longer than a moment. Throws Error: no such run, address or port that cannot be listened on, a
  // part of the page that is not installed.
  explicit WebServer(const WebOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  uint16_t port() const;
  const std::string& token() const;  // for who may see and steer (access.h)
  // "http://127.0.0.1:8470/?token=..."
  std::string Url() const;
  // Leaves runs that no page shows any more. Call it every few seconds.
  void Tend();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::launch
