// SPDX-License-Identifier: Apache-2.0
// The files with which the processes of secured runs prove who they are (DDS Security 1.1).
//
// A folder, open to its owner alone (0700, files 0600), holds
//
//   ca.pem, ca.key            the certificate authority of the folder; ca.key makes nothing but the
//                             files here and need not stay
//   governance.p7s            what every domain demands: everybody authenticated, all data
//   encrypted ROLE.pem, ROLE.key        certificate (CN=shoal-ROLE) and private key of a role
//   ROLE.p7s                  topics that the role may write and read
//
// A process needs ca.pem, governance.p7s and the three files of its role, no other key.
#pragma once

#include <array>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shoal {

struct RoleRights {
  std::string role;
  std::vector<std::string> publishes, subscribes;  // topic names
};

struct Validity {
  std::time_t from = 0, until = 0;  // seconds since 1970
};

// From a day ago, for clocks that differ, to `days` from now.
Validity ValidForDays(int days);

// Creates the folder with everything in it, or nothing. Throws Error: usage when it exists.
void CreateCredentials(const std::filesystem::path& folder, std::span<const RoleRights> roles,
                       const Validity& validity);

// The five files of a role.
std::array<std::filesystem::path, 5> CredentialFiles(const std::filesystem::path& folder,
                                                     const std::string& role);

// Throws Error, in one line naming the file, when one of the role's files is missing or unreadable,
// a certificate is not valid at `now`, another authority than ca.pem made it, the key is not its
// own, or a signed document was altered or is another authority's.
void CheckCredentials(const std::filesystem::path& folder, const std::string& role,
                      std::time_t now);
// Throws Error naming file and topic when the role's credentials do not permit one of the topics,
// as those made by a version that did not have it.
void CheckRights(const std::filesystem::path& folder, const RoleRights& rights);

}  // namespace shoal
