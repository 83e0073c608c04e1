// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/actor_lock.h"

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/sleep.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"

namespace shoal::actor {

ActorLock::ActorLock(const std::filesystem::path& run, uint32_t actor,
                     std::chrono::seconds deadline, const std::function<bool()>& stop) {
  MakeFolders(run / kMadeFolder);
  const std::filesystem::path path =
      run / kMadeFolder / (ProcessName::Actor(actor).Text() + ".lock");
  const SteadyTime end = Now() + deadline;
  while (!(lock_ = FileLock::Take(path))) {
    if (Now() >= end || stop()) {
      throw RuntimeError("actor {} of this run is running already: another process holds '{}'",
                         actor, path.string());
    }
    SleepFor(std::chrono::milliseconds(50));
  }
}

}  // namespace shoal::actor
