// SPDX-License-Identifier: Apache-2.0
#include "common/config/former_keys.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "common/base/mutex.h"

namespace shoal {
namespace {

struct FormerName {
  std::string_view former, present;
};

// Names of version 0.1 on the left, present names on the right. Version 0.3 may drop the left ones.
constexpr FormerName kFormerNames[] = {
    {"learner.temperature", "sac.temperature"},
    {"learner.initial_temperature", "sac.initial_temperature"},
    {"learner.min_temperature", "sac.min_temperature"},
    {"learner.temperature_learning_rate", "sac.temperature_learning_rate"},
    {"learner.target_entropy", "sac.target_entropy"},
    {"learner.target_entropy_per_action", "sac.target_entropy_per_action"},
    {"learner.critic_blocks", "sac.critic_blocks"},
    {"learner.aux", "sac.aux"},
    {"learner.aux_weight", "sac.aux_weight"},
    {"ppo.normalise_observations", "learner.normalise_vectors"},
};

}  // namespace

std::string_view PresentName(std::string_view name) {
  const auto* const found = std::ranges::find(kFormerNames, name, &FormerName::former);
  return found == std::end(kFormerNames) ? name : found->present;
}

void NoteFormerName(std::string_view name) {
  const std::string_view present = PresentName(name);
  if (present == name) return;
  static Mutex mutex;
  static std::set<std::string, std::less<>> noted;
  const MutexLock lock(mutex);
  if (!noted.emplace(name).second) return;
  fmt::print(stderr,
             "shoal: note: the key {} is called {} now; its former name works until version 0.3\n",
             name, present);
}

}  // namespace shoal
