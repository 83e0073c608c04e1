// SPDX-License-Identifier: Apache-2.0
// Finds keys by the names that other programs use (Stable-Baselines3, rl-zoo3, CleanRL, DrQ-v2).
// `shoal train` uses this table for its options, for --set and in errors for unknown keys.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

struct MeantKey {
  std::string key{};   // path of the key; empty if the word means no single key
  std::string note{};  // advice, or a difference in meaning; a part of a sentence, may be empty
  // Whether the key has the same meaning and unit as the word, so that the value can be used
  // unchanged.
  bool same = false;
};

// The key that `word` means. `word` is the key's path ("learner.batch"), the last word of exactly
// one path ("batch"), or another program's name for the key ("batch_size"). '-' counts as '_'. If
// no key is known, key and note are empty.
MeantKey FindMeantKey(std::string_view word);

}  // namespace shoal
