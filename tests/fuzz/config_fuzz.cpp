// SPDX-License-Identifier: Apache-2.0
// Configuration: any text is refused with Error or gives a configuration that survives being
// written and read again. First byte: 0 = a JSON file, else --set assignments, one per line.
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/check.h"
#include "common/config/config_io.h"
#include "tests/fuzz/fuzz_target.h"

namespace shoal {
namespace {

Config Read(uint8_t mode, const std::string& text) {
  Config config;
  if (mode == 0) {
    ApplyJson(ParseStrictJson(text, "input"), "input", &config);
  } else {
    std::istringstream lines(text);
    std::vector<std::string> assignments;
    for (std::string line; std::getline(lines, line);) assignments.push_back(line);
    ApplyAssignments(assignments, &config);
  }
  Validate(config);
  return config;
}

void Check(uint8_t mode, const std::string& text) {
  const std::string written = ToJson(Read(mode, text)).dump();
  Config again;
  ApplyJson(ParseStrictJson(written, "written"), "written", &again);
  CHECK(ToJson(again).dump() == written) << written;
}

}  // namespace
}  // namespace shoal

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return shoal::fuzz::Try(data, size, shoal::Check);
}
