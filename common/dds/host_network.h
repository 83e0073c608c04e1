// SPDX-License-Identifier: Apache-2.0
// Checks of this host's network. These checks run before DDS starts, so that an error can name the
// port, interface or host that is wrong.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::dds {

// UDP port of `index` in `domain`: 7400 + 250*domain + 10 + 2*index. DDS uses this port for
// discovery, and the next port for data.
constexpr int DiscoveryPort(int domain, int index) { return 7400 + 250 * domain + 10 + 2 * index; }

// Whether the UDP port is free on this host. The check binds the port for an instant. Throws Error
// if the system refuses to bind for another reason.
bool UdpPortFree(int port);
// Whether an interface of this host has this name.
bool InterfaceExists(const std::string& name);
// Whether `text` is an IPv4 address such as "10.0.0.3".
bool IsAddress(const std::string& text);
// Whether an interface of this host has the IPv4 address.
bool HostHasAddress(const std::string& address);
// Names of this host's interfaces, for messages: "lo, eth0".
std::string InterfaceNames();
// Whether the name resolves to an IPv4 address.
bool HostResolves(const std::string& host);

}  // namespace shoal::dds
