// SPDX-License-Identifier: Apache-2.0
// The resolved configuration of a run. The initial values of the members are the defaults. Each
// section of keys is one struct. The name of a key is the dotted path of its member
// ("learner.batch"). config_keys.cpp lists all keys; docs/configuration.md is generated from this
// list.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config/algorithm_config.h"
#include "common/config/schedule.h"
#include "common/config/state_blocks.h"

namespace shoal {

// A user-defined camera, which looks at the point `lookat` from `distance`. With azimuth 0 the
// camera looks along +x, with azimuth 90 along +y, and with a negative elevation down.
struct CustomCamera {
  std::array<double, 3> lookat{};  // m
  double distance = 1;             // m
  double azimuth = 0;              // degrees
  double elevation = 0;            // degrees
  std::string body = {};           // body whose frame the numbers use; empty = the world's frame

  bool operator==(const CustomCamera&) const = default;
};

struct ObservationConfig {
  bool pixels = true;
  std::vector<std::string> cameras{"front", "side"};
  bool grey = false;
  int height = 84, width = 84;
  int stack = 1;
  std::string goal_mode = "none";  // none | desired | both: goal vectors among the blocks
  StateBlocks proprioception = false;
  std::string quality = "fast";                        // fast | native | reference
  std::map<std::string, CustomCamera> custom_cameras;  // by name, in addition to the task's cameras
};

// Named arguments of a user's function, as a JSON object.
struct KeywordArguments {
  std::string json = "{}";
};

// An environment that is not one of Shoal's worlds.
struct EnvConfig {
  std::string id;            // "Pendulum-v1", "module:Name", "/folder/file.py:Name"; empty = none
  KeywordArguments kwargs;   // arguments of the environment's constructor
  std::string python;        // path of the interpreter; empty = chosen when the run starts
  std::string folder;        // search folder for modules; empty = the folder of the run's start
  double step_timeout = 20;  // s, for one call of reset, step or render
};

// Physical quantities drawn anew for every episode, uniformly in [low, high].
struct RandomizationConfig {
  // Name of a body -> [low, high] in kg; empty = masses of the model.
  std::map<std::string, std::array<double, 2>> body_mass;
};

struct ReplayConfig {
  int64_t capacity = 100'000;  // records
  int64_t min_size = 1'000;    // sampleable transitions before the first batch
  // Batch elements sampled per sampleable transition, over the run's env steps; 0 = no limit.
  Schedule samples_per_insert = Schedule::Constant(64);
  double band = 0;                  // width of the limiter's band in samples; 0 = computed
  std::string storage = "file";     // file | memory
  bool keep = false;                // keep the file after the run has finished
  int shift_pad = 4;                // DrQ shift in pixels; 0 = no shift
  int copies = 1;                   // batch elements per drawn transition, each shifted anew
  int target_shifts = 0;            // number of copies with an own shift of the next frame; 0 = all
  int critic_shifts = 0;            // number of copies with an own shift of the frame; 0 = all
  int n_step = 1;                   // steps whose rewards are summed before the next value
  std::string hindsight = "none";   // none | future | final | episode: source of hindsight goals
  int hindsight_goals = 4;          // N; a share N / (N + 1) of the samples is relabelled
  double movement_share = 0;        // share of samples drawn by remaining motion of achieved goals
  std::string movement = "path";    // path | displacement: measure of the remaining motion
  std::string priorities = "none";  // none | proportional | lap: how samples are prioritised
  double priority_exponent = 0.6;   // power of a sample's priority in its probability
  // proportional: power of the importance weights, over the run's env steps; 0 = no weights.
  Schedule priority_correction = Schedule::Constant(0.4);
  int window_chunks = 4;  // most unacknowledged chunks of an actor
  int threads = 0;        // threads that copy a batch's frames; 0 = chosen from the load
};

struct LearnerConfig {
  std::string algorithm = "sac";  // common/config/algorithm_kind.h
  int batch = 128;
  std::string device = "cpu";      // cpu | cuda | auto: processor that computes the updates
  std::string precision = "auto";  // auto | f32 | bf16
  int threads = 0;                 // 0 = chosen as in common/config/learner_threads.h
  double learning_rate = 5e-4;
  double actor_learning_rate = 0, critic_learning_rate = 0;  // 0 = learning_rate
  Schedule rate_factor = Schedule::Constant(1);              // multiplies all learning rates
  double max_grad_norm = 0;  // limit for actor gradients and for critic gradients; 0 = no limit
  double discount = 0.9;
  double reward_scale = 10;
  double tau = 0.01;  // target heads: target += tau * (online - target)
  // Evaluated policy: average += average_rate * (policy - average); 1 = no averaging.
  double average_rate = 0.005;
  int actor_period = 2;  // actor and temperature are trained in every actor_period-th update
  int target_period = 1;
  double mean_penalty = 0;  // deterministic policy: weight of its squared outputs before tanh
  bool normalise_vectors = false;  // scale observed vectors by running mean and deviation
  double variance_floor = 0;       // smallest variance that normalise_vectors uses
  bool bounded_targets = false;    // clip targets to the range that rewards of -1 and 0 allow
  int weights_period = 20;         // updates between broadcasts of the weights
  int request_credits = 3;         // batches that the learner requests in advance
  int checkpoint_period = 2'000;   // updates between checkpoints
};

// Noise that training actors add to their policy's actions (actor/acting/exploration.h).
struct ExplorationConfig {
  std::string kind = "auto";                 // auto | squashed_gaussian | gaussian | ou
  Schedule sigma = Schedule::Constant(0.1);  // deviation of gaussian and ou noise
  double theta = 0.15;                       // ou: rate of return towards zero, per unit of time
  double dt = 0.01;                          // ou: units of time per env step
  int64_t random_steps = 0;                  // first env steps of the run, with random actions
  double random_share = 0;                   // share of the other env steps, with random actions
  double spread = 1;  // each actor scales the noise by its own factor in 1 / spread .. spread
};

struct NetworkConfig {
  std::string encoder = "compact";  // kind of encoder (common/nn/encoders/encoder_kind.h)
  std::string encoder_weights;      // safetensors file with initial weights; empty = random weights
  std::string encoders = "shared";  // shared | separate: encoders of actor and critic
  bool target_encoder = false;      // whether the target critic has a target encoder
  // Keys of the compact encoder only; 0 and [] = the encoder's own values.
  int pool = 0;  // average pooling of the input; 1 = no pooling
  std::vector<int> filters, strides;
  std::string trunk = "auto";                 // auto = the encoder's own | tanh | relu | elu
  int features = 0;                           // outputs of the trunk; 0 = the encoder's own
  std::vector<int> state_hidden;              // layers from observation to latent state (mrq)
  std::vector<int> hidden{256, 256};          // MLPs of actor and critics
  int blocks = 0;                             // residual blocks of the MLPs
  bool layer_norm = true;                     // after each hidden layer of the MLPs
  std::string activation = "relu";            // relu | tanh | elu: activation of the hidden layers
  std::string log_std = "smooth";             // smooth | clamped: method that bounds the deviation
  std::string initialisation = "orthogonal";  // orthogonal | pytorch
};

struct EvalConfig {
  int episodes = 50;
  int64_t interval = 2'500;  // env steps between evaluations
  int final_episodes = 100;
  int envs = 4;  // environments that the evaluation actor steps together
};

struct StopConfig {
  // The run stops if the newest `evaluations` evaluations together have at least this success rate;
  // > 1 = never.
  double success = 0.98;
  int evaluations = 2;
  int without_actors = 300;  // s; the run ends after this time without a working training actor
};

struct TransportConfig {
  std::string interface = "lo";  // name or address; auto = the interface towards the servers
  int fragment_bytes = 65'000;   // use 8000 if the network's MTU is 1500
  int chunk_records = 24;        // most records per chunk; fewer if 24 records exceed 1 MiB
  int flush_ms = 100;            // a partial chunk is sent after this time
};

inline constexpr uint32_t kMostActors = 1024;  // limit for a run, on all its hosts together

struct Config {
  std::string preset;
  int64_t seed = 1;
  std::string run_name;  // empty = PRESET-sSEED
  std::string run_dir = "runs";
  std::string task = "FetchReachDense";
  std::string task_library;       // shared object with the user's tasks; empty = no such tasks
  double distance_threshold = 0;  // for success and sparse reward, m; 0 = the task's own
  int64_t env_steps = 100'000;    // budget
  int actors = 0;                 // 0 = one for each core that the learner does not use, at least 1
  int envs_per_actor = 4;
  bool lockstep = false;
  int lockstep_steps = 8;           // lockstep: vector steps between two changes of the weights
  std::string model;                // path of another MJCF file for the task; empty = Shoal's file
  std::string physics = "mujoco2";  // mujoco2 | mujoco3: MuJoCo version of the Fetch weld
  int action_repeat = 0;            // control steps per env step; 0 = the task's own
  bool end_on_success = false;      // the step that reaches the goal terminates the episode
  // The run ends if the share of faulty episodes among an actor's last 200 episodes is higher.
  double max_faulty_share = 0.05;
  EnvConfig env;
  ObservationConfig observation;
  RandomizationConfig randomization;
  ReplayConfig replay;
  LearnerConfig learner;
  SacConfig sac;
  PpoConfig ppo;
  Td3Config td3;
  Drqv2Config drqv2;
  MrqConfig mrq;
  ExplorationConfig exploration;
  NetworkConfig network;
  EvalConfig eval;
  StopConfig stop;
  TransportConfig transport;
};

}  // namespace shoal
