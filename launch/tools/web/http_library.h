// SPDX-License-Identifier: Apache-2.0
// What cpp-httplib 0.11 and 0.18 declare differently, in one way for both: Debian 12 has the one,
// Debian 13 the other.
#pragma once

#include <httplib.h>

#include <functional>
#include <utility>

namespace shoal::launch {

// What httplib::TaskQueue::enqueue gives: nothing, later whether the task is taken.
using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue(nullptr));

// httplib::Server whose one request of a connection is answered by AnswerRequest. The later version
// also asks for both ends' addresses, to log them; here nobody is judged by them.
class HttpServer : public httplib::Server {
 protected:
  // False when there was nothing that could be answered.
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
