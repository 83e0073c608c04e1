#include "learner/learner_report.h"

#include "common/base/log.h"

namespace shoal::learner {

LearnerReport::LearnerReport(const RunConfig& run)
    : guard_(run.config, run.spec.HasPixels()), report_("learner", 0) {}

void LearnerReport::OnUpdate(const UpdateStats& stats, const Batch& batch, uint64_t updates) {
  any_updates_ = true;
  window_.Add(stats);
  AddDataAges(batch.view.weights_update, updates, &data_ages_);
}

const MetricsMessage& LearnerReport::Make(const LearnerFigures& figures) {
  const int updates = window_.updates();
  if (updates > 0) {
    mean_ = window_.Mean();
    for (const std::string& warning : guard_.Check(mean_, updates, Now())) {
      log::Warning("{}", warning);
    }
  }
  window_.Clear();
  const auto add = [&](const char* name, auto value) {
    report_.Add(name, static_cast<double>(value));
  };
  report_.Begin(figures.state);
  add("updates", figures.updates);
  add("env_steps", figures.env_steps);
  updates_made_ += static_cast<uint64_t>(updates);
  report_.AddRate("updates_per_second", static_cast<double>(updates_made_));
  if (any_updates_) AddUpdateFigures();
  AddTimes(figures.seconds);
  add("requests_outstanding", figures.batches.requests_outstanding);
  add("batches_ready", figures.batches.ready);
  add("samples_per_insert", figures.samples_per_insert);
  add("eval_interval", figures.eval_interval);
  add("weights_period", figures.weights_period);
  add("weights_sent", figures.weights_sent);
  add("weights_unsent", figures.weights_unsent);
  add("evaluations_overtaken", figures.evaluations_overtaken);
  add("checkpoints", figures.checkpoints);
  add("eval_updates", figures.eval_updates);
  add("drained", figures.drained);
  add("resent_requests", figures.batches.resent_requests);
  add("duplicate_shards", figures.batches.duplicate_shards);
  add("unknown_shards", figures.batches.unknown_shards);
  add("malformed_shards", figures.batches.malformed_shards);
  add("dropped_answers", figures.batches.dropped_answers);
  add("warnings", guard_.warnings());
  report_.AddResources();
  return report_.message();
}

void LearnerReport::AddUpdateFigures() {
  report_.Add("critic_loss", mean_.critic_loss);
  report_.Add("actor_loss", mean_.actor_loss);
  report_.Add("temperature", mean_.temperature);
  report_.Add("temperature_loss", mean_.temperature_loss);
  report_.Add("q_mean", mean_.q_mean);
  report_.Add("target_mean", mean_.target_mean);
  report_.Add("entropy", mean_.entropy);
  report_.Add("action_saturation", mean_.action_saturation);
  report_.Add("critic_grad_norm", mean_.critic_grad_norm);
  report_.Add("actor_grad_norm", mean_.actor_grad_norm);
  if (const auto ages = data_ages_.Take()) data_age_ = *ages;
  report_.AddQuantiles("data_age_updates", data_age_);
}

void LearnerReport::AddTimes(const LearnerSeconds& seconds) {
  report_.AddSeconds("waiting_data", seconds.waiting);
  report_.AddSeconds("forward", seconds.update.forward);
  report_.AddSeconds("backward", seconds.update.backward);
  report_.AddSeconds("optimiser", seconds.update.optimiser);
  report_.AddSeconds("weights", seconds.weights);
  report_.AddSeconds("checkpoint", seconds.checkpoint);
}

}  // namespace shoal::learner
