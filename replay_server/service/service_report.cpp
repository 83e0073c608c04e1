// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/service_report.h"

#include <utility>

#include "common/config/priorities.h"

namespace shoal::replay {

const MetricsMessage& ServiceReport::Make(const std::string& state, const ServiceSeconds& seconds,
                                          FlowAges* ages) {
  const CoreCounters& counters = core_.counters();
  report_.Begin(state);
  Add("stored_records", core_.ring().last_id());
  Add("stored_steps", core_.ring().stored_steps());
  report_.AddRate("stored_records_per_second", static_cast<double>(counters.intake.records));
  Add("sampleable", core_.index().sampleable());
  AddSamples();
  report_.Add("limiter_samples_per_insert",
              core_.limiter().samples_per_insert().At(core_.ring().stored_steps()));
  report_.Add("limiter_cursor", core_.limiter().cursor());
  report_.Add("limiter_band", core_.limiter().band());
  Add("budget_env_steps", core_.budget());
  Add("actor_sessions", core_.sessions().newest().size());
  Add("queue_depth", inbox_.Depth());
  report_.Add("queue_age_seconds", std::exchange(queue_age_seconds_, 0));
  Add("requests_waiting", core_.requests().size());
  Add("slot_batches", slot_batches_);
  Add("slots_held", slots_.held());
  report_.Add("gather_threads", gatherers_.threads());
  AddTroubles();
  AddTimes(seconds);
  ages->Report(&report_);
  report_.AddResources();
  return report_.message();
}

void ServiceReport::AddSamples() {
  const CoreCounters& counters = core_.counters();
  const uint64_t sampled = counters.batches * static_cast<uint64_t>(core_.batch_schema().batch());
  const auto add_part = [&](const std::string& count, const std::string& share, uint64_t part) {
    Add(count, part);
    report_.AddShare(share, static_cast<double>(part), static_cast<double>(sampled));
  };
  Add("sampled", sampled);
  report_.AddRate("samples_per_second", static_cast<double>(sampled));
  add_part("relabelled", "relabelled_share", counters.relabelled);
  add_part("zero_rewards", "zero_reward_share", counters.zero_rewards);
  if (!HasPriorities(core_.run().config.replay)) return;
  Add("priorities_set", counters.priorities_set);
  Add("priorities_ignored", counters.priorities_ignored);
  report_.Add("largest_priority", core_.selector().largest_priority());
}

void ServiceReport::AddTroubles() {
  const CoreCounters& counters = core_.counters();
  Add("redraws", core_.selector().redraws());
  Add("duplicates", counters.intake.duplicates);
  Add("rejected", counters.intake.rejected);
  Add("after_gap", counters.intake.after_gap);
  Add("lost", counters.intake.lost);
  Add("cut_episodes", core_.index().cut_episodes());
  Add("refused_chunks", counters.intake.refused_chunks());
  Add("ahead_chunks", counters.intake.ahead_chunks);
  Add("refused_requests", counters.refused_requests);
  Add("surplus_requests", counters.surplus_requests + inbox_.DroppedRequests());
  Add("stale_requests", counters.stale_requests);
  Add("repeated_batches", counters.repeated_batches);
  Add("batches_given_up", sender_.given_up());
  Add("pool_drops", inbox_.DroppedChunks());
}

void ServiceReport::AddTimes(const ServiceSeconds& seconds) {
  report_.Add("limiter_blocked_insert_seconds", seconds.blocked_insert);
  report_.AddRate("limiter_blocked_insert_share", seconds.blocked_insert);
  report_.Add("limiter_blocked_sample_seconds", seconds.blocked_sample);
  report_.AddRate("limiter_blocked_sample_share", seconds.blocked_sample);
  report_.AddSeconds("inserting", seconds.inserting);
  report_.AddSeconds("sampling", seconds.sampling);
  report_.AddSeconds("sending", sender_.sending_seconds());
  report_.AddSeconds("idle", seconds.idle);
}

}  // namespace shoal::replay
