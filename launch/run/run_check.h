// SPDX-License-Identifier: Apache-2.0
// Finds missing and damaged files of a run before the run is resumed and any process is started.
// Counts, and data that other files imply, are rebuilt; a line reports the rebuilt file and names
// the lost data. If other files are damaged, the run is refused with one line that names the file
// and the remedy.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "launch/record/run_meta.h"

namespace shoal::launch {

// Throws Error (usage) if the run's folder contains an entry that is not a file, a folder or a link
// to a file or folder; the message names the entry. For example, a process that opens a FIFO would
// wait for the other end.
void CheckKindsOfFiles(const std::filesystem::path& run);

// Calls `read`. An Error of `read` is thrown again as a usage error, with the remedy appended.
void Refusing(const std::string& remedy, const std::function<void()>& read);

// Reads meta.json. If the file is missing, the counts are taken from the run's account and newest
// checkpoint, and `lines` gets a line. Throws Error (usage) if the file is damaged.
RunMeta ReadMetaToGoOn(const std::filesystem::path& run, std::vector<std::string>* lines);

struct RunCheck {
  std::vector<std::string> lines{};              // for people
  std::vector<std::function<void()>> repairs{};  // to be called when the run is really resumed
};
// Checks all other files that the processes of the run will read. `own_actors`: actors below this
// number run on this host. Changes no file. Throws Error (usage).
RunCheck CheckRunFiles(const std::filesystem::path& run, const RunConfig& config,
                       const RunMeta& meta, uint32_t own_actors);

}  // namespace shoal::launch
