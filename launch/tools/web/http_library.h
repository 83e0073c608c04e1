// SPDX-License-Identifier: Apache-2.0
// Hides the differences between cpp-httplib 0.11 (Debian 12) and 0.18 (Debian 13).
#pragma once

#include <httplib.h>

#include <functional>
#include <utility>

namespace shoal::launch {

// Result of httplib::TaskQueue::enqueue: void in 0.11; in 0.18 whether the task was accepted.
using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue(nullptr));

// httplib::Server with the function AnswerRequest, which answers the only request of a connection.
// In version 0.18 process_request also has parameters for the addresses of both ends, for logging;
// Shoal does not use these addresses.
class HttpServer : public httplib::Server {
 protected:
  // Returns false if the connection had no request that could be answered.
  template <class Connection>
  bool AnswerRequest(Connection& connection,
                     const std::function<void(httplib::Request&)>& prepare) {
    constexpr bool kClose = true;
    bool closed = false;
    if constexpr (requires { process_request(connection, kClose, closed, prepare); }) {
      return process_request(connection, kClose, closed, prepare);
    } else {
      return process_request(connection, "", 0, "", 0, kClose, closed, prepare);
    }
  }
};

}  // namespace shoal::launch
