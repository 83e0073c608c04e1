// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_report.h"

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/config/on_policy.h"
#include "learner/agent/frame_figures.h"
#include "learner/agent/sample_figures.h"

namespace shoal::learner {
namespace {

// Frame figures read megabytes while the other replicas wait, and a few batches represent all
// batches of a report.
constexpr int kFrameFiguresEvery = 16;  // updates

}  // namespace

LearnerReport::LearnerReport(const ProcessName& name, const RunConfig& run)
    : spec_(run.spec),
      shift_pad_(LearnsOnPolicy(run.config) ? 0 : run.config.replay.shift_pad),
      guard_(run.config),
      report_(name) {}

void LearnerReport::OnBatch(const Batch& batch, uint64_t updates) {
  UpdateFigures& figures = batches_.emplace_back();
  AddSampleFigures(batch.view, spec_, &figures);
  if (window_batches_++ % kFrameFiguresEvery == 0) {
    AddFrameFigures(batch.view, spec_, shift_pad_, &figures);
  }
  AddDataAges(batch.view.weights_update, updates, &data_ages_);
}

void LearnerReport::OnUpdate(const UpdateFigures& figures) {
  CHECK(!batches_.empty());
  UpdateFigures all = figures;
  for (const auto& [figure, value] : batches_.front().entries()) all.Set(*figure, value);
  batches_.pop_front();
  window_.Add(all);
}

const MetricsMessage& LearnerReport::Make(const LearnerFigures& figures) {
  const int updates = window_.updates();
  if (updates > 0) {
    const UpdateFigures mean = window_.Mean();
    for (const auto& [figure, value] : mean.entries()) latest_.Replace(*figure, value);
    if (const auto ages = data_ages_.Take()) data_age_ = *ages;
    for (const std::string& warning : guard_.Check(mean, updates, Now())) {
      log::Warning("{}", warning);
    }
  }
  window_.Clear();
  window_batches_ = 0;
  const auto add = [&](const std::string& name, auto value) {
    report_.Add(name, static_cast<double>(value));
  };
  report_.Begin(figures.state);
  add("updates", figures.updates);
  add("env_steps", figures.env_steps);
  updates_made_ += static_cast<uint64_t>(updates);
  report_.AddRate("updates_per_second", static_cast<double>(updates_made_));
  if (!latest_.empty()) {
    for (const auto& [figure, value] : latest_.entries()) add(std::string(figure->name), value);
    report_.AddQuantiles("data_age_updates", data_age_);
  }
  AddTimes(figures.seconds);
  if (figures.batches.rollouts) {
    AddRollouts(*figures.batches.rollouts);
  } else {
    AddBatches(figures);
  }
  add("eval_interval", figures.eval_interval);
  add("budget_env_steps", figures.budget);
  add("threads", figures.threads);
  if (figures.card) AddCard(*figures.card);
  add("weights_sent", figures.weights_sent);
  add("weights_unsent", figures.weights_unsent);
  add("evaluations_overtaken", figures.evaluations_overtaken);
  add("checkpoints", figures.checkpoints);
  add("checkpoints_unwritten", figures.checkpoints_unwritten);
  add("eval_updates", figures.eval_updates);
  add("drained", figures.drained);
  add("warnings", guard_.warnings());
  report_.AddResources();
  return report_.message();
}

void LearnerReport::AddCard(const CardUse& card) {
  report_.Add("card_memory_mb", static_cast<double>(card.memory_bytes) / 1e6);
  report_.Add("card_memory_size_mb", static_cast<double>(card.memory_size_bytes) / 1e6);
  if (card.busy >= 0) report_.Add("card_busy", card.busy);
}

void LearnerReport::AddBatches(const LearnerFigures& figures) {
  const BatchCounters& batches = figures.batches;
  const auto add = [&](const std::string& name, auto value) {
    report_.Add(name, static_cast<double>(value));
  };
  add("requests_outstanding", batches.requests_outstanding);
  add("batches_ready", batches.ready);
  if (batches.shared) add("batches_shared", *batches.shared);
  add("samples_per_insert", figures.samples_per_insert);
  add("weights_period", figures.weights_period);
  add("resent_requests", batches.resent_requests);
  add("duplicate_parts", batches.duplicate_parts);
  add("unknown_parts", batches.unknown_parts);
  add("malformed_parts", batches.malformed_parts);
  add("refused_slots", batches.refused_slots);
  add("dropped_answers", batches.dropped_answers);
}

void LearnerReport::AddRollouts(const BatchCounters::Rollouts& rollouts) {
  const auto add = [&](const std::string& name, uint64_t value) {
    report_.Add(name, static_cast<double>(value));
  };
  add("rollouts_expected", rollouts.expected);
  add("rollouts_ready", rollouts.ready);
  add("rollouts_late", rollouts.late);
  add("rollouts_dropped", rollouts.dropped);
  add("stored_records", rollouts.records);
  add("rejected", rollouts.rejected);
  add("after_gap", rollouts.after_gap);
  add("lost", rollouts.lost);
  add("duplicates", rollouts.duplicates);
  add("refused_chunks", rollouts.refused_chunks);
  add("pool_drops", rollouts.pool_drops);
  add("actor_sessions", rollouts.actor_sessions);
}

void LearnerReport::AddTimes(const LearnerSeconds& seconds) {
  report_.AddSeconds("waiting_data", seconds.waiting);
  const auto stage = [&](UpdateStage s) { return seconds.update[static_cast<size_t>(s)]; };
  report_.AddSeconds("forward", stage(UpdateStage::kForward));
  report_.AddSeconds("backward", stage(UpdateStage::kBackward));
  report_.AddSeconds("optimiser", stage(UpdateStage::kOptimiser));
  report_.AddSeconds("weights", seconds.weights);
  report_.AddSeconds("checkpoint", seconds.checkpoint);
}

}  // namespace shoal::learner
