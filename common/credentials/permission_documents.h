// SPDX-License-Identifier: Apache-2.0
// The XML documents of DDS Security 1.1: sections 9.4.1.2 (governance) and 9.4.1.3 (permissions).
// Internal to common/credentials.
#pragma once

#include <string>

#include "common/credentials/credentials.h"

namespace shoal::credentials {

// The rules of every domain: only authenticated participants with permissions may join; discovery,
// liveliness and the data of all topics are encrypted; readers and writers need permission.
std::string GovernanceDocument();

// Grants `rights` to the holder of a certificate with CN=`subject`; all other access is denied.
std::string PermissionsDocument(const RoleRights& rights, const std::string& subject,
                                const Validity& validity);

}  // namespace shoal::credentials
