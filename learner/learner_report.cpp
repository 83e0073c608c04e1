#include "learner/learner_report.h"

#include "common/base/log.h"
#include "learner/agent/frame_figures.h"

namespace shoal::learner {

LearnerReport::LearnerReport(const RunConfig& run)
    : spec_(run.spec),
      shift_pad_(run.config.replay.shift_pad),
      guard_(run.config),
      report_("learner", 0) {}

void LearnerReport::OnUpdate(const UpdateFigures& figures, const Batch& batch, uint64_t updates) {
  UpdateFigures all = figures;
  AddFrameFigures(batch.view, spec_, shift_pad_, &all);
  window_.Add(all);
  AddDataAges(batch.view.weights_update, updates, &data_ages_);
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
  add("duplicate_parts", figures.batches.duplicate_parts);
  add("unknown_parts", figures.batches.unknown_parts);
  add("malformed_parts", figures.batches.malformed_parts);
  add("dropped_answers", figures.batches.dropped_answers);
  add("warnings", guard_.warnings());
  report_.AddResources();
  return report_.message();
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
