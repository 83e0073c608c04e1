// SPDX-License-Identifier: Apache-2.0
// Checks of this host's network. They run before DDS starts, so that an error names the port,
// interface or host that is wrong.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::dds {

// UDP port of `index` in `domain`: 7400 + 250*domain + 10 + 2*index. Discovery uses this port, and
// data uses the odd port above.
constexpr int DiscoveryPort(int domain, int index) { return 7400 + 250 * domain + 10 + 2 * index; }

// Whether the UDP port is free on this host. The check binds the port for an instant. Throws Error
// if the system refuses to bind for another reason.
bool UdpPortFree(int port);
// Whether an interface has that name.
bool InterfaceExists(const std::string& name);
// Whether `text` is an IPv4 address in dots.
bool IsAddress(const std::string& text);
// Whether an interface of this host carries the IPv4 address.
bool HostHasAddress(const std::string& address);
// "lo, eth0" for messages.
std::string InterfaceNames();
// Whether the name resolves to an IPv4 address.
bool HostResolves(const std::string& host);

}  // namespace shoal::dds
