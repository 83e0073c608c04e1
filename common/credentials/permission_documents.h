// SPDX-License-Identifier: Apache-2.0
// The XML documents of DDS Security 1.1: sections 9.4.1.2 (governance) and 9.4.1.3 (permissions).
// Internal to common/credentials.
#pragma once

#include <string>

#include "common/credentials/credentials.h"

namespace shoal::credentials {

// Every domain: only authenticated participants with permissions join; discovery, liveliness and
// all topics' data are encrypted, and readers and writers need permission.
std::string GovernanceDocument();

// The rights of the holder of a certificate with CN=`subject`; everything else is denied.
std::string PermissionsDocument(const RoleRights& rights, const std::string& subject,
                                const Validity& validity);

}  // namespace shoal::credentials
