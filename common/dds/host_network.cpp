// SPDX-License-Identifier: Apache-2.0
#include "common/dds/host_network.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <set>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/dds/bus.h"

namespace shoal::dds {
namespace {

using InterfaceList = std::unique_ptr<ifaddrs, decltype(&freeifaddrs)>;

InterfaceList ListInterfaces() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) list = nullptr;
  return {list, &freeifaddrs};
}

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

// The host's IPv4 addresses with the port ("" = none), or null if there are none.
AddressList Resolve(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const char* service = port.empty() ? nullptr : port.c_str();
  if (getaddrinfo(host.c_str(), service, &hints, &found) != 0) found = nullptr;
  return {found, &freeaddrinfo};
}

}  // namespace

bool UdpPortFree(int port) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) throw RuntimeError("cannot open a socket: {}", std::strerror(errno));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(static_cast<uint16_t>(port));
  return bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

bool InterfaceExists(const std::string& name) {
  const InterfaceList list = ListInterfaces();
  for (const ifaddrs* item = list.get(); item != nullptr; item = item->ifa_next) {
    if (name == item->ifa_name) return true;
  }
  return false;
}

bool IsAddress(const std::string& text) {
  in_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

bool HostHasAddress(const std::string& address) {
  in_addr wanted{};
  if (inet_pton(AF_INET, address.c_str(), &wanted) != 1) return false;
  const InterfaceList list = ListInterfaces();
  for (const ifaddrs* item = list.get(); item != nullptr; item = item->ifa_next) {
    if (item->ifa_addr == nullptr || item->ifa_addr->sa_family != AF_INET) continue;
    const auto* own = reinterpret_cast<const sockaddr_in*>(item->ifa_addr);
    if (own->sin_addr.s_addr == wanted.s_addr) return true;
  }
  return false;
}

std::string InterfaceNames() {
  std::set<std::string> names;
  const InterfaceList list = ListInterfaces();
  for (const ifaddrs* item = list.get(); item != nullptr; item = item->ifa_next) {
    names.insert(item->ifa_name);
  }
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : ", ") + name;
  return joined;
}

bool HostResolves(const std::string& host) { return Resolve(host, "") != nullptr; }

std::string InterfaceTowards(const std::string& host) {
  const AddressList found = Resolve(host, "9");
  if (found == nullptr) throw RuntimeError("host \"{}\" does not resolve to an IPv4 address", host);
  // Connecting a datagram socket sends nothing and only queries the routing table.
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  const bool routed = socket.get() >= 0 &&
                      connect(socket.get(), found->ai_addr, found->ai_addrlen) == 0 &&
                      getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &size) == 0;
  if (!routed) throw RuntimeError("no way to host \"{}\": {}", host, std::strerror(errno));
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &own.sin_addr, text, sizeof(text));
  return text;
}

}  // namespace shoal::dds
