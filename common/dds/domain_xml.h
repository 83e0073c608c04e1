// SPDX-License-Identifier: Apache-2.0
// The Cyclone DDS configuration of one process in one domain, as XML.
//
// The XML is made from a template with placeholders. The environment variable SHOAL_DDS_XML may
// name a file that replaces the whole built-in template. The placeholders are:
//
//   @INTERFACE@       name="lo" or address="10.0.0.3", an attribute of NetworkInterface
//   @FRAGMENT_BYTES@  transport.fragment_bytes
//   @TAG@             the run's tag; empty in the domain of clients
//   @INDEX@           participant index: the process's fixed port (common/link/run_topology.h);
//                     "none" for a process without a fixed port
//   @PEERS@           the <Peers> element
//   @WATERMARKS@      the <Watermarks> element: limit for the unacknowledged bytes of a writer
//   @SECURITY@        the <Security> element of a secured run, else an empty text
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/config/config.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"

namespace shoal::dds {

inline constexpr const char* kOverrideVariable = "SHOAL_DDS_XML";

// The fixed port of a process (common/link/run_topology.h); -1 for actors and clients, which have
// no fixed port.
int ParticipantIndex(Role role, uint32_t index = 0);
// The id of the DDS domain that carries a plane.
int PlaneDomain(const ClusterAddress& address, Plane plane);

std::string_view BuiltInTemplate();
// The built-in template, or the content of the file that SHOAL_DDS_XML names. Throws Error naming
// this file if it cannot be read.
std::string DomainTemplate();

// Replaces the placeholders by their values. Throws Error (kUsage) if the template has an unknown
// placeholder, or if the run is secured and the template has no @SECURITY@. Throws Error if the
// credentials are not valid.
std::string RenderDomainXml(std::string_view xml_template, const ClusterAddress& address,
                            const TransportConfig& transport, Role role, Plane plane);

}  // namespace shoal::dds
