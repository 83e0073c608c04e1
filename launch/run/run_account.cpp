// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_account.h"

#include <vector>

#include "actor/sending/sequence_log.h"
#include "common/run_folder/accounting_file.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {

std::optional<Accounting> AccountRun(const std::filesystem::path& run, const Config& config,
                                     const link::RunTopology& topology, uint64_t resends) {
  std::vector<MadeRecords> made;
  for (const actor::MadeCount& page : actor::ReadSequenceLogs(run)) {
    made.push_back({page.actor, page.session, page.made, /*known=*/!page.rebuilt});
  }
  if (made.empty() && !std::filesystem::exists(run / kAccountingFile)) return std::nullopt;
  return Account(
      made, ReadAccount(run),
      {.resends = resends,
       .own_actors = static_cast<uint32_t>(topology.ActorsOn(0).size()),
       .outlives_replay = topology.Has(link::Role::kReplay) && config.replay.storage == "file"});
}

}  // namespace shoal::launch
