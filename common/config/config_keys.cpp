// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_keys.h"

#include <limits>

#include "common/config/algorithm_kind.h"

namespace shoal::internal {
namespace {

constexpr int64_t kMaxInt64 = std::numeric_limits<int64_t>::max();
constexpr IntegerRange kSteps{1, 1'000'000'000'000};

// A key is spelled like its member. The table stores the member as a function from a Config.
#define SHOAL_KEY(member, range, text)                                                         \
  {                                                                                            \
    .path = #member, .slot = [](Config& c) -> Slot { return &c.member; }, .rule = Rule{range}, \
    .meaning = text                                                                            \
  }

std::vector<Key> RunKeys() {
  return {
      SHOAL_KEY(preset, FileName{true}, "preset the configuration started from"),
      SHOAL_KEY(seed, (IntegerRange{0, kMaxInt64}), "seed of every random stream"),
      SHOAL_KEY(run_name, FileName{true}, "name of the run's folder; empty = PRESET-sSEED"),
      SHOAL_KEY(run_dir, AnyValue{}, "folder that holds the runs"),
      SHOAL_KEY(task, FileName{}, "task to learn"),
      SHOAL_KEY(task_library, AnyValue{},
                "path of a shared object that defines further tasks; empty = none"),
      SHOAL_KEY(distance_threshold, (RealRange{0, 1000}),
                "distance in m below which a goal is reached; 0 = the task's own"),
      SHOAL_KEY(env_steps, kSteps, "budget: training stops after this many env steps"),
      SHOAL_KEY(
          actors, (IntegerRange{0, kMostActors}),
          "actor processes; 0 = chosen by the run: with learner.threads if the run divides its "
          "cores, else one for each core that the learner leaves, at least 1; in lockstep 1"),
      SHOAL_KEY(envs_per_actor, (IntegerRange{1, 256}), "environments stepped by one actor"),
      SHOAL_KEY(lockstep, AnyValue{},
                "one actor, fixed batches, weights at fixed steps: repeats bit for bit"),
      SHOAL_KEY(lockstep_steps, (IntegerRange{1, 100'000}),
                "vector steps between two weights versions in lockstep"),
      SHOAL_KEY(model, AnyValue{}, "path of another MJCF file for the task; empty = the built-in"),
      SHOAL_KEY(physics, (Choices{{"mujoco2", "mujoco3"}}),
                "Fetch: stiffness of the constraint that holds the arm's orientation, as in this "
                "version of MuJoCo"),
      SHOAL_KEY(action_repeat, (IntegerRange{0, 100}),
                "control steps for which an env step repeats its action and sums the rewards; 0 = "
                "the task's own number"),
      SHOAL_KEY(end_on_success, AnyValue{},
                "tasks with goals: the step that reaches the goal terminates the episode, in "
                "training and evaluation; its target does not bootstrap"),
      SHOAL_KEY(max_faulty_share, (RealRange{0, 1}),
                "largest share of faulty episodes (truncated because a number of the simulation is "
                "not finite) among an actor's last 200; a larger share ends the run; 0 = the first "
                "faulty episode ends it"),
  };
}

std::vector<Key> EnvKeys() {
  return {
      SHOAL_KEY(env.id, AnyValue{},
                "environment written in Python, used instead of a task: a name that gymnasium.make "
                "knows, MODULE:NAME or FILE.py:NAME (docs/own_environment.md); empty = none"),
      SHOAL_KEY(env.kwargs, AnyValue{}, "arguments of the environment's constructor"),
      SHOAL_KEY(env.python, AnyValue{},
                "path of the Python interpreter that runs the environment; empty = that of the "
                "active virtual environment, else python3"),
      SHOAL_KEY(env.folder, AnyValue{},
                "folder where the interpreter also searches for MODULE; empty = the folder where "
                "the run is started"),
      SHOAL_KEY(env.step_timeout, (RealRange{0, 3600, true}),
                "longest time in seconds of a call of reset, step or render; after it the actor "
                "ends and is restarted"),
  };
}

std::vector<Key> ObservationKeys() {
  return {
      SHOAL_KEY(observation.pixels, AnyValue{}, "render cameras"),
      SHOAL_KEY(
          observation.cameras, AnyValue{},
          "cameras of the task, of its model or of observation.custom_cameras, in channel order; a "
          "task that lacks one of the two default cameras uses its first camera instead"),
      SHOAL_KEY(observation.grey, AnyValue{}, "one grey channel per camera instead of RGB"),
      SHOAL_KEY(observation.height, (IntegerRange{8, 1024}), "image height in pixels"),
      SHOAL_KEY(observation.width, (IntegerRange{8, 1024}), "image width in pixels"),
      SHOAL_KEY(observation.stack, (IntegerRange{1, 16}), "frames per observation"),
      SHOAL_KEY(observation.goal_mode, (Choices{{"none", "desired", "both", "image"}}),
                "how the policy observes the goal: desired = as a vector; both = as the vectors of "
                "desired and achieved goal; image = as a picture of the goal reached, after the "
                "frames; none = not at all"),
      SHOAL_KEY(observation.proprioception, AnyValue{},
                "blocks of the task's state vector that the policy observes: true = all, false = "
                "none, or a list of names (shoal env describe lists them)"),
      SHOAL_KEY(observation.quality, (Choices{{"fast", "native", "reference"}}),
                "fast = no shadows, reflections, multisampling; native = as fast, drawn by a "
                "renderer without OpenGL; reference = the rendering of the originals"),
      SHOAL_KEY(observation.custom_cameras, AnyValue{},
                "further cameras for observation.cameras; in m and degrees, azimuth 0 looks along "
                "+x, negative elevation looks down; with `body`, the camera moves with that body, "
                "in its frame"),
  };
}

std::vector<Key> RandomizationKeys() {
  return {
      SHOAL_KEY(randomization.body_mass, (RealRange{0, 1e6, true}),
                "range of the mass of each named body in kg, drawn uniformly for each episode; {} "
                "= the masses of the model"),
  };
}

std::vector<Key> ReplayKeys() {
  return {
      SHOAL_KEY(replay.capacity, (IntegerRange{64, 1'000'000'000}), "records kept"),
      SHOAL_KEY(replay.min_size, (IntegerRange{1, 1'000'000'000}),
                "sampleable transitions before the first batch"),
      SHOAL_KEY(replay.samples_per_insert, (RealRange{0, 1e6}),
                "batch elements sampled per sampleable transition; a number (0 = no limit), or a "
                "schedule over the run's env steps"),
      SHOAL_KEY(replay.band, (RealRange{0, 1e12}),
                "width of the limiter's band in samples; 0 = computed"),
      SHOAL_KEY(replay.storage, (Choices{{"file", "memory"}}),
                "file = ring file in the run folder, which outlives the replay server; memory = "
                "anonymous memory, which is lost with it"),
      SHOAL_KEY(replay.keep, AnyValue{},
                "keep replay.ring when the run has finished; a run that was interrupted or failed "
                "keeps it in any case"),
      SHOAL_KEY(replay.shift_pad, (IntegerRange{0, 32}), "DrQ random shift in pixels; 0 = none"),
      SHOAL_KEY(replay.copies, (IntegerRange{1, 16}),
                "batch elements per drawn transition, each with its own random shift, all with one "
                "target; DrQ: 2"),
      SHOAL_KEY(replay.target_shifts, (IntegerRange{0, 16}),
                "DrQ's K: different shifts of the next frame among a transition's replay.copies, "
                "over which its target is averaged; 0 = as many as copies"),
      SHOAL_KEY(replay.critic_shifts, (IntegerRange{0, 16}),
                "DrQ's M: different shifts of the frame among a transition's replay.copies, over "
                "which the critic's loss is averaged; 0 = as many as copies"),
      SHOAL_KEY(replay.n_step, (IntegerRange{1, 20}),
                "number of steps, within an episode, whose rewards are summed before the value of "
                "the state that follows"),
      SHOAL_KEY(replay.hindsight, (Choices{{"none", "future", "final", "episode"}}),
                "source of the goals that replace those of samples: goals achieved in the same "
                "episode after the step (future), at its end (final) or anywhere (episode); for "
                "tasks with goals"),
      SHOAL_KEY(replay.hindsight_goals, (IntegerRange{0, 1000}),
                "N: a share N / (N + 1) of the samples gets another goal"),
      SHOAL_KEY(replay.movement_share, (RealRange{0, 1}),
                "achieved-goal displacement sampling, with hindsight: share of the samples that "
                "are drawn in proportion to the movement of the achieved goal in the rest of the "
                "episode; the others are drawn uniformly"),
      SHOAL_KEY(replay.movement, (Choices{{"path", "displacement"}}),
                "movement for replay.movement_share: path = sum of the distances of all steps to "
                "the episode's end; displacement = distance between the achieved goal before the "
                "step and at the episode's end"),
      SHOAL_KEY(
          replay.priorities, (Choices{{"none", "proportional", "lap"}}),
          "prioritised sampling by the critics' errors: proportional, with importance weights "
          "in the critic's loss; or lap, with a Huber loss; none = samples have no priorities"),
      SHOAL_KEY(replay.priority_exponent, (RealRange{0, 1}),
                "power of a sample's priority in its probability; 0 = uniform; with lap, its paper "
                "uses 0.4"),
      SHOAL_KEY(replay.priority_correction, (RealRange{0, 1}),
                "power of the importance weights with replay.priorities = proportional; a number "
                "(0 = no weights, 1 = full correction), or a schedule over the run's env steps"),
      SHOAL_KEY(replay.window_chunks, (IntegerRange{2, 1024}),
                "chunks an actor may have unacknowledged"),
      SHOAL_KEY(replay.threads, (IntegerRange{0, 1024}),
                "threads of the replay server that copy the frames of a batch; the bytes of a "
                "batch do not depend on their number; 0 = one, and more while they copy most of "
                "the time: up to one for every two cores, at most eight"),
  };
}

Choices AlgorithmChoices() {
  Choices choices;
  for (const AlgorithmKind& kind : AlgorithmKinds()) choices.words.push_back(kind.name);
  return choices;
}

std::vector<Key> LearnerKeys() {
  const RealRange positive{0, 1, true};
  return {
      SHOAL_KEY(learner.algorithm, AlgorithmChoices(), "learning algorithm: docs/algorithm.md"),
      SHOAL_KEY(learner.batch, (IntegerRange{1, 65'536}),
                "transitions per update; ppo: per minibatch"),
      SHOAL_KEY(learner.device, (Choices{{"cpu", "cuda", "auto"}}),
                "processor that computes the updates; cuda = an NVIDIA GPU of the learner's host "
                "(docs/gpu.md); auto = cuda if a GPU can be used, else cpu"),
      SHOAL_KEY(learner.precision, (Choices{{"auto", "f32", "bf16"}}),
                "arithmetic of the large products; auto = bf16 with pixels "
                "where the learner's CPU or GPU has it natively, else f32"),
      SHOAL_KEY(learner.threads, (IntegerRange{0, 1024}),
                "threads of the learner, each with a share of the batch's rows (ppo and encoders "
                "with batch normalisation: with a share of each layer); 0 = chosen by the run. "
                "From pixels on one host with at least four cores (except ppo and lockstep), the "
                "run measures at its beginning how to divide its cores between learner and actors. "
                "Otherwise the learner gets at most half of the cores that this process may use; "
                "three quarters if every eighth env step has an update, all if every env step has "
                "one; without pixels (except ppo and mrq) it gets 1"),
      SHOAL_KEY(learner.learning_rate, positive,
                "learning rate of Adam for actor, critic and temperature"),
      SHOAL_KEY(learner.actor_learning_rate, (RealRange{0, 1}),
                "learning rate of the actor; 0 = learner.learning_rate"),
      SHOAL_KEY(learner.critic_learning_rate, (RealRange{0, 1}),
                "learning rate of critic and encoder; 0 = learner.learning_rate"),
      SHOAL_KEY(learner.rate_factor, (RealRange{0, 1}),
                "factor on all learning rates; a number, or a schedule over the run's env steps"),
      SHOAL_KEY(learner.max_grad_norm, (RealRange{0, 1e6}),
                "largest Euclidean norm of the actor's gradients, and of those of critic and "
                "encoder together; larger gradients are scaled down; 0 = no limit"),
      SHOAL_KEY(learner.discount, (RealRange{0, 1, false, true}), "discount per env step"),
      SHOAL_KEY(learner.reward_scale, (RealRange{0, 1e6, true}), "factor on every reward"),
      SHOAL_KEY(learner.tau, positive, "target heads: target += tau * (online - target)"),
      SHOAL_KEY(
          learner.average_rate, positive,
          "evaluated policy, per update: average += rate * (policy - average); 1 = no average"),
      SHOAL_KEY(learner.actor_period, (IntegerRange{1, 1000}),
                "updates per actor and temperature update"),
      SHOAL_KEY(learner.target_period, (IntegerRange{1, 100'000}), "updates per target update"),
      SHOAL_KEY(learner.mean_penalty, (RealRange{0, 1e6}),
                "td3, ddpg, drqv2, mrq: weight, in the actor's loss, of the mean square of the "
                "outputs before tanh; it prevents actions from staying saturated"),
      SHOAL_KEY(learner.normalise_vectors, AnyValue{},
                "scale vectors by their running mean and deviation, which are stored with the "
                "policy; clipped at 10"),
      SHOAL_KEY(learner.variance_floor, (RealRange{0, 1}),
                "for learner.normalise_vectors: lower bound of the variance, so that nearly "
                "constant numbers are not magnified; 1e-4 = deviations of at least 0.01"),
      SHOAL_KEY(learner.bounded_targets, AnyValue{},
                "clip target values to the range that rewards of -1 and 0 allow"),
      SHOAL_KEY(learner.weights_period, (IntegerRange{1, 1'000'000}),
                "updates between weights broadcasts"),
      SHOAL_KEY(learner.request_credits, (IntegerRange{1, 64}), "batches requested ahead"),
      SHOAL_KEY(learner.checkpoint_period, (IntegerRange{1, 1'000'000'000}),
                "updates between checkpoints"),
  };
}

std::vector<Key> SacKeys() {
  return {
      SHOAL_KEY(sac.temperature, (Choices{{"auto", "fixed"}}),
                "auto = adapted to the target entropy; fixed = stays sac.initial_temperature"),
      SHOAL_KEY(sac.initial_temperature, (RealRange{0, 100, true}),
                "entropy temperature at the start"),
      SHOAL_KEY(sac.min_temperature, (RealRange{0, 100}),
                "lower bound of an automatic temperature"),
      SHOAL_KEY(sac.temperature_learning_rate, (RealRange{0, 1}),
                "learning rate of the temperature; 0 = learner.learning_rate"),
      SHOAL_KEY(sac.target_entropy, (RealRange{-1000, 1000}),
                "target entropy of an automatic temperature, in nats; 0 = "
                "sac.target_entropy_per_action times the action size"),
      SHOAL_KEY(sac.target_entropy_per_action, (RealRange{-100, 100}),
                "target entropy per action dimension, in nats, unless sac.target_entropy is "
                "set; 0 aims at 0 nats"),
      SHOAL_KEY(sac.critics, (IntegerRange{2, 16}), "number of critics, each with a target"),
      SHOAL_KEY(sac.target_critics, (IntegerRange{0, 16}),
                "number of target critics, drawn at random for each update, whose minimum is the "
                "target; at most sac.critics; 0 = all"),
      SHOAL_KEY(sac.actor_value, (Choices{{"min", "mean"}}),
                "value of an action in the actor's loss: min = the smallest value of the critics; "
                "mean = their mean"),
      SHOAL_KEY(sac.quantiles, (IntegerRange{0, 200}),
                "quantiles of the return that each critic computes; 0 = only the mean"),
      SHOAL_KEY(
          sac.dropped_quantiles, (IntegerRange{0, 199}),
          "for sac.quantiles: this number, times sac.critics, of the largest quantiles of all "
          "target critics are left out of the targets"),
      SHOAL_KEY(sac.critic_blocks, (AnyValue{}),
                "recorded blocks that the critic gets instead of pixels, in addition to the "
                "vectors that the policy observes: true = all, false = none (the critic gets the "
                "pixels), or a list of names"),
      SHOAL_KEY(sac.aux, (AnyValue{}),
                "quantities that the encoder's features are also trained to predict: recorded "
                "blocks or differences of two, as \"object\" or \"object-grip\"; [] = none"),
      SHOAL_KEY(sac.aux_weight, (RealRange{0, 1e6, true}),
                "weight of the auxiliary loss (sac.aux)"),
  };
}

std::vector<Key> PpoKeys() {
  return {
      SHOAL_KEY(ppo.rollout_steps, (IntegerRange{1, 1'000'000}),
                "env steps of each environment that one update learns from; at least 2, and over "
                "all environments a multiple of learner.batch"),
      SHOAL_KEY(ppo.epochs, (IntegerRange{1, 1000}), "passes over a rollout in one update"),
      SHOAL_KEY(ppo.clip, (RealRange{0, 10, true}),
                "the loss clips the probability ratio to 1 - clip .. 1 + clip; a number, or a "
                "schedule over the run's env steps"),
      SHOAL_KEY(ppo.value_clip, (RealRange{0, 1e6}),
                "largest change of a predicted value in one update; 0 = no limit"),
      SHOAL_KEY(ppo.gae_lambda, (RealRange{0, 1}),
                "lambda of generalised advantage estimation: 0 = one step, 1 = the whole rollout"),
      SHOAL_KEY(ppo.entropy_weight, (RealRange{0, 100}),
                "weight of the policy's entropy in the loss"),
      SHOAL_KEY(ppo.value_weight, (RealRange{0, 1e6}),
                "weight of the squared value error in the loss"),
      SHOAL_KEY(ppo.target_kl, (RealRange{0, 1e6}),
                "an update ends early when the KL divergence from the policy before the update "
                "exceeds 1.5 times this value; 0 = never"),
      SHOAL_KEY(ppo.normalise_advantages, AnyValue{},
                "advantages of a minibatch get mean 0 and deviation 1"),
      SHOAL_KEY(ppo.normalise_rewards, AnyValue{},
                "rewards are divided by the running deviation of discounted returns; cut off at "
                "10"),
      SHOAL_KEY(ppo.networks, (Choices{{"separate", "shared"}}),
                "separate = one network each for policy and value; shared = one network with two "
                "outputs"),
      SHOAL_KEY(ppo.initial_log_std, (RealRange{-20, 2}),
                "log deviation of the policy before the first update"),
      SHOAL_KEY(ppo.versions_ahead, (IntegerRange{0, 1}),
                "0 = an actor waits for the weights that follow its rollout; 1 = it plays the next "
                "rollout meanwhile"),
      SHOAL_KEY(ppo.rollout_deadline, (RealRange{0.1, 60}),
                "time in seconds that an update waits for missing rollouts after its first one has "
                "arrived; then it starts with at least half of the rollouts (after three times as "
                "long, with any number), and always at least learner.batch steps"),
  };
}

std::vector<Key> Td3Keys() {
  return {
      SHOAL_KEY(td3.target_noise, (RealRange{0, 2}),
                "standard deviation of the noise on a target's action; 0 = none"),
      SHOAL_KEY(td3.target_noise_clip, (RealRange{0, 2}), "largest absolute value of that noise"),
  };
}

std::vector<Key> MrqKeys() {
  const RealRange positive{0, 1, true};
  return {
      SHOAL_KEY(mrq.horizon, (IntegerRange{1, 20}), "steps that the model predicts in an update"),
      SHOAL_KEY(mrq.period, (IntegerRange{1, 100'000}),
                "updates after which policy and critics get a copy of the trained encoder, and the "
                "targets one of policy, critics and encoder"),
      SHOAL_KEY(mrq.encoder_learning_rate, positive, "learning rate of encoder and model"),
      SHOAL_KEY(mrq.reward_weight, (RealRange{0, 1e3}),
                "weight of the predicted rewards in the model's loss"),
      SHOAL_KEY(mrq.end_weight, (RealRange{0, 1e3}),
                "weight of the predicted ends of episodes in the model's loss"),
      SHOAL_KEY(mrq.target_noise, (RealRange{0, 2}),
                "standard deviation of the noise on a target's action; 0 = none"),
      SHOAL_KEY(mrq.target_noise_clip, (RealRange{0, 2}), "largest absolute value of that noise"),
  };
}

std::vector<Key> Drqv2Keys() {
  return {
      SHOAL_KEY(drqv2.noise, (RealRange{0, 2}),
                "standard deviation of the noise on the actions of targets, of the actor's loss "
                "and of the training actors; a number, or a schedule over the run's env steps"),
      SHOAL_KEY(drqv2.noise_clip, (RealRange{0, 2}),
                "largest absolute value of that noise in targets and in the actor's loss; the "
                "noise of the training actors has no such limit"),
  };
}

std::vector<Key> ExplorationKeys() {
  return {
      SHOAL_KEY(exploration.kind, (Choices{{"auto", "squashed_gaussian", "gaussian", "ou"}}),
                "noise of the training actors; auto = the algorithm's own"),
      SHOAL_KEY(exploration.sigma, (RealRange{0, 10}),
                "standard deviation of gaussian and ou noise; a number, or a schedule over the "
                "run's env steps; drqv2 uses drqv2.noise instead"),
      SHOAL_KEY(exploration.theta, (RealRange{0, 1000}), "ou: pull towards zero per unit of time"),
      SHOAL_KEY(exploration.dt, (RealRange{0, 1, true}), "ou: units of time per env step"),
      SHOAL_KEY(
          exploration.random_steps, (IntegerRange{0, 1'000'000'000'000}),
          "env steps at the beginning of the run that are played with uniform random actions, "
          "divided among the actors; before the first weights arrive, all actions are random"),
      SHOAL_KEY(exploration.random_share, (RealRange{0, 1}),
                "probability with which a training actor plays a uniform random action in place of "
                "its policy's action, in each env step"),
      SHOAL_KEY(exploration.spread, (RealRange{1, 100}),
                "the noise of N actors is multiplied by factors from 1/spread to spread in "
                "geometric progression; 1 = equal noise"),
  };
}

std::vector<Key> NetworkKeys() {
  return {
      SHOAL_KEY(
          network.encoder,
          (Choices{{"compact", "drq", "mrq", "nature", "resnet18", "alexnet", "spatial_softmax"}}),
          "network from pixels to a feature map"),
      SHOAL_KEY(network.encoder_weights, AnyValue{},
                "path of a safetensors file that the encoder starts from, with Shoal's or "
                "torchvision's names; empty = none"),
      SHOAL_KEY(network.pool, (IntegerRange{0, 16}),
                "compact: side of the images' average pooling in pixels; 0 = 2, 1 = no pooling"),
      SHOAL_KEY(network.filters, (IntegerRange{1, 4096}),
                "compact: channels of each 3x3 convolution; [] = [32,32,32]"),
      SHOAL_KEY(network.strides, (IntegerRange{1, 8}),
                "compact: stride of each convolution; [] = [2,1,2]"),
      SHOAL_KEY(network.encoders, (Choices{{"shared", "separate"}}),
                "sac: shared = one encoder, trained by the critic's loss; separate = the actor has "
                "its own encoder, trained by the actor's loss"),
      SHOAL_KEY(
          network.target_encoder, AnyValue{},
          "sac: the target critic has an encoder of its own, which follows the critic's encoder"),
      SHOAL_KEY(network.trunk, (Choices{{"auto", "tanh", "relu", "elu"}}),
                "over the feature map: tanh = linear, LayerNorm, tanh; relu = linear, ReLU; elu = "
                "linear, LayerNorm, ELU; auto = the encoder's own: relu of nature, else tanh"),
      SHOAL_KEY(network.features, (IntegerRange{0, 65'536}),
                "outputs of the trunk; 0 = the encoder's own: 512 of nature, else 50"),
      SHOAL_KEY(
          network.state_hidden, (IntegerRange{1, 65'536}),
          "mrq: layers with LayerNorm and ELU between trunk and vector and the latent state; [] "
          "= the state is [trunk | vector]"),
      SHOAL_KEY(network.hidden, (IntegerRange{1, 65'536}), "hidden layers of actor and critics"),
      SHOAL_KEY(network.blocks, (IntegerRange{0, 16}),
                "residual blocks of actor and critics, as in SimBa, after a linear layer of "
                "network.hidden = [N]: LayerNorm, linear layer of 4 N, activation, linear layer of "
                "N; LayerNorm after the last block; 0 = no blocks"),
      SHOAL_KEY(network.layer_norm, AnyValue{}, "LayerNorm after each hidden layer"),
      SHOAL_KEY(network.activation, (Choices{{"relu", "tanh", "elu"}}),
                "activation of each hidden layer"),
      SHOAL_KEY(network.log_std, (Choices{{"smooth", "clamped"}}),
                "log deviation of a Gaussian policy: smooth = by tanh in [-5, 2]; clamped = "
                "clipped to [-20, 2]"),
      SHOAL_KEY(network.initialisation, (Choices{{"orthogonal", "pytorch"}}),
                "initial weights: orthogonal, with biases 0; pytorch = those of PyTorch's layers "
                "(uniform) and of torchvision's resnet18 (normal)"),
  };
}

std::vector<Key> EvalKeys() {
  return {
      SHOAL_KEY(eval.episodes, (IntegerRange{1, 100'000}), "episodes of one evaluation"),
      SHOAL_KEY(eval.interval, kSteps, "env steps between evaluations"),
      SHOAL_KEY(eval.final_episodes, (IntegerRange{0, 100'000}),
                "fresh episodes of the evaluation at the end of a run; 0 = none"),
      SHOAL_KEY(eval.envs, (IntegerRange{1, 256}),
                "environments stepped together by the evaluation actor"),
      SHOAL_KEY(stop.success, (RealRange{0, 2}), "stop at this success rate; above 1 = never"),
      SHOAL_KEY(stop.evaluations, (IntegerRange{1, 1000}),
                "number of newest evaluations whose pooled episodes must reach stop.success"),
      SHOAL_KEY(stop.without_actors, (IntegerRange{20, 1'000'000}),
                "the run ends when no training actor has worked for this many seconds"),
  };
}

std::vector<Key> TransportKeys() {
  return {
      SHOAL_KEY(transport.interface, AnyValue{},
                "network interface, by name or address; auto = the one that leads to the servers"),
      SHOAL_KEY(transport.fragment_bytes, (IntegerRange{1024, 65'000}),
                "bytes per datagram; 8000 where peers are behind MTU 1500"),
      SHOAL_KEY(transport.chunk_records, (IntegerRange{1, 4096}),
                "records per chunk at most; fewer where they exceed 1 MiB"),
      SHOAL_KEY(transport.flush_ms, (IntegerRange{1, 60'000}),
                "milliseconds after which a partial chunk is sent"),
  };
}

#undef SHOAL_KEY

std::vector<Key> AllKeys() {
  std::vector<Key> all;
  for (const auto& section :
       {RunKeys(), EnvKeys(), ObservationKeys(), RandomizationKeys(), ReplayKeys(), LearnerKeys(),
        SacKeys(), PpoKeys(), Td3Keys(), Drqv2Keys(), MrqKeys(), ExplorationKeys(), NetworkKeys(),
        EvalKeys(), TransportKeys()}) {
    all.insert(all.end(), section.begin(), section.end());
  }
  return all;
}

}  // namespace

std::span<const Key> Keys() {
  static const std::vector<Key> keys = AllKeys();
  return keys;
}

}  // namespace shoal::internal
