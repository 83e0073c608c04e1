// SPDX-License-Identifier: Apache-2.0
#include "common/dds/security_xml.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <ctime>

#include "common/base/error.h"
#include "common/base/escape_markup.h"
#include "common/credentials/credentials.h"
#include "common/dds/domain_xml.h"
// clang-format off
#include "dds/dds.h"
// clang-format on

namespace shoal::dds {
namespace {

namespace fs = std::filesystem;

// Debian has the plugins in a folder beside the library, where the loader does not look.
fs::path PluginPath(const std::string& plugin) {
  const std::string name = "libdds_security_" + plugin + ".so";
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_domain), &library) == 0) return name;
  const fs::path folder = fs::weakly_canonical(library.dli_fname).parent_path();
  for (const fs::path& path : {folder / "libddsc0debian" / name, folder / name}) {
    if (fs::exists(path)) return path;
  }
  throw RuntimeError("DDS security: neither '{}' nor '{}' exists",
                     (folder / "libddsc0debian" / name).string(), (folder / name).string());
}

std::string Library(const std::string& plugin, const std::string& functions) {
  return fmt::format(
      "<Library path=\"{}\" initFunction=\"init_{}\" finalizeFunction=\"finalize_{}\"/>",
      EscapeMarkup(PluginPath(plugin).string()), functions, functions);
}

// The library expands environment variables in its configuration. Its access control drops quotes
// and takes backslashes for slashes. A folder with such a name therefore cannot be passed to it.
void CheckName(const fs::path& folder) {
  for (const char* text : {"${", "\"", "\\"}) {
    if (folder.string().find(text) == std::string::npos) continue;
    throw UsageError("DDS security cannot open a folder with {} in its name: '{}'", text,
                     folder.string());
  }
}

std::string File(const char* element, const fs::path& file) {
  return fmt::format("<{0}>file:{1}</{0}>", element, EscapeMarkup(file.string()));
}

}  // namespace

std::string SecurityElement(const fs::path& folder, Role role) {
  if (folder.empty()) return "";
  CheckName(fs::absolute(folder));
  CheckCredentials(folder, link::RoleName(role), std::time(nullptr));
  const auto [ca, governance, certificate, key, permissions] =
      CredentialFiles(fs::absolute(folder), link::RoleName(role));
  return "<Security>\n  <Authentication>" + Library("auth", "authentication") +
         File("IdentityCertificate", certificate) + File("IdentityCA", ca) +
         File("PrivateKey", key) + "</Authentication>\n  <AccessControl>" +
         Library("ac", "access_control") + File("PermissionsCA", ca) +
         File("Governance", governance) + File("Permissions", permissions) +
         "</AccessControl>\n  <Cryptographic>" + Library("crypto", "crypto") +
         "</Cryptographic>\n </Security>";
}

}  // namespace shoal::dds
