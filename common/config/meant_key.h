// SPDX-License-Identifier: Apache-2.0
// Keys under the names that other programs give them (Stable-Baselines3, rl-zoo3, CleanRL, DrQ-v2):
// one table, for options of `shoal train`, for --set and for the refusal of unknown keys.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

struct MeantKey {
  std::string key{};   // path of the key; empty where no single key is meant
  std::string note{};  // what to do instead, or what differs; a part of a sentence, may be empty
  // The key has the meaning and the unit of the word, so that its value may be taken as it is.
  bool same = false;
};

// The key that `word` means: its own path ("learner.batch"), the last word of one path alone
// ("batch"), or another program's name for it ("batch_size"). '-' counts as '_'. Without key and
// note: none is known.
MeantKey FindMeantKey(std::string_view word);

}  // namespace shoal
