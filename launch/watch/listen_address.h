// SPDX-License-Identifier: Apache-2.0
// An IPv4 address and a port of this host that a page is served at.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::launch {

struct ListenAddress {
  std::string address = "127.0.0.1";
  uint16_t port = 0;

  std::string Text() const;  // "127.0.0.1:9464"
  bool Loopback() const;     // only this host reaches it: 127.0.0.0/8
};

// Whether the text is an IPv4 address, of four numbers.
bool IsAddress(const std::string& text);

// Throws Error with the system's reason if the address cannot be listened on: the port is taken, or
// the address is none of this host. `who`: the option or program that needs it. Libraries of
// servers report that they failed, but no reason.
void CheckCanListen(const ListenAddress& listen, const std::string& who);

}  // namespace shoal::launch
