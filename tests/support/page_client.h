// SPDX-License-Identifier: Apache-2.0
// Sends requests to the server of `shoal web` on loopback, like a browser.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <string>

#include "common/base/clock.h"
#include "common/base/descriptor.h"

namespace shoal {

// A connection to 127.0.0.1.
class PageConnection {
 public:
  explicit PageConnection(uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
              0);
  }

  // Returns false if the server has closed the connection.
  bool Send(const std::string& bytes) const {
    size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = send(socket_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<size_t>(n);
    }
    return true;
  }
  void EndSending() const { shutdown(socket_.get(), SHUT_WR); }

  // Reads until the server closes the connection. Fails the test if the server keeps it open.
  std::string Answer() const {
    std::string answer;
    const SteadyTime end = Now() + std::chrono::seconds(60);
    while (Now() < end) {
      pollfd waited{.fd = socket_.get(), .events = POLLIN, .revents = 0};
      if (poll(&waited, 1, 100) <= 0) continue;
      char buffer[65536];
      const ssize_t n = recv(socket_.get(), buffer, sizeof(buffer), 0);
      if (n <= 0) return answer;
      answer.append(buffer, static_cast<size_t>(n));
    }
    ADD_FAILURE() << "the server neither closed nor answered to the end: " << answer;
    return answer;
  }

 private:
  const Descriptor socket_;
};

// The complete answer to `request`, including headers.
inline std::string AskPage(uint16_t port, const std::string& request) {
  const PageConnection connection(port);
  connection.Send(request);
  return connection.Answer();
}

struct PageAnswer {
  int status = 0;  // 0: no answer
  std::string content;
};

class PageClient {
 public:
  // `token` may be empty.
  PageClient(uint16_t port, const std::string& token) : port_(port), token_(token) {}

  PageAnswer Get(const std::string& path) const { return Ask("GET " + path, ""); }
  PageAnswer Post(const std::string& path, const std::string& body) const {
    return Ask("POST " + path, body);
  }

 private:
  PageAnswer Ask(const std::string& line, const std::string& body) const {
    std::string request = line + " HTTP/1.1\r\nHost: 127.0.0.1\r\n";
    if (!token_.empty()) request += "X-Shoal-Token: " + token_ + "\r\n";
    if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    const std::string answer = AskPage(port_, request + "\r\n" + body);
    const size_t end = answer.find("\r\n\r\n");
    if (!answer.starts_with("HTTP/1.1 ") || end == std::string::npos) return {0, answer};
    return {std::stoi(answer.substr(9, 3)), answer.substr(end + 4)};
  }

  const uint16_t port_;
  const std::string token_;
};

}  // namespace shoal
