// SPDX-License-Identifier: Apache-2.0
// cpp-httplib's server with limits on everything that a client controls: the time to receive a
// request and to send an answer, the length of a request, the number of connections. One request
// per connection.
//
// Encoded bodies are not decoded, and answers are not compressed, because the client would control
// the cost of decoding and compression. Handlers answer ranges themselves.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "launch/tools/web/http_library.h"

namespace shoal::launch {

struct ServerLimits {
  std::chrono::milliseconds request{3000};  // to receive a whole request
  std::chrono::milliseconds answer{15000};  // to send an answer
  std::chrono::milliseconds file{300000};   // to send a file, for slow connections
  size_t request_bytes = 24000;             // headers and body
  size_t threads = 16;
  size_t waiting = 16;  // waiting connections; further connections are closed at once
};

class BoundedServer final : public HttpServer {
 public:
  // `is_file`: whether the answer to this path is a file. The time limit of such answers is
  // limits.file.
  BoundedServer(const ServerLimits& limits, std::function<bool(const std::string&)> is_file);

  // Ends the waiting of all connections, so that Server::stop returns soon.
  void EndConnections() { ending_ = true; }

 private:
  bool process_and_close_socket(socket_t socket) override;

  const ServerLimits limits_;
  const std::function<bool(const std::string&)> is_file_;
  std::atomic<bool> ending_ = false;
};

}  // namespace shoal::launch
