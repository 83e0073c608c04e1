// SPDX-License-Identifier: Apache-2.0
// The files that authenticate the processes of secured runs (DDS Security 1.1).
//
// A folder that only its owner can read (0700, files 0600) contains:
//
//   ca.pem, ca.key       certificate authority; ca.key signs only the files of this folder and may
//                        be removed afterwards
//   governance.p7s       rules of every domain: all processes authenticated, all data encrypted
//   ROLE.pem, ROLE.key   certificate (CN=shoal-ROLE) and private key of a role
//   ROLE.p7s             topics that the role may write and read
//
// A process needs ca.pem, governance.p7s and the three files of its role.
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

// Validity from one day ago, to allow for clocks that differ, to `days` from now.
Validity ValidForDays(int days);

// Creates the folder with everything in it, or nothing. Throws Error: usage when it exists.
void CreateCredentials(const std::filesystem::path& folder, std::span<const RoleRights> roles,
                       const Validity& validity);

// The five files of a role.
std::array<std::filesystem::path, 5> CredentialFiles(const std::filesystem::path& folder,
                                                     const std::string& role);

// Checks the files of a role. Throws Error, in one line naming the file, when a file is missing or
// unreadable; a certificate is not valid at `now` or not signed by ca.pem; the key does not belong
// to the certificate; or a signed document was altered or has another signer.
void CheckCredentials(const std::filesystem::path& folder, const std::string& role,
                      std::time_t now);
// Throws Error naming file and topic when the role's credentials do not permit one of the topics.
// For example, an older version that made the credentials did not have the topic.
void CheckRights(const std::filesystem::path& folder, const RoleRights& rights);

}  // namespace shoal
