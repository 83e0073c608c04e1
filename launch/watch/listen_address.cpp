// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "common/base/descriptor.h"
#include "common/base/error.h"

namespace shoal::launch {
namespace {

const char* Advice(int reason) {
  switch (reason) {
    case EADDRINUSE:
      return "; choose another port";
    case EADDRNOTAVAIL:
      return "; expected an address of this host";
    default:
      return "";
  }
}

}  // namespace

std::string ListenAddress::Text() const { return fmt::format("{}:{}", address, port); }

bool ListenAddress::Loopback() const { return address.starts_with("127."); }

bool IsAddress(const std::string& text) {
  in_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

void CheckCanListen(const ListenAddress& listen, const std::string& who) {
  const Descriptor trial(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(listen.port);
  inet_pton(AF_INET, listen.address.c_str(), &address.sin_addr);
  const int reuse = 1;
  setsockopt(trial.get(), SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof(reuse));
  if (trial.get() >= 0 &&
      bind(trial.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
      ::listen(trial.get(), 1) == 0) {
    return;
  }
  const int reason = errno;
  throw RuntimeError("{}: cannot listen on {}: {}{}", who, listen.Text(), std::strerror(reason),
                     Advice(reason));
}

}  // namespace shoal::launch
