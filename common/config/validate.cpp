// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/config/algorithm_kind.h"
#include "common/config/config_io.h"
#include "common/config/exploration_kind.h"
#include "common/config/on_policy.h"
#include "common/config/priorities.h"
#include "common/config/sequences.h"

namespace shoal {
namespace {

constexpr int64_t kMaxFrameBytes = 1'000'000;  // a record must fit one DDS sample

void ValidateObservation(const ObservationConfig& observation) {
  if (!observation.pixels && observation.goal_mode == "none" && !observation.proprioception) {
    throw UsageError(
        "observation.pixels = false, goal_mode = none, proprioception = false: nothing to observe");
  }
  if (!observation.pixels && observation.goal_mode == "image") {
    throw UsageError(
        "observation.goal_mode = image without observation.pixels: expected pixels, or none, "
        "desired or both");
  }
  if (!observation.pixels) return;
  if (observation.cameras.empty()) {
    throw UsageError("observation.cameras = []: expected at least one camera (or pixels = false)");
  }
  std::set<std::string> seen;
  for (const std::string& camera : observation.cameras) {
    if (camera.empty()) throw UsageError("observation.cameras: a camera's name is empty");
    if (!seen.insert(camera).second) {
      throw UsageError("observation.cameras: '{}' is listed twice", camera);
    }
  }
  const int64_t channels =
      static_cast<int64_t>(observation.cameras.size()) * (observation.grey ? 1 : 3);
  const int64_t bytes = channels * observation.height * observation.width;
  if (bytes > kMaxFrameBytes) {
    throw UsageError(
        "observation: a frame of {} channels at {}x{} has {} bytes, at most {} allowed", channels,
        observation.height, observation.width, bytes, kMaxFrameBytes);
  }
}

void ValidateVectors(const Config& config) {
  const ObservationConfig& observation = config.observation;
  const bool no_goal = observation.goal_mode == "none" || observation.goal_mode == "image";
  if (config.learner.normalise_vectors && !observation.proprioception && no_goal) {
    throw UsageError(
        "learner.normalise_vectors = true: the run observes pixels alone, expected false");
  }
  if (config.learner.variance_floor > 0 && !config.learner.normalise_vectors) {
    throw UsageError(
        "learner.variance_floor = {} without learner.normalise_vectors: expected it unset",
        config.learner.variance_floor);
  }
}

// Refuses noise keys that the run's exploration does not use.
void RefuseNoiseKeys(const Config& config) {
  const ExplorationConfig &exploration = config.exploration, usual;
  const ExplorationKind kind = ExplorationKindOf(config);
  const bool is_ou = kind == ExplorationKind::kOrnsteinUhlenbeck;
  const bool adds_noise = is_ou || kind == ExplorationKind::kGaussian;
  struct NoiseKey {
    const char* name;
    bool is_set, fits;
    const char* kinds;  // kinds of exploration that use the key
  };
  const NoiseKey keys[] = {
      {"exploration.sigma", exploration.sigma != usual.sigma, adds_noise, "gaussian | ou"},
      {"exploration.theta", exploration.theta != usual.theta, is_ou, "ou"},
      {"exploration.dt", exploration.dt != usual.dt, is_ou, "ou"}};
  for (const auto& [name, is_set, fits, kinds] : keys) {
    if (!is_set || fits) continue;
    throw UsageError(
        "{}: actors explore by {} (exploration.kind = {}, learner.algorithm = {}), which does not "
        "take it; expected it unset, or exploration.kind = {}",
        name, NameOf(kind), exploration.kind, config.learner.algorithm, kinds);
  }
}

void ValidateExploration(const Config& config) {
  const ExplorationConfig& exploration = config.exploration;
  if (exploration.kind == "squashed_gaussian" && !LearnsDeviation(config)) {
    throw UsageError(
        "exploration.kind = squashed_gaussian: the policy of learner.algorithm = {} has no "
        "deviation of its own; expected auto | gaussian | ou",
        config.learner.algorithm);
  }
  const AlgorithmKind& algorithm = AlgorithmKindOf(config);
  if (algorithm.own_noise != nullptr && exploration.sigma != ExplorationConfig().sigma) {
    throw UsageError(
        "exploration.sigma: the actors of learner.algorithm = {} explore with the noise of "
        "{}noise; expected it unset",
        algorithm.name, algorithm.own_section);
  }
  RefuseNoiseKeys(config);
  if (exploration.theta * exploration.dt > 1) {
    throw UsageError(
        "exploration.theta = {}, exploration.dt = {}: expected a product of at most 1, else the "
        "noise overshoots zero in each step",
        exploration.theta, exploration.dt);
  }
}

// Checks the keys of a policy with a deviation and of its entropy. Algorithms without section sac
// have defaults here.
void ValidateEntropy(const Config& config) {
  const Config usual;
  if (config.sac.temperature == "fixed" && config.sac.min_temperature > 0) {
    throw UsageError("sac.min_temperature = {} with sac.temperature = fixed: expected 0",
                     config.sac.min_temperature);
  }
  if (config.sac.min_temperature > config.sac.initial_temperature) {
    throw UsageError("sac.min_temperature = {}: expected at most sac.initial_temperature = {}",
                     config.sac.min_temperature, config.sac.initial_temperature);
  }
  const bool per_action =
      config.sac.target_entropy_per_action != usual.sac.target_entropy_per_action;
  if (config.sac.target_entropy != usual.sac.target_entropy && per_action) {
    throw UsageError(
        "sac.target_entropy = {}, sac.target_entropy_per_action = {}: both set the target of the "
        "temperature; expected one of them unset",
        config.sac.target_entropy, config.sac.target_entropy_per_action);
  }
  if (LearnsDeviation(config) && config.learner.mean_penalty > 0) {
    throw UsageError(
        "learner.mean_penalty = {}: it belongs to a deterministic policy, and that of "
        "learner.algorithm = {} is a Gaussian; expected 0",
        config.learner.mean_penalty, config.learner.algorithm);
  }
  if (!LearnsDeviation(config) && config.network.log_std != usual.network.log_std) {
    throw UsageError(
        "network.log_std: the policy of learner.algorithm = {} has no deviation; expected it unset",
        config.learner.algorithm);
  }
}

// Refuses keys that only the compact encoder uses.
void ValidateCompact(const NetworkConfig& network) {
  if (network.encoder == "compact") return;
  const char* key = network.pool != 0          ? "network.pool"
                    : !network.filters.empty() ? "network.filters"
                    : !network.strides.empty() ? "network.strides"
                                               : nullptr;
  if (key == nullptr) return;
  throw UsageError("{} belongs to network.encoder = compact: expected not to be set beside {}", key,
                   network.encoder);
}

// Checks the layers of residual blocks.
void ValidateBlocks(const NetworkConfig& network) {
  if (network.blocks == 0) return;
  if (network.hidden.size() != 1) {
    throw UsageError(
        "network.hidden: with network.blocks = {}, all blocks have one width; expected one number, "
        "for example [256]",
        network.blocks);
  }
  if (!network.layer_norm) {
    throw UsageError(
        "network.layer_norm = false: residual blocks have a LayerNorm; expected true "
        "with network.blocks = {}",
        network.blocks);
  }
}

// Checks the keys of encoders besides the critic's.
void ValidateEncoders(const Config& config) {
  const NetworkConfig usual;
  const std::pair<const char*, bool> keys[] = {
      {"network.encoders", config.network.encoders != usual.encoders},
      {"network.target_encoder", config.network.target_encoder != usual.target_encoder}};
  for (const auto& [key, is_set] : keys) {
    if (!is_set) continue;
    if (!AlgorithmKindOf(config).encoder_options) {
      throw UsageError("{}: learner.algorithm = {} has one encoder; expected it unset, or {}", key,
                       config.learner.algorithm,
                       AlgorithmsThat([](const auto& kind) { return kind.encoder_options; }));
    }
    if (!config.observation.pixels) {
      throw UsageError("{}: nothing is encoded without observation.pixels; expected it unset", key);
    }
  }
}

// Checks the ensemble of critics. Algorithms without this ensemble have defaults here.
void ValidateCritics(const Config& config) {
  if (config.sac.target_critics > config.sac.critics) {
    throw UsageError("sac.target_critics = {}: expected at most sac.critics = {}, or 0 for all",
                     config.sac.target_critics, config.sac.critics);
  }
}

// Checks critics that compute quantiles.
void ValidateQuantiles(const Config& config) {
  if (config.sac.quantiles == 0) {
    if (config.sac.dropped_quantiles == Config().sac.dropped_quantiles) return;
    throw UsageError("sac.dropped_quantiles = {}: expected it unset without sac.quantiles",
                     config.sac.dropped_quantiles);
  }
  if (config.sac.dropped_quantiles >= config.sac.quantiles) {
    throw UsageError("sac.dropped_quantiles = {}: expected less than sac.quantiles = {}",
                     config.sac.dropped_quantiles, config.sac.quantiles);
  }
  const std::pair<const char*, bool> others[] = {
      {"sac.target_critics", config.sac.target_critics != 0},
      {"replay.copies", config.replay.copies != 1},
      {"replay.priorities", HasPriorities(config.replay)}};
  for (const auto& [key, is_set] : others) {
    if (is_set) throw UsageError("{}: expected it unset with sac.quantiles", key);
  }
}

// Checks privileged inputs. PrivilegedBlocksOf checks whether the task records them.
void ValidatePrivileged(const Config& config) {
  if (!config.sac.aux.empty() && !config.observation.pixels) {
    throw UsageError("sac.aux: nothing is encoded without observation.pixels; expected it unset");
  }
  if (config.sac.aux.empty() && config.sac.aux_weight != Config().sac.aux_weight) {
    throw UsageError("sac.aux_weight = {}: expected it unset without sac.aux",
                     config.sac.aux_weight);
  }
  if (!config.sac.critic_blocks) return;
  if (config.network.encoders == "separate" || config.network.target_encoder) {
    throw UsageError("{}: with sac.critic_blocks the critic has no encoder; expected it unset",
                     config.network.target_encoder ? "network.target_encoder" : "network.encoders");
  }
}

// Checks DrQ's K and M if they differ from the number of a transition's copies.
void ValidateShifts(const Config& config) {
  const ReplayConfig& replay = config.replay;
  const std::pair<const char*, int> keys[] = {{"replay.target_shifts", replay.target_shifts},
                                              {"replay.critic_shifts", replay.critic_shifts}};
  for (const auto& [key, shifts] : keys) {
    if (shifts == 0) continue;
    if (!config.observation.pixels || replay.shift_pad == 0) {
      throw UsageError("{} = {}: nothing is shifted without {}; expected it unset", key, shifts,
                       config.observation.pixels ? "replay.shift_pad" : "observation.pixels");
    }
    if (replay.copies % shifts != 0) {
      throw UsageError("{} = {}: expected a divisor of replay.copies = {}, or 0", key, shifts,
                       replay.copies);
    }
  }
}

// A schedule that reaches 0 would say "no limit" at the very moment when all should stop.
void ValidateSamplesPerInsert(const Schedule& samples) {
  if (samples.constant() || samples.Least() > 0) return;
  throw UsageError(
      "replay.samples_per_insert = {}: expected both ends of a schedule above 0 (0 alone = no "
      "limit)",
      ScheduleText(samples));
}

// Checks the keys of prioritised sampling.
void ValidatePriorities(const Config& config) {
  const ReplayConfig &replay = config.replay, usual;
  const bool corrects = replay.priority_correction != usual.priority_correction;
  if (replay.priorities == "none") {
    if (replay.priority_exponent == usual.priority_exponent && !corrects) return;
    throw UsageError("{} without replay.priorities: expected it unset, or proportional{}",
                     corrects ? "replay.priority_correction" : "replay.priority_exponent",
                     corrects ? "" : " | lap");
  }
  if (!AlgorithmKindOf(config).priorities) {
    throw UsageError(
        "replay.priorities = {}: learner.algorithm = {} returns no errors of samples; expected "
        "none, or learner.algorithm = {}",
        replay.priorities, config.learner.algorithm,
        AlgorithmsThat([](const auto& kind) { return kind.priorities; }));
  }
  if (replay.priorities == "lap" && corrects) {
    throw UsageError(
        "replay.priority_correction with replay.priorities = lap, which has no importance weights: "
        "expected it unset");
  }
  if (replay.movement_share > 0) {
    throw UsageError(
        "replay.movement_share = {} with replay.priorities = {}: samples are drawn by one of them; "
        "expected 0, or replay.priorities = none",
        replay.movement_share, replay.priorities);
  }
}

void ValidateReplay(const Config& config) {
  ValidateSamplesPerInsert(config.replay.samples_per_insert);
  if (config.replay.min_size > config.replay.capacity / 2) {
    throw UsageError("replay.min_size = {}: expected at most half of replay.capacity = {}",
                     config.replay.min_size, config.replay.capacity);
  }
  const ObservationConfig& images = config.observation;
  if (images.pixels && config.replay.shift_pad * 2 >= std::min(images.height, images.width)) {
    throw UsageError(
        "replay.shift_pad = {}: expected less than half of the images' shorter side, "
        "observation.height = {}, observation.width = {}",
        config.replay.shift_pad, images.height, images.width);
  }
  if (config.learner.batch % config.replay.copies != 0) {
    throw UsageError("replay.copies = {}: expected a divisor of learner.batch = {}",
                     config.replay.copies, config.learner.batch);
  }
  ValidateShifts(config);
  if (config.replay.movement != ReplayConfig().movement && config.replay.movement_share == 0) {
    throw UsageError("replay.movement = {} with replay.movement_share = 0: expected it unset",
                     config.replay.movement);
  }
  ValidatePriorities(config);
}

}  // namespace

void Validate(const Config& config) {
  ValidateObservation(config.observation);
  ValidateOnPolicy(config);
  ValidateSequences(config);
  ValidateVectors(config);
  ValidateExploration(config);
  ValidateCompact(config.network);
  ValidateBlocks(config.network);
  if (!LearnsOnPolicy(config)) ValidateEntropy(config);
  if (config.run_dir.empty()) throw UsageError("run_dir = \"\": expected a folder");
  if (config.transport.interface.empty()) {
    throw UsageError("transport.interface = \"\": expected a network interface");
  }
  if (!LearnsOnPolicy(config)) {
    ValidateEncoders(config);
    ValidateCritics(config);
    ValidateQuantiles(config);
    ValidatePrivileged(config);
    ValidateReplay(config);
  }
  if (config.lockstep && config.actors > 1) {
    throw UsageError("actors = {}: lockstep takes one actor", config.actors);
  }
}

}  // namespace shoal
