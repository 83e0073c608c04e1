// SPDX-License-Identifier: Apache-2.0
// Random streams. Each stream has a key (seed of the stream). The key depends on the purpose of the
// stream and not on the process that draws from the stream. Results therefore do not depend on the
// distribution of environments over processes.
//
// Generator: xoshiro256++ (Blackman and Vigna 2019, arXiv:1805.01407), seeded by splitmix64.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

namespace shoal {

// Streams with different roles are different. Values are stored in files, so never renumber them.
enum class StreamRole : uint64_t {
  kTrainEnvironment = 1,
  kEvalEnvironment = 2,
  kFinalEnvironment = 3,
  kTrainPolicy = 4,
  kEvalPolicy = 5,
  kReplaySampler = 6,
  kLearnerUpdate = 7,
  kNetworkInit = 8,
};

// Mixes the words, in order, into one 64-bit key.
uint64_t HashWords(std::initializer_list<uint64_t> words);
// FNV-1a of bytes, finished by one splitmix64 round.
uint64_t HashBytes(const void* data, uint64_t size);

// Key of one stream of a role. `a` and `b` distinguish the streams of the role.
inline uint64_t StreamKey(uint64_t seed, StreamRole role, uint64_t a = 0, uint64_t b = 0) {
  return HashWords({seed, static_cast<uint64_t>(role), a, b});
}

class Random {
 public:
  using State = std::array<uint64_t, 4>;

  explicit Random(uint64_t key);

  uint64_t Next();
  // Uniform in [0, 1), 53 random bits.
  double Uniform();
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  // Uniform in {0, ..., n-1}, n > 0; unbiased (Lemire's rejection).
  uint64_t Below(uint64_t n);
  // Standard normal by Box-Muller. Each call draws two uniform numbers and stores no second result.
  double Normal();
  // Advances the stream as Normal does, at a tenth of its cost.
  void SkipNormal() {
    Next();
    Next();
  }

  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  State state_;
};

}  // namespace shoal
