// SPDX-License-Identifier: Apache-2.0
#include "common/wire/metric_names.h"

#include <fmt/core.h>

#include <algorithm>

namespace shoal {
namespace {

using enum MetricKind;

constexpr Metric kMetrics[] = {
    {"all", "uptime_seconds", kCounter, "s", "since the process's start"},
    {"all", "rss_mb", kGauge, "MB", "resident memory"},
    {"all", "open_files", kGauge, "", "open file descriptors"},
    {"all", "cpu_seconds", kCounter, "s", "processor time of all threads"},
    {"all", "cpu_share", kGauge, "cores", "processors used on average"},
    {"all", "malformed", kPerTopic, "", "messages of a topic that make no sense, dropped"},

    {"coordinator", "elapsed_seconds", kGauge, "s", "since the run's start, all its sessions"},
    {"coordinator", "env_steps", kGauge, "env steps", "of the run"},
    {"coordinator", "budget_env_steps", kGauge, "env steps", "the run ends after these"},
    {"coordinator", "actors", kGauge, "", "actors asked for"},
    {"coordinator", "stop_success", kGauge, "", "success rate at which the run ends"},
    {"coordinator", "stop_evaluations", kGauge, "", "newest evaluations pooled for it"},
    {"coordinator", "usable_cores", kGauge, "cores", "that the coordinator may use"},
    {"coordinator", "env_steps_per_second", kGauge, "env steps/s",
     "of all actors together, over the last half minute"},
    {"coordinator", "updates_per_second", kGauge, "updates/s",
     "of the learner, over the last half minute"},
    {"coordinator", "seconds_left", kGauge, "s",
     "until the budget is spent, at the pace of the last two minutes"},
    {"coordinator", "rollout_success", kGauge, "", "success rate of the actors' latest episodes"},
    {"coordinator", "rollout_return", kGauge, "", "their mean return, unscaled"},
    {"coordinator", "limiter_blocked_insert_share", kGauge, "",
     "the share of the last half minute in which the limiter held the actors"},
    {"coordinator", "limiter_blocked_sample_share", kGauge, "", "the same for the learner"},
    {"coordinator", "recent", kPerStage, "",
     "the share of the last half minute that a role spent in a stage; not in metrics.jsonl"},
    {"coordinator", "recent_cores", kGauge, "cores",
     "used by all processes over the last half minute; not in metrics.jsonl"},
    {"coordinator", "actors_elsewhere", kGauge, "", "1: actors run on other hosts"},
    {"coordinator", "learner_threads", kGauge, "", "learner.threads in force"},
    {"coordinator", "most_threads", kGauge, "", "of the learner that have enough rows of a batch"},
    {"coordinator", "may_play_ahead", kGauge, "", "1: on policy with ppo.versions_ahead = 0"},
    {"coordinator", "last_evaluation_success", kGauge, "", "success rate of the last evaluation"},
    {"coordinator", "last_evaluation_return", kGauge, "", "its mean return, unscaled"},
    {"coordinator", "last_evaluation_return_std", kGauge, "",
     "the standard deviation of its returns"},
    {"coordinator", "last_evaluation_length", kGauge, "env steps",
     "the mean length of its episodes"},
    {"coordinator", "last_evaluation_episodes", kGauge, "", "played in it"},
    {"coordinator", "last_evaluation_env_steps", kGauge, "env steps", "when it was made"},
    {"coordinator", "best_evaluation_success", kGauge, "", "the same of the best evaluation"},
    {"coordinator", "best_evaluation_return", kGauge, "", ""},
    {"coordinator", "best_evaluation_return_std", kGauge, "", ""},
    {"coordinator", "best_evaluation_length", kGauge, "env steps", ""},
    {"coordinator", "best_evaluation_episodes", kGauge, "", ""},
    {"coordinator", "best_evaluation_env_steps", kGauge, "env steps", ""},
    {"coordinator", "processes", kGauge, "", "that run or are being restarted"},
    {"coordinator", "restarts", kCounter, "", "of processes, over the whole run"},
    {"coordinator", "actors_working", kGauge, "",
     "training actors that are not down after a death"},
    {"coordinator", "faulty_episodes", kCounter, "",
     "of the training actors: ended at a number that is not finite, over the whole run"},
    {"coordinator", "messages_dropped", kCounter, "",
     "reports that came faster than they were read"},
    {"coordinator", "metrics_lines_left_out", kCounter, "",
     "reports that metrics.jsonl leaves out to keep within its budget"},
    {"coordinator", "evaluations_repeated", kCounter, "",
     "that had been counted, or were overtaken"},
    {"coordinator", "evaluations_refused", kCounter, "", "that cannot be, or cannot be read"},
    {"coordinator", "reports_refused", kCounter, "",
     "in the name of another role than the sender's"},
    {"coordinator", "exit_code", kGauge, "", "of the run; in the last view only"},

    {"actor", "env_steps", kCounter, "env steps", "stepped"},
    {"actor", "env_steps_per_second", kGauge, "env steps/s", ""},
    {"actor", "made", kCounter, "records", "made, resets included"},
    {"actor", "outstanding", kGauge, "records", "made and not yet reported stored"},
    {"actor", "credit", kGauge, "records", "that may still be made and sent"},
    {"actor", "queue_age_seconds", kGauge, "s", "age of the oldest record not yet stored"},
    {"actor", "resends", kCounter, "records", "sent again"},
    {"actor", "write_timeouts", kCounter, "", "sends that the network did not take in time"},
    {"actor", "weights_refused", kCounter, "", "weights of another spec or with a wrong checksum"},
    {"actor", "weights_receiver", kGauge, "",
     "1: receives the weights, for its host or itself; 0: reads those of the one that does"},
    {"actor", "weights_update", kGauge, "updates", "of the weights that act"},
    {"actor", "physics", kStage, "s", "stepping Shoal's own worlds, resets included"},
    {"actor", "rendering", kStage, "s", "drawing their frames"},
    {"actor", "user_code", kStage, "s", "in reset and step of environments of the user's own"},
    {"actor", "conversion", kStage, "s",
     "Shoal's share of their steps: actions, observations and images converted"},
    {"actor", "inference", kStage, "s", "choosing actions"},
    {"actor", "publishing", kStage, "s", "handing records to the network"},
    {"actor", "waiting_credit", kStage, "s", "waiting until the replay lets it go on"},
    {"actor", "weights", kStage, "s",
     "taking new weights; in lockstep and on policy waiting for them"},
    {"actor", "episodes", kCounter, "", "ended, but those cut short to spread the resets"},
    {"actor", "rollout_success", kGauge, "", "success rate of its last 100 episodes"},
    {"actor", "rollout_return", kGauge, "", "their mean return, unscaled"},
    {"actor", "rollout_length", kGauge, "env steps", "their mean length"},
    {"actor", "rollout_final_distance", kGauge, "m", "their mean distance to the goal at the end"},
    {"actor", "faulty_episodes_diverged", kCounter, "",
     "ended because the simulation's state was not finite"},
    {"actor", "faulty_episodes_observation", kCounter, "",
     "ended because a number of the observation was not finite"},
    {"actor", "faulty_episodes_reward", kCounter, "", "ended because the reward was not finite"},

    {"eval", "evaluations", kCounter, "", "finished"},
    {"eval", "eval_env_steps", kCounter, "env steps", "stepped in them; not the run's"},
    {"eval", "evaluations_overtaken", kCounter, "", "points replaced before they were played"},
    {"eval", "weights_refused", kCounter, "", "as the actors'"},
    {"eval", "evaluating", kStage, "s", "playing episodes"},

    {"replay", "stored_records", kGauge, "records", "stored over the whole run"},
    {"replay", "stored_steps", kGauge, "env steps", "of these: the run's env steps"},
    {"replay", "stored_records_per_second", kGauge, "records/s", ""},
    {"replay", "sampleable", kGauge, "env steps", "that a batch may hold now"},
    {"replay", "sampled", kCounter, "", "batch elements drawn"},
    {"replay", "samples_per_second", kGauge, "1/s", "batch elements drawn"},
    {"replay", "relabelled", kCounter, "samples", "of these given a goal of hindsight"},
    {"replay", "relabelled_share", kGauge, "",
     "the share of these among the batch elements of the last interval"},
    {"replay", "zero_rewards", kCounter, "samples", "of reward 0: a sparse task's goal is reached"},
    {"replay", "zero_reward_share", kGauge, "",
     "the share of these among the batch elements of the last interval"},
    {"replay", "limiter_samples_per_insert", kGauge, "", "replay.samples_per_insert in force"},
    {"replay", "limiter_cursor", kGauge, "samples", "granted and not drawn; in ± half a band"},
    {"replay", "limiter_band", kGauge, "samples", ""},
    {"replay", "limiter_blocked_insert_seconds", kCounter, "s", "actors were held back"},
    {"replay", "limiter_blocked_insert_share", kGauge, "", "the share of the last interval"},
    {"replay", "limiter_blocked_sample_seconds", kCounter, "s", "the learner was held back"},
    {"replay", "limiter_blocked_sample_share", kGauge, "", "the share of the last interval"},
    {"replay", "budget_env_steps", kGauge, "env steps", "with these stored no credit is given"},
    {"replay", "actor_sessions", kGauge, "", "actors that ever sent records"},
    {"replay", "queue_depth", kGauge, "", "chunks and requests that wait to be dealt with"},
    {"replay", "queue_age_seconds", kGauge, "s", "longest wait of a chunk in the last interval"},
    {"replay", "requests_waiting", kGauge, "batches", "asked for and not answered"},
    {"replay", "slot_batches", kCounter, "batches", "drawn into shared memory, not sent"},
    {"replay", "slots_held", kGauge, "batches", "kept in shared memory for the learner"},
    {"replay", "gather_threads", kGauge, "", "that copy the frames of a batch"},
    {"replay", "redraws", kCounter, "", "steps drawn that could not be used"},
    {"replay", "duplicates", kCounter, "records", "that came again"},
    {"replay", "rejected", kCounter, "records", "malformed"},
    {"replay", "after_gap", kCounter, "records", "whose predecessor is not stored"},
    {"replay", "lost", kCounter, "records", "that an earlier server had in its memory"},
    {"replay", "cut_episodes", kCounter, "", "closed because the next record never came"},
    {"replay", "refused_chunks", kCounter, "",
     "of another spec, malformed, superseded or from the future"},
    {"replay", "ahead_chunks", kCounter, "", "that came before their predecessor"},
    {"replay", "refused_requests", kCounter, "", "that do not fit the run"},
    {"replay", "surplus_requests", kCounter, "", "beyond the learner's credits; it asks again"},
    {"replay", "stale_requests", kCounter, "", "of a learner that has been replaced"},
    {"replay", "repeated_batches", kCounter, "", "answered again"},
    {"replay", "batches_given_up", kCounter, "", "that no learner took"},
    {"replay", "pool_drops", kCounter, "", "chunks without a free buffer; they come again"},
    {"replay", "inserting", kStage, "s", "storing records"},
    {"replay", "sampling", kStage, "s", "drawing batches"},
    {"replay", "sending", kStage, "s", "sending batches, on a thread of its own"},
    {"replay", "idle", kStage, "s", "waiting for something to do"},
    {"replay", "policy_lag", kQuantiles, "updates",
     "done since the weights that acted, when a record is stored"},
    {"replay", "store_age_seconds", kQuantiles, "s", "from a record's making to its storing"},
    {"replay", "data_age_seconds", kQuantiles, "s", "from a step's making to its being drawn"},

    {"learner", "updates", kGauge, "updates", "over the whole run"},
    {"learner", "env_steps", kGauge, "env steps", "stored when the last batch was drawn"},
    {"learner", "updates_per_second", kGauge, "updates/s", ""},
    {"learner", "data_age_updates", kQuantiles, "updates",
     "done since the weights that chose a batch's actions"},
    {"learner", "waiting_data", kStage, "s", "waiting for batches"},
    {"learner", "forward", kStage, "s", "forward passes and losses"},
    {"learner", "backward", kStage, "s", "gradients"},
    {"learner", "optimiser", kStage, "s", "steps of the optimiser, targets, averages"},
    {"learner", "weights", kStage, "s", "publishing weights"},
    {"learner", "checkpoint", kStage, "s", "writing checkpoints"},
    {"learner", "rollouts_expected", kGauge, "environments",
     "on policy: whose rollouts the next update waits for"},
    {"learner", "rollouts_ready", kGauge, "environments", "on policy: of these with a rollout"},
    {"learner", "rollouts_late", kCounter, "", "on policy: that updates were made without"},
    {"learner", "rollouts_dropped", kCounter, "", "on policy: that no update was made of"},
    {"learner", "stored_records", kCounter, "records", "on policy: taken"},
    {"learner", "rejected", kCounter, "records", "on policy: malformed"},
    {"learner", "after_gap", kCounter, "records", "on policy: whose predecessor did not come"},
    {"learner", "lost", kCounter, "records", "on policy: that an earlier learner had taken"},
    {"learner", "duplicates", kCounter, "records", "on policy: that came again"},
    {"learner", "refused_chunks", kCounter, "",
     "on policy: of another spec, malformed, superseded or from the future"},
    {"learner", "pool_drops", kCounter, "",
     "on policy: chunks without a free buffer; they come again"},
    {"learner", "actor_sessions", kGauge, "", "on policy: actors that ever sent records"},
    {"learner", "requests_outstanding", kGauge, "batches", "asked for and not used"},
    {"learner", "batches_ready", kGauge, "batches", "of these arrived"},
    {"learner", "batches_shared", kGauge, "",
     "1: batches come through shared memory; 0: over the network"},
    {"learner", "samples_per_insert", kGauge, "", "replay.samples_per_insert in force"},
    {"learner", "budget_env_steps", kGauge, "env steps", "env_steps in force"},
    {"learner", "eval_interval", kGauge, "env steps", "eval.interval in force"},
    {"learner", "weights_period", kGauge, "updates", "learner.weights_period in force"},
    {"learner", "threads", kGauge, "", "learner.threads in force"},
    {"learner", "weights_sent", kCounter, "", "versions published"},
    {"learner", "weights_unsent", kCounter, "", "that the network did not take"},
    {"learner", "evaluations_overtaken", kCounter, "", "points replaced before they were sent"},
    {"learner", "checkpoints", kCounter, "", "written"},
    {"learner", "checkpoints_unwritten", kGauge, "",
     "that could not be written and are tried again"},
    {"learner", "eval_updates", kGauge, "updates", "of the last evaluation point"},
    {"learner", "drained", kGauge, "", "1 once draining is over"},
    {"learner", "resent_requests", kCounter, "", "asked again"},
    {"learner", "duplicate_parts", kCounter, "", "batches, or parts of them, that came twice"},
    {"learner", "unknown_parts", kCounter, "", "batches, or parts of them, of requests done with"},
    {"learner", "malformed_parts", kCounter, "", "of sizes or offsets no batch has"},
    {"learner", "refused_slots", kCounter, "",
     "that could not be opened or did not hold their batch; asked again"},
    {"learner", "dropped_answers", kCounter, "", "overtaken by another answer"},
    {"learner", "warnings", kCounter, "", "of training that runs but does not learn"},
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
