#include "replay_server/service/service_report.h"

namespace shoal::replay {

void ServiceReport::AddTime(double seconds, bool inserts_blocked, bool samples_blocked) {
  if (inserts_blocked) blocked_insert_seconds_ += seconds;
  if (samples_blocked) blocked_sample_seconds_ += seconds;
}

void ServiceReport::AddRate(const std::string& name, uint64_t value, uint64_t* before) {
  const double interval = report_.interval_seconds();
  if (interval > 0) report_.Add(name, static_cast<double>(value - *before) / interval);
  *before = value;
}

const MetricsMessage& ServiceReport::Make(const std::string& state) {
  const CoreCounters& counters = core_.counters();
  const uint64_t batch = static_cast<uint64_t>(core_.batch_layout().batch());
  report_.Begin(state);
  Add("stored_records", core_.ring().last_id());
  Add("stored_steps", core_.ring().stored_steps());
  AddRate("stored_records_per_second", counters.records, &records_before_);
  Add("sampleable", core_.index().sampleable());
  Add("sampled", counters.batches * batch);
  AddRate("samples_per_second", counters.batches * batch, &sampled_before_);
  report_.Add("limiter_samples_per_insert", core_.limiter().samples_per_insert());
  report_.Add("limiter_cursor", core_.limiter().cursor());
  report_.Add("limiter_band", core_.limiter().band());
  report_.Add("limiter_blocked_insert_seconds", blocked_insert_seconds_);
  report_.Add("limiter_blocked_sample_seconds", blocked_sample_seconds_);
  Add("redraws", core_.sampler().redraws());
  Add("duplicates", counters.duplicates);
  Add("rejected", counters.rejected);
  Add("after_gap", counters.after_gap);
  Add("lost", counters.lost);
  Add("cut_episodes", core_.index().cut_episodes());
  Add("actor_sessions", core_.sessions().newest().size());
  Add("refused_chunks", counters.wrong_spec_chunks + counters.malformed_chunks +
                            counters.superseded_chunks + counters.table_full_chunks);
  Add("ahead_chunks", counters.ahead_chunks);
  Add("refused_requests", counters.refused_requests + inbox_.DroppedRequests());
  Add("repeated_batches", counters.repeated_batches);
  Add("batches_given_up", sender_.given_up());
  Add("pool_drops", inbox_.DroppedChunks());
  Add("queue_depth", inbox_.Depth());
  Add("requests_waiting", core_.requests().size());
  report_.Add("rss_mb", ResidentMegabytes());
  return report_.message();
}

}  // namespace shoal::replay
