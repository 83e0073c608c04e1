// SPDX-License-Identifier: Apache-2.0
#include "common/base/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/base/build_info.h"
#include "common/base/error.h"

namespace shoal {

void AddVersion(CLI::App* app) {
  app->set_version_flag("--version", fmt::format("{} {} ({}), licence {}", app->get_name(),
                                                 BuildVersion(), BuildCommit(), kLicence));
}

std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv) {
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app->exit(e);
  } catch (const CLI::ParseError& e) {
    throw UsageError("{} (see {} --help)", e.what(), app->get_name());
  }
  return std::nullopt;
}

}  // namespace shoal
