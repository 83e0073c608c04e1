// SPDX-License-Identifier: Apache-2.0
// Finds missing and damaged files of a run before it is resumed and any process is started. Counts,
// and what other files imply, are rebuilt; a line says so and names what is no longer known. Other
// damage refuses the run with one line that names the file and the remedy.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "launch/record/run_meta.h"

namespace shoal::launch {

// Throws Error (usage) naming anything in the run's folder that is no file, folder or link to one:
// a process that opened a FIFO would wait for its other end.
void CheckKindsOfFiles(const std::filesystem::path& run);

// Runs `read`; its Error becomes one of usage, with the remedy behind it.
void Refusing(const std::string& remedy, const std::function<void()>& read);

// meta.json. Where it is missing, how far the run came is taken from its account and its newest
// checkpoint, and `lines` gets a line. Throws Error (usage) when it is damaged.
RunMeta ReadMetaToGoOn(const std::filesystem::path& run, std::vector<std::string>* lines);

struct RunCheck {
  std::vector<std::string> lines{};              // for people
  std::vector<std::function<void()>> repairs{};  // to be carried out once the run goes on
};
// Everything else that the processes of the run will read. `own_actors`: actors below this number
// run on this host. Nothing is changed. Throws Error (usage).
RunCheck CheckRunFiles(const std::filesystem::path& run, const RunConfig& config,
                       const RunMeta& meta, uint32_t own_actors);

}  // namespace shoal::launch
