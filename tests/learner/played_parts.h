// SPDX-License-Identifier: Apache-2.0
// Test doubles for the training loop: generated batches, recorded messages.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/random.h"
#include "common/config/batch_options.h"
#include "common/config/on_policy.h"
#include "common/config/run_config.h"
#include "learner/batch_stream.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

// Returns batches whose content depends only on the request. Calls `before` before each batch.
class PlayedBatches final : public BatchStream {
 public:
  PlayedBatches(const RunConfig& run, uint64_t first_request)
      : schema_(SchemaOf(run)), space_(schema_.total_bytes() + 64), next_(first_request) {}

  std::optional<Batch> Next(SteadyTime) override {
    if (before) before(next_);
    if (next_ > last_request) return std::nullopt;
    uint8_t* data = space_.data() + (64 - reinterpret_cast<uintptr_t>(space_.data()) % 64) % 64;
    BatchView view = schema_.View(data);
    Random random(HashWords({next_}));
    for (const auto& values : {view.obs_vector, view.next_obs_vector, view.action, view.reward}) {
      for (float& value : values) value = static_cast<float>(random.Uniform(-1, 1));
    }
    for (float& value : view.bootstrap) value = 1;
    for (uint64_t& update : view.weights_update) update = 0;
    for (size_t row = 0; row < view.id.size(); ++row) view.id[row] = 1000 * next_ + row;
    for (size_t row = 0; row < view.probability.size(); ++row) {
      view.probability[row] = 0.01f * static_cast<float>(row + 1);
    }
    if (next_ == poisoned_request) view.reward[0] = std::numeric_limits<float>::quiet_NaN();
    const uint64_t steps = stored_steps(next_);
    view.stored_steps = steps;
    return Batch{.view = view,
                 .request = next_++,
                 .stored_records = steps + 1,
                 .unsampleable_steps = unsampleable_steps};
  }
  BatchCounters counters() const override { return {}; }
  void TakeErrors(const SampleErrors& errors) override {
    if (taken != nullptr) taken->push_back(errors);
  }
  uint64_t given() const { return next_ - 1; }

  std::function<void(uint64_t request)> before;
  uint64_t last_request = std::numeric_limits<uint64_t>::max();
  uint64_t poisoned_request = 0;
  uint64_t unsampleable_steps = 0;
  std::vector<SampleErrors>* taken = nullptr;  // null: not kept
  std::function<uint64_t(uint64_t request)> stored_steps = [](uint64_t r) { return 10 * r; };

 private:
  static BatchSchema SchemaOf(const RunConfig& run) {
    if (!LearnsOnPolicy(run.config)) return BatchSchemaOf(run);
    return {run.spec, {.batch = run.config.learner.batch, .rollout = true}};
  }

  const BatchSchema schema_;
  std::vector<uint8_t> space_;
  uint64_t next_;
};

// Stores sent messages.
class KeptMessages final : public LearnerSink {
 public:
  struct Sent {
    uint64_t update, env_steps;
    std::string checkpoint, payload;
  };

  bool Publish(const WeightsMessage& m) override { return Keep(m, accept_weights, &weights); }
  bool WeightsArrived() override { return readers_keep_up; }
  bool Publish(const EvalWeightsMessage& m) override {
    const bool accept = reject_evaluations-- <= 0;
    if (Keep(m, accept, &evaluations) && on_evaluation) on_evaluation();
    return accept;
  }
  void Publish(const MetricsMessage& m) override { reports.push_back(m); }
  void Publish(const LearnerProgress& m) override { progress.push_back(m); }

  std::vector<uint64_t> Updates(const std::vector<Sent>& sent) const {
    std::vector<uint64_t> updates;
    updates.reserve(sent.size());
    for (const Sent& s : sent) updates.push_back(s.update);
    return updates;
  }

  std::vector<Sent> weights, evaluations;
  std::vector<MetricsMessage> reports;
  std::vector<LearnerProgress> progress;
  bool accept_weights = true, readers_keep_up = true;
  int reject_evaluations = 0;
  std::function<void()> on_evaluation;
  uint64_t spec_hash = 0, session = 0;  // expected in every message

 private:
  bool Keep(const WeightsMessage& m, bool accept, std::vector<Sent>* sent) {
    if (!accept) return false;
    EXPECT_EQ(m.spec_hash, spec_hash);
    EXPECT_EQ(m.version.session, session);
    sent->push_back({m.version.update, m.env_steps, m.checkpoint,
                     std::string(m.payload.begin(), m.payload.end())});
    return true;
  }
};

}  // namespace shoal::learner
