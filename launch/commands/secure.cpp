// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "common/credentials/credentials.h"
#include "common/dds/role_rights.h"
#include "launch/commands/commands.h"

namespace shoal::launch {
namespace {

struct Options {
  std::string folder;
  int days = 365;
};

int Init(const Options& options) {
  CreateCredentials(options.folder, dds::AllRoleRights(), ValidForDays(options.days));
  fmt::print("credentials valid for {} days in {}; use them with: shoal train --secure {}\n",
             options.days, options.folder, options.folder);
  return 0;
}

}  // namespace

void AddSecureCommand(CLI::App& app, Action* chosen) {
  CLI::App* secure = app.add_subcommand("secure", "Credentials for authenticated, encrypted runs");
  secure->require_subcommand(1);
  CLI::App* init = secure->add_subcommand(
      "init", "Make a certificate authority and a certificate, key and permissions for each role");
  const auto options = std::make_shared<Options>();
  init->add_option("folder", options->folder, "Folder to create; an existing one is refused")
      ->required();
  init->add_option("--days", options->days, "Days until the certificates expire")
      ->check(CLI::Range(1, 36'500));
  init->callback([=] { *chosen = [=] { return Init(*options); }; });
}

}  // namespace shoal::launch
