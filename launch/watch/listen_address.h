// SPDX-License-Identifier: Apache-2.0
// An IPv4 address and a port of this host, on which a page is served.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::launch {

struct ListenAddress {
  std::string address = "127.0.0.1";
  uint16_t port = 0;

  std::string Text() const;  // "127.0.0.1:9464"
  bool Loopback() const;     // 127.0.0.0/8: only this host reaches the address
};

// Whether the text is an IPv4 address of four numbers.
bool IsAddress(const std::string& text);

// Throws Error with the system's reason if this process cannot listen on the address: the port is
// taken, or the address does not belong to this host. `who`: the option or program that needs the
// address. This check is needed because server libraries report a failure without its reason.
void CheckCanListen(const ListenAddress& listen, const std::string& who);

}  // namespace shoal::launch
