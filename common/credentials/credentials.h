// SPDX-License-Identifier: Apache-2.0
// The files that authenticate the processes of secured runs (DDS Security 1.1).
//
// The files are in a folder that only its owner can read (0700, files 0600):
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

// Creates the folder with all its files. On failure, creates nothing and throws Error; the error is
// kUsage if the folder exists.
void CreateCredentials(const std::filesystem::path& folder, std::span<const RoleRights> roles,
                       const Validity& validity);

// The five files of a role.
std::array<std::filesystem::path, 5> CredentialFiles(const std::filesystem::path& folder,
                                                     const std::string& role);

// Checks the files of a role. Throws Error, in one line naming the file,
//   - if a file is missing or unreadable,
//   - if a certificate is not valid at `now` or is not signed by ca.pem,
//   - if the key does not belong to the certificate,
//   - if a signed document was altered or has another signer.
void CheckCredentials(const std::filesystem::path& folder, const std::string& role,
                      std::time_t now);
// Throws Error naming file and topic if the role's credentials do not permit one of the topics.
// This happens, for example, if an older version made the credentials and did not have this topic.
void CheckRights(const std::filesystem::path& folder, const RoleRights& rights);

}  // namespace shoal
