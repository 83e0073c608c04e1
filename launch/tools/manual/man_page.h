// SPDX-License-Identifier: Apache-2.0
// Manual pages in man(7)'s language, from what --help and the configuration's table say.
#pragma once

#include <string>

#include "launch/tools/manual/command_text.h"

namespace shoal::launch {

// A page of section 1: the program, its commands one after another, exit codes.
// Ends with `see_also`, pages as "shoal(1)", separated by commas; empty = no such section.
std::string ProgramPage(const CommandText& program, const std::string& see_also);

// shoal-configuration(5): every key.
std::string ConfigurationPage();

}  // namespace shoal::launch
