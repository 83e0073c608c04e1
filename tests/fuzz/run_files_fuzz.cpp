// SPDX-License-Identifier: Apache-2.0
// The small files and JSON messages of a run: any bytes are refused with Error or are valid. First
// byte: the kind of file or message.
#include <nlohmann/json.hpp>

#include "actor/sending/sequence_log.h"
#include "common/base/check.h"
#include "common/config/run_files.h"
#include "common/config/session_number.h"
#include "launch/record/accounting.h"
#include "launch/record/evaluations.h"
#include "tests/fuzz/fuzz_target.h"

namespace shoal {
namespace {

void Read(uint8_t which, const std::string& bytes) {
  const std::filesystem::path& run = fuzz::Scratch();
  std::filesystem::create_directories(run / "made");
  std::filesystem::create_directories(run / "sessions");
  switch (which % 6) {
    case 0:
      fuzz::WriteScratch(run / "config.json", bytes);
      ReadRunConfig(run);
      break;
    case 1: {
      fuzz::WriteScratch(run / "cluster.json", bytes);
      const ClusterAddress address = ReadClusterAddress(run);
      CHECK(address.domain >= 0 && address.domain < 100);
      break;
    }
    case 2:
      fuzz::WriteScratch(run / "accounting.json", bytes);
      launch::Account({}, ReadAccount(run), {.own_actors = 1});
      break;
    case 3:
      fuzz::WriteScratch(run / "made" / "actor-0-1.page", bytes);
      actor::ReadSequenceLogs(run);
      break;
    case 4:
      launch::ParseEvaluation(bytes, "evaluation");
      break;
    case 5:
      fuzz::WriteScratch(run / "sessions" / "actor-0", bytes);
      CHECK(NextSession(run, "actor-0", 5) >= 5);
      break;
  }
}

}  // namespace
}  // namespace shoal

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return shoal::fuzz::Try(data, size, shoal::Read);
}
