// SPDX-License-Identifier: Apache-2.0
#include "common/config/meant_key.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "common/config/config_keys.h"
#include "common/config/former_keys.h"

namespace shoal {
namespace {

struct Names {
  std::string_view key;  // empty: Shoal has no such key
  std::vector<std::string_view> words;
  std::string_view note = {};  // not empty: the key differs, so it is only suggested
};

// Words of other programs, with '_'.
const std::vector<Names>& Table() {
  static const std::vector<Names> table{
      {"env_steps",
       {"steps", "total_timesteps", "total_steps", "timesteps", "n_timesteps", "max_steps",
        "num_train_steps", "num_train_frames", "num_env_steps", "total_env_steps"}},
      {"task", {"env", "env_id", "env_name", "environment", "task_name"}},
      {"run_name", {"name", "exp_name", "experiment_name", "run_id"}},
      {"run_dir", {"log_dir", "logdir", "log_path", "save_dir", "work_dir", "output_dir"}},
      {"actors", {"n_actors", "num_actors", "workers", "n_workers", "num_workers"}},
      {"envs_per_actor",
       {"n_envs", "num_envs"},
       "which counts the environments of each actor, not of all"},
      {"observation.stack", {"frame_stack", "framestack", "n_stack", "num_stack"}},
      {"observation.height", {"image_size", "img_size", "resolution"}, "with observation.width"},
      {"replay.capacity",
       {"buffer_size", "replay_size", "memory_size", "replay_buffer_size", "buffer_capacity",
        "replay_buffer_capacity", "replay_capacity"}},
      {"replay.min_size", {"learning_starts", "warmup_steps", "num_seed_steps", "seed_steps"}},
      {"replay.samples_per_insert",
       {"train_freq", "gradient_steps", "replay_ratio", "utd", "utd_ratio", "updates_per_step"},
       "batch elements sampled per env step: updates per env step times learner.batch"},
      {"replay.shift_pad", {"image_pad", "aug_pad"}},
      {"replay.n_step", {"nstep"}},
      {"replay.hindsight", {"her", "goal_selection_strategy"}},
      {"replay.hindsight_goals", {"n_sampled_goal"}},
      {"learner.algorithm", {"algo", "alg", "agent"}},
      {"learner.batch", {"batch_size", "minibatch_size"}},
      {"learner.threads", {"threads", "n_threads", "num_threads", "torch_threads"}},
      {"learner.learning_rate", {"lr"}},
      {"learner.actor_learning_rate", {"actor_lr", "policy_lr"}},
      {"learner.critic_learning_rate", {"critic_lr", "q_lr"}},
      {"sac.temperature_learning_rate", {"alpha_lr"}},
      {"learner.discount", {"gamma", "discount_factor"}},
      {"learner.actor_period", {"policy_delay", "policy_frequency", "actor_update_freq"}},
      {"learner.target_period",
       {"target_update_interval", "target_network_frequency", "critic_target_update_freq"}},
      {"sac.initial_temperature",
       {"ent_coef", "alpha", "entropy_coef"},
       "with sac.temperature = auto or fixed; on policy it is ppo.entropy_weight"},
      {"sac.initial_temperature", {"init_temperature", "init_alpha"}},
      {"learner.normalise_vectors",
       {"normalize", "normalise", "norm_obs", "normalize_observations"}},
      {"learner.checkpoint_period",
       {"save_freq", "save_interval", "checkpoint_freq", "checkpoint_interval"},
       "which counts updates"},
      {"ppo.rollout_steps", {"n_steps", "rollout_length", "num_rollout_steps"}},
      {"ppo.epochs", {"n_epochs", "num_epochs", "update_epochs"}},
      {"ppo.clip", {"clip_range", "clip_coef", "clip_ratio"}},
      {"ppo.value_clip", {"clip_range_vf"}},
      {"ppo.value_weight", {"vf_coef"}},
      {"exploration.sigma", {"action_noise", "noise_std", "exploration_noise"}},
      {"drqv2.noise", {"stddev_schedule"}},
      {"drqv2.noise_clip", {"stddev_clip"}},
      {"exploration.random_steps", {"start_steps"}},
      {"network.hidden",
       {"net_arch", "hidden_sizes", "hidden_size", "hidden_dim", "hidden_layers", "hidden_units"}},
      {"network.features", {"features_dim", "feature_dim"}},
      {"network.encoder", {"features_extractor", "features_extractor_class", "cnn"}},
      {"eval.interval", {"eval_freq", "eval_every", "eval_frequency", "eval_interval"}},
      {"eval.episodes", {"n_eval_episodes", "num_eval_episodes", "eval_episodes"}},
      {"", {"num_steps"}, "it is env_steps, the budget, or ppo.rollout_steps"},
      {"", {"policy", "policy_kwargs"}, "networks are described by network.* and observation.*"},
      {"learner.device", {"device"}},
      {"", {"gpu", "cuda", "gpus", "num_gpus"}, "a GPU is chosen by learner.device=cuda"},
      {"",
       {"tensorboard", "tensorboard_log", "track", "wandb"},
       "each run writes TensorBoard's files into RUN/tensorboard"},
      {"", {"deterministic"}, "--lockstep repeats a run bit for bit"},
      {"", {"load", "checkpoint", "pretrained"}, "it is --resume RUN or --init-from FILE"},
      {"", {"verbose"}, "there is one level of output; logs are in RUN/logs"},
  };
  return table;
}

std::string Normalised(std::string_view word) {
  std::string text(word);
  std::ranges::transform(text, text.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return text;
}

std::string_view LastWord(std::string_view path) {
  const size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

// The path that is `word`, or the only path that ends with `word`. Empty if there is none.
std::string_view OwnKey(const std::string& word) {
  std::string_view found;
  int matches = 0;
  for (const internal::Key& key : internal::Keys()) {
    if (key.path == word) return key.path;
    if (LastWord(key.path) != word) continue;
    found = key.path;
    ++matches;
  }
  return matches == 1 ? found : "";
}

}  // namespace

MeantKey FindMeantKey(std::string_view word) {
  const std::string text = Normalised(word);
  // The note about a former name is printed when the key is applied.
  if (PresentName(text) != text) return {.key = text, .note = "", .same = true};
  if (const std::string_view own = OwnKey(text); !own.empty()) {
    return {.key = std::string(own), .note = "", .same = true};
  }
  for (const Names& names : Table()) {
    // Only the last word is compared, because users guess the section.
    if (std::ranges::count(names.words, LastWord(text)) == 0) continue;
    return {.key = std::string(names.key),
            .note = std::string(names.note),
            .same = !names.key.empty() && names.note.empty()};
  }
  return {};
}

}  // namespace shoal
