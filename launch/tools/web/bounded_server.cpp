// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/bounded_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/base/descriptor.h"
#include "common/base/mutex.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{200};  // interval between checks whether the server ends

// True while this thread must close a connection without an answer.
thread_local bool closing_only = false;

// Threads that serve connections. If all threads are busy and the queue is full, the accepting
// thread closes the connection.
class ConnectionQueue final : public httplib::TaskQueue {
 public:
  ConnectionQueue(size_t threads, size_t most_waiting) : most_waiting_(most_waiting) {
    for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { Work(); });
  }

  Enqueued enqueue(std::function<void()> connection) override {
    {
      const MutexLock lock(mutex_);
      if (waiting_.size() < most_waiting_) {
        waiting_.push_back(std::move(connection));
        come_.NotifyOne();
        return Enqueued(true);
      }
    }
    closing_only = true;
    connection();
    closing_only = false;
    return Enqueued(true);
  }

  void shutdown() override {
    {
      const MutexLock lock(mutex_);
      ending_ = true;
    }
    come_.NotifyAll();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void Work() {
    while (true) {
      std::function<void()> connection;
      {
        const MutexLock lock(mutex_);
        while (waiting_.empty() && !ending_) {
          come_.WaitUntil(mutex_, Now() + std::chrono::minutes(1));
        }
        if (waiting_.empty()) return;
        connection = std::move(waiting_.front());
        waiting_.pop_front();
      }
      connection();
    }
  }

  const size_t most_waiting_;
  Mutex mutex_;
  ConditionVariable come_;
  std::deque<std::function<void()>> waiting_ SHOAL_GUARDED_BY(mutex_);
  bool ending_ SHOAL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

// A connection with one deadline for the whole request and one for the whole answer. Occasional
// bytes do not extend a deadline.
class BoundedStream final : public httplib::Stream {
 public:
  BoundedStream(int socket, const ServerLimits& limits, const std::atomic<bool>& ending)
      : socket_(socket),
        ending_(ending),
        request_end_(Now() + limits.request),
        answer_end_(Now() + limits.request + limits.answer),
        left_(limits.request_bytes) {}

  void SetAnswerEnd(SteadyTime end) { answer_end_ = end; }

  bool is_readable() const override { return true; }
  bool is_writable() const override { return Wait(POLLOUT, answer_end_); }

  ssize_t read(char* to, size_t size) override {
    if (next_ == filled_ && !Fill()) return -1;
    const size_t n = std::min(size, filled_ - next_);
    std::copy_n(buffer_.data() + next_, n, to);
    next_ += n;
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, size_t size) override {
    if (!Wait(POLLOUT, answer_end_)) return -1;
    return send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();  // required by the interface, not used
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  socket_t socket() const override { return socket_; }

 private:
  bool Wait(short event, SteadyTime end) const {
    while (!ending_) {
      const auto left = std::chrono::ceil<milliseconds>(end - Now());
      if (left.count() <= 0) return false;
      pollfd waited{.fd = socket_, .events = event, .revents = 0};
      const int n = poll(&waited, 1, static_cast<int>(std::min(left, kLook).count()));
      if (n > 0) return true;
      if (n < 0 && errno != EINTR) return false;
    }
    return false;
  }
  bool Fill() {
    const size_t most = std::min(buffer_.size(), left_);
    if (most == 0 || !Wait(POLLIN, request_end_)) return false;
    const ssize_t n = recv(socket_, buffer_.data(), most, MSG_DONTWAIT);
    if (n <= 0) return false;
    next_ = 0;
    filled_ = static_cast<size_t>(n);
    left_ -= filled_;
    return true;
  }

  const int socket_;
  const std::atomic<bool>& ending_;
  const SteadyTime request_end_;
  SteadyTime answer_end_;
  size_t left_;  // bytes that may still be read
  std::array<char, 4096> buffer_{};
  size_t next_ = 0, filled_ = 0;
};

// Reads the remaining bytes, because closing the socket with unread bytes would discard the answer.
void Drain(int socket) {
  std::array<char, 4096> rest{};
  for (int i = 0; i < 64; ++i) {
    if (recv(socket, rest.data(), rest.size(), MSG_DONTWAIT) <= 0) return;
  }
}

// Replaces the library's default options, which would let a second server listen on the same port.
void OwnSocketOptions(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  fcntl(socket, F_SETFD, FD_CLOEXEC);
}

}  // namespace

BoundedServer::BoundedServer(const ServerLimits& limits,
                             std::function<bool(const std::string&)> is_file)
    : limits_(limits), is_file_(std::move(is_file)) {
  new_task_queue = [limits] { return new ConnectionQueue(limits.threads, limits.waiting); };
  set_socket_options(OwnSocketOptions);
  set_payload_max_length(limits.request_bytes);
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  const Descriptor closing(socket);
  fcntl(socket, F_SETFD, FD_CLOEXEC);  // child processes must not inherit it
  if (closing_only || ending_) return false;
  BoundedStream stream(socket, limits_, ending_);
  const bool answered = AnswerRequest(stream, [&](httplib::Request& request) {
    request.headers.erase("Accept-Encoding");
    request.ranges.clear();
    stream.SetAnswerEnd(Now() + (is_file_(request.path) ? limits_.file : limits_.answer));
  });
  shutdown(socket, SHUT_WR);
  Drain(socket);
  return answered;
}

}  // namespace shoal::launch
