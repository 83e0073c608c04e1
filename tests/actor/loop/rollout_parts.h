// SPDX-License-Identifier: Apache-2.0
// A rollout over environments without physics, and the objects that it borrows.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "actor/loop/rollout.h"
#include "tests/actor/counting_environment.h"
#include "tests/actor/policy_weights.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {

inline constexpr uint32_t kFirstEnv = 4;  // number of the actor's first environment

// A small network for the frames of CountingEnvironment.
inline Config SmallConfig(int envs) {
  Config config;
  config.seed = 5;
  config.envs_per_actor = envs;
  config.learner.precision = "f32";
  config.network.pool = 1;
  config.network.filters = {2};
  config.network.strides = {1};
  config.network.features = 3;
  config.network.hidden = {4};
  return config;
}

// Accepts records until it is full.
class FakeSink final : public RecordSink {
 public:
  explicit FakeSink(const ObservationSpec& spec) : layout_(spec) {}

  size_t Room() const override { return room; }
  uint8_t* BeginRecord() override {
    EXPECT_GT(room, 0u);
    open_.assign(static_cast<size_t>(layout_.record_bytes()) / 8, 0);
    return reinterpret_cast<uint8_t*>(open_.data());
  }
  void EndRecord(uint64_t sequence) override {
    sequences.push_back(sequence);
    records.push_back(open_);
    // The time is cleared, because it differs between two runs.
    RecordLayout::Header(reinterpret_cast<uint8_t*>(records.back().data())).time_ns = 0;
  }

  const uint8_t* Bytes(size_t i) const {
    return reinterpret_cast<const uint8_t*>(records.at(i).data());
  }
  const RecordHeader& Header(size_t i) const { return RecordLayout::Header(Bytes(i)); }
  const RecordLayout& layout() const { return layout_; }

  size_t room = 1000;
  std::vector<uint64_t> sequences;
  std::vector<std::vector<uint64_t>> records;  // stored as words, so that they are aligned to 8

 private:
  const RecordLayout layout_;
  std::vector<uint64_t> open_;
};

// An actor session with `envs` environments; the first has the number `first_env`.
struct RolloutParts {
  RolloutParts(const std::filesystem::path& run, RecordSink& sink, int envs, uint32_t first_env = 0,
               uint64_t session = 10)
      : RolloutParts(run, sink, SmallConfig(envs), first_env, session) {}

  // `length`: env steps of the environments' episodes.
  RolloutParts(const std::filesystem::path& run, RecordSink& sink, const Config& of,
               uint32_t first_env, uint64_t session = 10, int length = CountingEnvironment::kLength)
      : config(of),
        spec(CountingEnvironment().spec()),
        made(run, /*actor=*/0, session, first_env, static_cast<uint32_t>(of.envs_per_actor)),
        selector(config, spec, of.envs_per_actor),
        rollout(Rollout::Options::Of(config, first_env), spec,
                Environments(of.envs_per_actor, length), made, sink, selector) {}

  static std::vector<std::unique_ptr<worlds::Environment>> Environments(int envs, int length) {
    std::vector<std::unique_ptr<worlds::Environment>> environments;
    for (int e = 0; e < envs; ++e) {
      environments.push_back(std::make_unique<CountingEnvironment>(length));
    }
    return environments;
  }

  void Load(WeightsVersion version, uint64_t run_env_steps = 0) {
    selector.Load(ConstantPolicy(config.network, spec, version, /*mean=*/0.3F, /*raw_log_std=*/0,
                                 run_env_steps));
  }

  const Config config;
  const ObservationSpec spec;
  SequenceLog made;
  ActionSelector selector;
  Rollout rollout;
};

}  // namespace shoal::actor
