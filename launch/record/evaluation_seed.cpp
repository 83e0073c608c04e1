// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluation_seed.h"

#include "common/base/files.h"
#include "common/base/random.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {

int64_t OwnEvaluationSeed(const std::filesystem::path& run) {
  constexpr int64_t kSeeds = 1'000'000'000;
  const std::string config = ReadFile(run / kConfigFile);
  const uint64_t hash = HashBytes(config.data(), config.size());
  return kSeeds + static_cast<int64_t>(hash % kSeeds);
}

}  // namespace shoal::launch
