// SPDX-License-Identifier: Apache-2.0
// Questions about this host's network, asked before DDS is, for errors that name the culprit.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::dds {

// UDP port of `index` in `domain`: 7400 + 250*domain + 10 + 2*index. Discovery uses it, data the
// odd one above.
constexpr int DiscoveryPort(int domain, int index) { return 7400 + 250 * domain + 10 + 2 * index; }

// Whether the UDP port is free on this host. Binds it for an instant. Throws Error if the system
// refuses for another reason.
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
