// SPDX-License-Identifier: Apache-2.0
#include "common/wire/metric_names.h"

#include <fmt/core.h>

#include <algorithm>

namespace shoal {
namespace {

using enum MetricKind;

constexpr Metric kMetrics[] = {
    {"all", "uptime_seconds", kCounter, "s", "time since the process started"},
    {"all", "rss_mb", kGauge, "MB", "resident memory"},
    {"all", "open_files", kGauge, "", "open file descriptors"},
    {"all", "cpu_seconds", kCounter, "s", "CPU time of all threads"},
    {"all", "cpu_share", kGauge, "cores", "cores used on average since the last report"},
    {"all", "malformed", kPerTopic, "", "malformed messages of a topic, which were dropped"},

    {"coordinator", "elapsed_seconds", kGauge, "s",
     "running time of the run, summed over its sessions"},
    {"coordinator", "env_steps", kGauge, "env steps", "env steps of the run"},
    {"coordinator", "budget_env_steps", kGauge, "env steps", "env steps at which the run ends"},
    {"coordinator", "actors", kGauge, "", "actors that the run should have"},
    {"coordinator", "stop_success", kGauge, "", "success rate at which the run ends"},
    {"coordinator", "stop_evaluations", kGauge, "",
     "newest evaluations that are pooled for stop_success"},
    {"coordinator", "usable_cores", kGauge, "cores", "cores that the coordinator may use"},
    {"coordinator", "env_steps_per_second", kGauge, "env steps/s",
     "env steps per second of all actors, over the last half minute"},
    {"coordinator", "updates_per_second", kGauge, "updates/s",
     "updates per second, over the last half minute"},
    {"coordinator", "seconds_left", kGauge, "s",
     "time until the budget is spent, at the rate of the last two minutes"},
    {"coordinator", "rollout_success", kGauge, "", "success rate of the actors' latest episodes"},
    {"coordinator", "rollout_return", kGauge, "",
     "mean return of the actors' latest episodes, unscaled"},
    {"coordinator", "limiter_blocked_insert_share", kGauge, "",
     "share of the last half minute in which the limiter blocked the actors"},
    {"coordinator", "limiter_blocked_sample_share", kGauge, "",
     "share of the last half minute in which the limiter blocked the learner"},
    {"coordinator", "recent", kPerStage, "",
     "share of the last half minute that a role spent in a stage; not in metrics.jsonl"},
    {"coordinator", "recent_cores", kGauge, "cores",
     "cores used by all processes over the last half minute; not in metrics.jsonl"},
    {"coordinator", "actors_elsewhere", kGauge, "", "1 if actors run on other hosts"},
    {"coordinator", "learner_threads", kGauge, "", "learner.threads in force"},
    {"coordinator", "most_threads", kGauge, "",
     "learner threads for which a batch has enough rows"},
    {"coordinator", "may_play_ahead", kGauge, "", "1 on policy with ppo.versions_ahead = 0"},
    {"coordinator", "last_evaluation_success", kGauge, "", "success rate of the last evaluation"},
    {"coordinator", "last_evaluation_return", kGauge, "",
     "mean return of the last evaluation, unscaled"},
    {"coordinator", "last_evaluation_return_std", kGauge, "",
     "standard deviation of the returns of the last evaluation"},
    {"coordinator", "last_evaluation_length", kGauge, "env steps",
     "mean episode length of the last evaluation"},
    {"coordinator", "last_evaluation_episodes", kGauge, "", "episodes of the last evaluation"},
    {"coordinator", "last_evaluation_env_steps", kGauge, "env steps",
     "env steps of the run at the last evaluation"},
    {"coordinator", "best_evaluation_success", kGauge, "", "success rate of the best evaluation"},
    {"coordinator", "best_evaluation_return", kGauge, "",
     "mean return of the best evaluation, unscaled"},
    {"coordinator", "best_evaluation_return_std", kGauge, "",
     "standard deviation of the returns of the best evaluation"},
    {"coordinator", "best_evaluation_length", kGauge, "env steps",
     "mean episode length of the best evaluation"},
    {"coordinator", "best_evaluation_episodes", kGauge, "", "episodes of the best evaluation"},
    {"coordinator", "best_evaluation_env_steps", kGauge, "env steps",
     "env steps of the run at the best evaluation"},
    {"coordinator", "processes", kGauge, "", "processes that run or are being restarted"},
    {"coordinator", "restarts", kCounter, "", "restarts of processes, over the whole run"},
    {"coordinator", "actors_working", kGauge, "",
     "training actors, except those that died and do not work again yet"},
    {"coordinator", "faulty_episodes", kCounter, "",
     "faulty episodes of the training actors (ended at a number that is not finite), over the "
     "whole run"},
    {"coordinator", "messages_dropped", kCounter, "",
     "reports dropped because they came faster than they were read"},
    {"coordinator", "metrics_lines_left_out", kCounter, "",
     "reports left out of metrics.jsonl to keep within its budget"},
    {"coordinator", "evaluations_repeated", kCounter, "",
     "evaluations dropped because they were counted before, or a newer one was"},
    {"coordinator", "evaluations_refused", kCounter, "",
     "evaluations refused because they are impossible or unreadable"},
    {"coordinator", "reports_refused", kCounter, "",
     "reports refused because they name another role than the sender's"},
    {"coordinator", "exit_code", kGauge, "", "exit code of the run; in the last view only"},

    {"actor", "env_steps", kCounter, "env steps", "env steps played"},
    {"actor", "env_steps_per_second", kGauge, "env steps/s", "env steps played per second"},
    {"actor", "made", kCounter, "records", "records made, resets included"},
    {"actor", "outstanding", kGauge, "records", "records made and not yet acknowledged"},
    {"actor", "credit", kGauge, "records", "records that may still be made and sent"},
    {"actor", "queue_age_seconds", kGauge, "s",
     "age of the oldest record that is not acknowledged"},
    {"actor", "resends", kCounter, "records", "records sent again"},
    {"actor", "write_timeouts", kCounter, "", "sends that the network did not accept in time"},
    {"actor", "weights_refused", kCounter, "",
     "weights refused because of another spec or a wrong checksum"},
    {"actor", "weights_receiver", kGauge, "",
     "1 if this actor receives the weights itself, 0 if it reads those of another actor of its "
     "host"},
    {"actor", "weights_update", kGauge, "updates", "update of the weights that choose the actions"},
    {"actor", "physics", kStage, "s", "stepping Shoal's own worlds, resets included"},
    {"actor", "rendering", kStage, "s", "drawing the frames of Shoal's own worlds"},
    {"actor", "user_code", kStage, "s", "running reset and step of the user's environments"},
    {"actor", "conversion", kStage, "s",
     "Shoal's part of the steps of the user's environments: converting actions, observations and "
     "images"},
    {"actor", "inference", kStage, "s", "choosing actions"},
    {"actor", "publishing", kStage, "s", "passing records to the network"},
    {"actor", "waiting_credit", kStage, "s", "waiting for credit of the replay"},
    {"actor", "weights", kStage, "s",
     "loading new weights; in lockstep and on policy also waiting for them"},
    {"actor", "episodes", kCounter, "",
     "episodes that ended, without those cut short to spread the resets"},
    {"actor", "rollout_success", kGauge, "", "success rate of this actor's last 100 episodes"},
    {"actor", "rollout_return", kGauge, "",
     "mean return of this actor's last 100 episodes, unscaled"},
    {"actor", "rollout_length", kGauge, "env steps",
     "mean length of this actor's last 100 episodes"},
    {"actor", "rollout_final_distance", kGauge, "m",
     "mean distance to the goal at the end of this actor's last 100 episodes"},
    {"actor", "faulty_episodes_diverged", kCounter, "",
     "episodes that ended because the simulation's state was not finite"},
    {"actor", "faulty_episodes_observation", kCounter, "",
     "episodes that ended because a number of the observation was not finite"},
    {"actor", "faulty_episodes_reward", kCounter, "",
     "episodes that ended because the reward was not finite"},

    {"eval", "evaluations", kCounter, "", "finished evaluations"},
    {"eval", "eval_env_steps", kCounter, "env steps",
     "env steps of evaluations, which do not count as the run's"},
    {"eval", "evaluations_overtaken", kCounter, "",
     "evaluation points that were replaced by newer ones before they were played"},
    {"eval", "weights_refused", kCounter, "",
     "weights refused because of another spec or a wrong checksum"},
    {"eval", "evaluating", kStage, "s", "playing episodes"},

    {"replay", "stored_records", kGauge, "records", "records stored over the whole run"},
    {"replay", "stored_steps", kGauge, "env steps",
     "env steps among the stored records: the run's env steps"},
    {"replay", "stored_records_per_second", kGauge, "records/s", "records stored per second"},
    {"replay", "sampleable", kGauge, "env steps", "steps at which a sample can begin now"},
    {"replay", "sampled", kCounter, "", "batch elements drawn"},
    {"replay", "samples_per_second", kGauge, "1/s", "batch elements drawn per second"},
    {"replay", "relabelled", kCounter, "samples", "samples that got another goal by hindsight"},
    {"replay", "relabelled_share", kGauge, "",
     "share of relabelled samples among the batch elements of the last interval"},
    {"replay", "zero_rewards", kCounter, "samples",
     "samples with reward 0, which in a sparse task means that the goal is reached"},
    {"replay", "zero_reward_share", kGauge, "",
     "share of samples with reward 0 among the batch elements of the last interval"},
    {"replay", "priorities_set", kCounter, "samples",
     "priorities that the learner sent and that were stored"},
    {"replay", "priorities_ignored", kCounter, "samples",
     "priorities that the learner sent for samples that had been overwritten"},
    {"replay", "largest_priority", kGauge, "",
     "largest priority so far, to the power of replay.priority_exponent"},
    {"replay", "limiter_samples_per_insert", kGauge, "", "replay.samples_per_insert in force"},
    {"replay", "limiter_cursor", kGauge, "samples",
     "samples granted minus samples drawn; within ± half a band"},
    {"replay", "limiter_band", kGauge, "samples", "width of the limiter's band"},
    {"replay", "limiter_blocked_insert_seconds", kCounter, "s",
     "time in which the limiter blocked the actors"},
    {"replay", "limiter_blocked_insert_share", kGauge, "",
     "share of the last interval in which the limiter blocked the actors"},
    {"replay", "limiter_blocked_sample_seconds", kCounter, "s",
     "time in which the limiter blocked the learner"},
    {"replay", "limiter_blocked_sample_share", kGauge, "",
     "share of the last interval in which the limiter blocked the learner"},
    {"replay", "budget_env_steps", kGauge, "env steps",
     "stored env steps at which the replay stops giving credit"},
    {"replay", "actor_sessions", kGauge, "", "actors that have sent records"},
    {"replay", "queue_depth", kGauge, "", "chunks and requests that wait for the service thread"},
    {"replay", "queue_age_seconds", kGauge, "s", "longest wait of a chunk in the last interval"},
    {"replay", "requests_waiting", kGauge, "batches", "requested batches that are not sent yet"},
    {"replay", "slot_batches", kCounter, "batches",
     "batches drawn into shared memory instead of being sent"},
    {"replay", "slots_held", kGauge, "batches", "batches kept in shared memory for the learner"},
    {"replay", "gather_threads", kGauge, "", "threads that copy the frames of a batch"},
    {"replay", "redraws", kCounter, "", "drawn steps that could not be used, and were drawn again"},
    {"replay", "duplicates", kCounter, "records", "records that arrived again and were dropped"},
    {"replay", "rejected", kCounter, "records", "malformed records, which were dropped"},
    {"replay", "after_gap", kCounter, "records",
     "records dropped because their predecessor is not stored"},
    {"replay", "lost", kCounter, "records",
     "records that were lost with the memory of an earlier replay server"},
    {"replay", "cut_episodes", kCounter, "",
     "episodes closed because the next record never arrived"},
    {"replay", "refused_chunks", kCounter, "",
     "chunks refused: of another spec, malformed, superseded or from the future"},
    {"replay", "ahead_chunks", kCounter, "", "chunks that arrived before their predecessor"},
    {"replay", "refused_requests", kCounter, "", "batch requests that do not fit the run"},
    {"replay", "surplus_requests", kCounter, "",
     "batch requests beyond the learner's credits; the learner sends them again"},
    {"replay", "stale_requests", kCounter, "",
     "batch requests of a learner that has been replaced"},
    {"replay", "repeated_batches", kCounter, "", "batches sent again"},
    {"replay", "batches_given_up", kCounter, "", "batches that no learner took in time"},
    {"replay", "pool_drops", kCounter, "",
     "chunks dropped because no buffer was free; the actors send them again"},
    {"replay", "inserting", kStage, "s", "storing records"},
    {"replay", "sampling", kStage, "s", "drawing batches, and waiting for threads that copy them"},
    {"replay", "sending", kStage, "s", "sending batches, on a thread of its own"},
    {"replay", "idle", kStage, "s", "waiting for messages"},
    {"replay", "policy_lag", kQuantiles, "updates",
     "updates from the weights that chose an action to the newest weights when its record is "
     "stored"},
    {"replay", "store_age_seconds", kQuantiles, "s", "time from making a record to storing it"},
    {"replay", "data_age_seconds", kQuantiles, "s", "time from making a step to drawing it"},

    {"learner", "updates", kGauge, "updates", "updates over the whole run"},
    {"learner", "env_steps", kGauge, "env steps",
     "env steps that were stored when the last batch was drawn"},
    {"learner", "updates_per_second", kGauge, "updates/s", "updates per second"},
    {"learner", "data_age_updates", kQuantiles, "updates",
     "updates since the weights that chose the actions of a batch"},
    {"learner", "waiting_data", kStage, "s", "waiting for batches"},
    {"learner", "forward", kStage, "s", "computing forward passes and losses"},
    {"learner", "backward", kStage, "s", "computing gradients"},
    {"learner", "optimiser", kStage, "s", "optimiser steps, target networks and averages"},
    {"learner", "weights", kStage, "s", "publishing weights"},
    {"learner", "checkpoint", kStage, "s", "writing checkpoints"},
    {"learner", "rollouts_expected", kGauge, "environments",
     "on policy: environments whose rollouts the next update waits for"},
    {"learner", "rollouts_ready", kGauge, "environments",
     "on policy: expected environments whose rollout is complete"},
    {"learner", "rollouts_late", kCounter, "",
     "on policy: environments that were missing in updates"},
    {"learner", "rollouts_dropped", kCounter, "", "on policy: rollouts that no update used"},
    {"learner", "stored_records", kCounter, "records", "on policy: records received"},
    {"learner", "rejected", kCounter, "records",
     "on policy: malformed records, which were dropped"},
    {"learner", "after_gap", kCounter, "records",
     "on policy: records dropped because their predecessor did not arrive"},
    {"learner", "lost", kCounter, "records",
     "on policy: records that were lost with the memory of an earlier learner"},
    {"learner", "duplicates", kCounter, "records",
     "on policy: records that arrived again and were dropped"},
    {"learner", "refused_chunks", kCounter, "",
     "on policy: chunks refused: of another spec, malformed, superseded or from the future"},
    {"learner", "pool_drops", kCounter, "",
     "on policy: chunks dropped because no buffer was free; the actors send them again"},
    {"learner", "actor_sessions", kGauge, "", "on policy: actors that have sent records"},
    {"learner", "requests_outstanding", kGauge, "batches", "batches requested and not used yet"},
    {"learner", "batches_ready", kGauge, "batches", "requested batches that have arrived"},
    {"learner", "batches_shared", kGauge, "",
     "1 if batches come through shared memory, 0 if over the network"},
    {"learner", "samples_per_insert", kGauge, "", "replay.samples_per_insert in force"},
    {"learner", "budget_env_steps", kGauge, "env steps", "env_steps in force"},
    {"learner", "eval_interval", kGauge, "env steps", "eval.interval in force"},
    {"learner", "weights_period", kGauge, "updates", "learner.weights_period in force"},
    {"learner", "threads", kGauge, "", "learner.threads in force"},
    {"learner", "card_memory_mb", kGauge, "MB", "on a GPU: its memory that all processes use"},
    {"learner", "card_memory_size_mb", kGauge, "MB", "on a GPU: its memory"},
    {"learner", "card_busy", kGauge, "",
     "on a GPU: share of the last second in which a kernel ran; absent without NVML"},
    {"learner", "weights_sent", kCounter, "", "versions of the weights published"},
    {"learner", "weights_unsent", kCounter, "",
     "versions of the weights that the network did not accept"},
    {"learner", "evaluations_overtaken", kCounter, "",
     "evaluation points that were replaced by newer ones before they were sent"},
    {"learner", "checkpoints", kCounter, "", "checkpoints written"},
    {"learner", "checkpoints_unwritten", kGauge, "",
     "checkpoints that could not be written and are retried"},
    {"learner", "eval_updates", kGauge, "updates", "updates at the last evaluation point"},
    {"learner", "drained", kGauge, "", "1 once draining has ended"},
    {"learner", "resent_requests", kCounter, "", "batch requests sent again"},
    {"learner", "duplicate_parts", kCounter, "", "batches, or parts of them, that arrived twice"},
    {"learner", "unknown_parts", kCounter, "",
     "batches, or parts of them, of finished requests or an earlier learner"},
    {"learner", "malformed_parts", kCounter, "",
     "batches, or parts of them, with sizes or offsets that no batch has"},
    {"learner", "refused_slots", kCounter, "",
     "shared-memory slots that could not be opened or did not hold their batch, which was "
     "requested again"},
    {"learner", "dropped_answers", kCounter, "",
     "incomplete batches that were replaced by another answer"},
    {"learner", "warnings", kCounter, "", "warnings of training that runs but does not learn"},
};

bool Matches(const Metric& metric, std::string_view reported) {
  const std::string name(metric.name);
  switch (metric.kind) {
    case kGauge:
    case kCounter:
      return reported == name;
    case kQuantiles:
      return reported == name + "_p50" || reported == name + "_p90" || reported == name + "_p99";
    case kPerTopic:
      return reported.starts_with(name + "_");
    case kStage:
      return reported == "seconds_" + name || reported == "share_" + name;
    case kPerStage:
      return std::ranges::any_of(kMetrics, [&](const Metric& stage) {
        return stage.kind == kStage &&
               reported == fmt::format("{}_{}_{}", name, stage.role, stage.name);
      });
  }
  return false;
}

std::string ShownName(const Metric& metric) {
  if (metric.kind == kStage) return fmt::format("`seconds_{0}`, `share_{0}`", metric.name);
  if (metric.kind == kPerStage) return fmt::format("`{}_ROLE_STAGE`", metric.name);
  if (metric.kind == kPerTopic) return fmt::format("`{}_TOPIC`", metric.name);
  if (metric.kind == kQuantiles) return fmt::format("`{}_p50`, `_p90`, `_p99`", metric.name);
  return fmt::format("`{}`", metric.name);
}

}  // namespace

std::span<const Metric> ProcessMetrics() { return kMetrics; }

const Metric* FindMetric(std::span<const Metric> metrics, std::string_view role,
                         std::string_view reported) {
  for (const Metric& metric : metrics) {
    if ((metric.role == role || metric.role == "all") && Matches(metric, reported)) return &metric;
  }
  return nullptr;
}

std::string DescribeMetrics(std::span<const Metric> metrics) {
  std::string table = "| role | metric | unit | meaning |\n| --- | --- | --- | --- |\n";
  for (const Metric& metric : metrics) {
    table += fmt::format("| {} | {} | {} | {}{} |\n", metric.role, ShownName(metric), metric.unit,
                         metric.meaning,
                         metric.kind == kCounter || metric.kind == kPerTopic ? " (counter)" : "");
  }
  return table;
}

}  // namespace shoal
