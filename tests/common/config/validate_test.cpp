// SPDX-License-Identifier: Apache-2.0
// Keys that contradict each other.
#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <string_view>

#include "common/config/config_io.h"
#include "tests/support/error_message.h"

namespace shoal {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::function<void(Config*)>& change) {
  Config config;
  change(&config);
  return UsageMessage([&] { Validate(config); });
}

TEST(Validate, AnImageGoalNeedsPixelsAndAReplay) {
  const auto image = [](Config* config) { config->observation.goal_mode = "image"; };
  EXPECT_EQ(Refusal(image), "");
  EXPECT_THAT(Refusal([&](Config* config) {
                image(config);
                config->observation.pixels = false;
              }),
              HasSubstr("observation.goal_mode = image without observation.pixels"));
  EXPECT_THAT(Refusal([&](Config* config) {
                image(config);
                config->learner.algorithm = "ppo";
                config->learner.batch = 64;
              }),
              HasSubstr("carry no goal pictures"));
}

// Whether or not there are pixels that it would encode.
TEST(Validate, KeysOfTheCompactEncoderAreRefusedBesideAnother) {
  for (const bool pixels : {true, false}) {
    for (const char* assignment :
         {"network.pool=2", "network.filters=[32]", "network.strides=[2,1,2]"}) {
      const auto refusal = [&](const char* encoder) {
        return Refusal([&](Config* c) {
          c->observation.pixels = pixels;
          c->observation.proprioception = !pixels;
          ApplyAssignments({std::string("network.encoder=") + encoder, assignment}, c);
        });
      };
      const std::string key(assignment, std::string_view(assignment).find('='));
      EXPECT_EQ(refusal("compact"), "") << key;
      EXPECT_EQ(refusal("drq"), key +
                                    " belongs to network.encoder = compact: expected not to be "
                                    "set beside drq");
    }
  }
}

TEST(Validate, NoiseThatTheExplorationDoesNotAddIsRefused) {
  const auto refusal = [](const char* algorithm, const char* kind, const char* noise) {
    return Refusal([&](Config* c) {
      c->learner.algorithm = algorithm;
      c->exploration.kind = kind;
      ApplyAssignments({noise}, c);
    });
  };
  EXPECT_EQ(refusal("sac", "auto", "exploration.sigma=0.3"),
            "exploration.sigma: actors explore by squashed_gaussian (exploration.kind = auto, "
            "learner.algorithm = sac), which does not take it; expected it unset, or "
            "exploration.kind = gaussian | ou");
  EXPECT_EQ(refusal("td3", "auto", "exploration.theta=0.2"),
            "exploration.theta: actors explore by gaussian (exploration.kind = auto, "
            "learner.algorithm = td3), which does not take it; expected it unset, or "
            "exploration.kind = ou");
  EXPECT_THAT(refusal("sac", "squashed_gaussian", "exploration.sigma=linear(0.1,0,1000)"),
              HasSubstr("exploration.sigma"));
  EXPECT_THAT(refusal("ddpg", "gaussian", "exploration.dt=0.02"), HasSubstr("exploration.dt"));
  EXPECT_THAT(refusal("sac", "gaussian", "exploration.theta=0.2"), HasSubstr("exploration.theta"));
  EXPECT_EQ(refusal("td3", "auto", "exploration.sigma=0.3"), "");
  EXPECT_EQ(refusal("sac", "gaussian", "exploration.sigma=0.3"), "");
  for (const char* kind : {"auto", "ou"}) {
    EXPECT_EQ(
        refusal("drqv2", kind, "exploration.sigma=0.3"),
        "exploration.sigma: the actors of learner.algorithm = drqv2 explore with the noise of "
        "drqv2.noise; expected it unset");
    EXPECT_EQ(refusal("drqv2", kind, "drqv2.noise=0.3"), "");
  }
  EXPECT_EQ(refusal("td3", "auto", "drqv2.noise=0.3"),
            "drqv2.noise belongs to learner.algorithm = drqv2: expected not to be set beside td3");
  EXPECT_EQ(refusal("drqv2", "auto", "td3.target_noise=0.3"),
            "td3.target_noise belongs to learner.algorithm = td3: expected not to be set beside "
            "drqv2");
  for (const char* noise :
       {"exploration.sigma=0.3", "exploration.theta=0.2", "exploration.dt=0.02"}) {
    EXPECT_EQ(refusal("sac", "ou", noise), "");
  }
}

TEST(Validate, APolicyWithoutDeviationTakesNoKeysOfIt) {
  for (const char* algorithm : {"td3", "ddpg", "drqv2", "mrq"}) {
    const auto refusal = [&](const std::function<void(Config*)>& change) {
      return Refusal([&](Config* config) {
        config->learner.algorithm = algorithm;
        change(config);
      });
    };
    EXPECT_EQ(refusal([](Config*) {}), "");
    EXPECT_THAT(refusal([](Config* c) { c->sac.initial_temperature = 1; }),
                HasSubstr("sac.initial_temperature belongs to learner.algorithm = sac"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.target_entropy = -1; }),
                HasSubstr("sac.target_entropy"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.target_entropy_per_action = 0; }),
                HasSubstr("sac.target_entropy_per_action"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.temperature = "fixed"; }),
                HasSubstr("sac.temperature belongs"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.temperature_learning_rate = 1e-3; }),
                HasSubstr("sac.temperature_learning_rate"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.critics = 5; }),
                HasSubstr("sac.critics belongs to learner.algorithm = sac"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.target_critics = 1; }),
                HasSubstr("sac.target_critics belongs to learner.algorithm = sac"));
    EXPECT_THAT(refusal([](Config* c) { c->sac.actor_value = "mean"; }),
                HasSubstr("sac.actor_value belongs to learner.algorithm = sac"));
    EXPECT_THAT(refusal([](Config* c) { c->network.log_std = "clamped"; }),
                HasSubstr("network.log_std: the policy of learner.algorithm = "));
  }
  EXPECT_EQ(Refusal([](Config* c) { c->sac.initial_temperature = 1; }), "");
}

TEST(Validate, SequencesBelongToAlgorithmsThatLearnFromThem) {
  const auto refusal = [](const std::function<void(Config*)>& change) {
    return Refusal([&](Config* config) {
      config->learner.algorithm = "mrq";
      change(config);
    });
  };
  EXPECT_EQ(refusal([](Config*) {}), "");
  for (const char* assignment :
       {"learner.reward_scale=3", "learner.tau=0.02", "learner.average_rate=1",
        "learner.actor_period=1", "learner.target_period=2", "learner.bounded_targets=true",
        "learner.normalise_vectors=true", "replay.copies=2"}) {
    const std::string key(assignment, std::string_view(assignment).find('='));
    EXPECT_EQ(refusal([&](Config* config) { ApplyAssignments({assignment}, config); }),
              key + ": learner.algorithm = mrq does not use it; expected it unset");
  }
  const auto state = [](Config* config) {
    config->observation.pixels = false;
    config->observation.proprioception = true;
  };
  EXPECT_THAT(refusal(state), HasSubstr("network.state_hidden = []: without observation.pixels"));
  EXPECT_EQ(refusal([&](Config* config) {
              state(config);
              config->network.state_hidden = {8};
            }),
            "");
  EXPECT_THAT(refusal([&](Config* config) {
                state(config);
                config->network.state_hidden = {8};
                config->network.hidden = {};
              }),
              HasSubstr("network.hidden = []: the model of learner.algorithm = mrq"));
  EXPECT_EQ(Refusal([](Config* config) { config->network.state_hidden = {8}; }),
            "network.state_hidden: learner.algorithm = sac has no latent state; expected it unset, "
            "or learner.algorithm = mrq");
}

TEST(Validate, OnlyADeterministicPolicyTakesAPenaltyOfItsMean) {
  for (const std::string algorithm : {"sac", "ppo", "td3", "ddpg", "drqv2", "mrq"}) {
    const std::string refusal = Refusal([&](Config* config) {
      config->learner.algorithm = algorithm;
      config->learner.mean_penalty = 0.1;
    });
    const bool takes = algorithm != "sac" && algorithm != "ppo";
    EXPECT_EQ(refusal.find("learner.mean_penalty") == std::string::npos, takes) << refusal;
  }
}

TEST(Validate, ATemperaturesFloorIsBelowItsStartAndOfOneThatMoves) {
  EXPECT_EQ(Refusal([](Config* c) { c->sac.min_temperature = 0.01; }), "");
  EXPECT_THAT(Refusal([](Config* c) { c->sac.min_temperature = 0.2; }),
              HasSubstr("sac.min_temperature = 0.2: expected at most"));
  EXPECT_THAT(Refusal([](Config* c) {
                c->sac.min_temperature = 0.01;
                c->sac.temperature = "fixed";
              }),
              HasSubstr("sac.temperature = fixed"));
}

TEST(Validate, ATargetOfCriticsHasNoMoreThanThereAre) {
  const auto refusal = [](int critics, int target_critics) {
    return Refusal([&](Config* c) {
      c->sac.critics = critics;
      c->sac.target_critics = target_critics;
    });
  };
  EXPECT_EQ(refusal(2, 3),
            "sac.target_critics = 3: expected at most sac.critics = 2, or 0 for all");
  EXPECT_EQ(refusal(5, 2), "");
  EXPECT_EQ(refusal(5, 5), "");
}

TEST(Validate, QuantilesAreMoreThanAreDroppedAndHaveRulesOfTheirOwn) {
  const auto refusal = [](const std::function<void(Config*)>& change) {
    return Refusal([&](Config* c) {
      c->sac.quantiles = 5;
      change(c);
    });
  };
  EXPECT_EQ(refusal([](Config*) {}), "");
  EXPECT_EQ(refusal([](Config* c) { c->sac.dropped_quantiles = 5; }),
            "sac.dropped_quantiles = 5: expected less than sac.quantiles = 5");
  EXPECT_EQ(Refusal([](Config* c) { c->sac.dropped_quantiles = 1; }),
            "sac.dropped_quantiles = 1: expected it unset without sac.quantiles");
  EXPECT_EQ(refusal([](Config* c) { c->sac.target_critics = 2; }),
            "sac.target_critics: expected it unset with sac.quantiles");
  EXPECT_EQ(refusal([](Config* c) { c->replay.copies = 2; }),
            "replay.copies: expected it unset with sac.quantiles");
  EXPECT_EQ(refusal([](Config* c) { c->replay.priorities = "lap"; }),
            "replay.priorities: expected it unset with sac.quantiles");
  EXPECT_THAT(refusal([](Config* c) { c->learner.algorithm = "td3"; }),
              HasSubstr("sac.quantiles belongs to learner.algorithm = sac"));
}

TEST(Validate, ResidualBlocksHaveOneWidthAndALayerNorm) {
  const auto refusal = [](const std::vector<int>& hidden, bool layer_norm) {
    return Refusal([&](Config* c) {
      c->network.blocks = 2;
      c->network.hidden = hidden;
      c->network.layer_norm = layer_norm;
    });
  };
  EXPECT_EQ(refusal({32}, true), "");
  for (const std::vector<int>& hidden : {std::vector<int>{}, std::vector<int>{32, 32}}) {
    EXPECT_EQ(refusal(hidden, true),
              "network.hidden: with network.blocks = 2, all blocks have one width; expected one "
              "number, for example [256]");
  }
  EXPECT_EQ(refusal({32}, false),
            "network.layer_norm = false: residual blocks have a LayerNorm; expected true with "
            "network.blocks = 2");
}

TEST(Validate, TheTargetEntropyIsSetInOneWay) {
  EXPECT_EQ(Refusal([](Config* c) { c->sac.target_entropy = -3; }), "");
  EXPECT_EQ(Refusal([](Config* c) { c->sac.target_entropy_per_action = 0; }), "");
  EXPECT_THAT(Refusal([](Config* c) {
                c->sac.target_entropy = -3;
                c->sac.target_entropy_per_action = 0;
              }),
              HasSubstr("sac.target_entropy = -3, sac.target_entropy_per_action = 0: "));
}

TEST(Validate, KeysOfWhatIsOffAreRefused) {
  EXPECT_THAT(Refusal([](Config* c) { c->learner.variance_floor = 1e-4; }),
              HasSubstr("learner.variance_floor = 0.0001 without learner.normalise_vectors"));
  const auto floor = [](Config* c) {
    c->observation.proprioception = true;
    c->learner.normalise_vectors = true;
    c->learner.variance_floor = 1e-4;
  };
  EXPECT_EQ(Refusal(floor), "");
  EXPECT_THAT(Refusal([](Config* c) { c->replay.movement = "displacement"; }),
              HasSubstr("replay.movement = displacement with replay.movement_share = 0"));
  EXPECT_EQ(Refusal([](Config* c) {
              c->replay.hindsight = "future";
              c->replay.movement_share = 0.5;
              c->replay.movement = "displacement";
            }),
            "");
}

TEST(Validate, SamplesHaveOneKindOfPriorityAndTheKeysOfThatKind) {
  EXPECT_EQ(Refusal([](Config* c) { c->replay.priority_exponent = 0.4; }),
            "replay.priority_exponent without replay.priorities: expected it unset, or "
            "proportional | lap");
  EXPECT_EQ(Refusal([](Config* c) {
              c->replay.priority_correction = Schedule{0.4, 1, 100};
            }),
            "replay.priority_correction without replay.priorities: expected it unset, or "
            "proportional");
  for (const char* algorithm : {"sac", "td3", "ddpg"}) {
    for (const char* kind : {"proportional", "lap"}) {
      const auto refusal = [&](const std::function<void(Config*)>& change) {
        return Refusal([&](Config* config) {
          config->learner.algorithm = algorithm;
          config->learner.batch = 12;
          config->replay.copies = 2;
          config->replay.n_step = 3;
          config->replay.hindsight = "future";
          config->replay.priorities = kind;
          config->replay.priority_exponent = 0.4;
          change(config);
        });
      };
      EXPECT_EQ(refusal([](Config*) {}), "") << algorithm << " " << kind;
      EXPECT_EQ(refusal([](Config* c) { c->replay.movement_share = 0.5; }),
                std::string("replay.movement_share = 0.5 with replay.priorities = ") + kind +
                    ": samples are drawn by one of them; expected 0, or replay.priorities = none");
      EXPECT_EQ(refusal([](Config* c) { c->replay.priority_correction = Schedule::Constant(1); }),
                kind == std::string("lap")
                    ? "replay.priority_correction with replay.priorities = lap, which has no "
                      "importance weights: expected it unset"
                    : "");
    }
  }
}

TEST(Validate, FurtherEncodersAreOfSacFromPixels) {
  const auto separate = [](Config* c) {
    c->observation.pixels = true;
    c->network.encoders = "separate";
    c->network.target_encoder = true;
  };
  EXPECT_EQ(Refusal(separate), "");
  EXPECT_THAT(Refusal([&](Config* c) {
                separate(c);
                c->learner.algorithm = "td3";
              }),
              HasSubstr("network.encoders: learner.algorithm = td3 has one encoder"));
  EXPECT_THAT(Refusal([](Config* c) {
                c->observation.pixels = false;
                c->observation.proprioception = true;
                c->network.target_encoder = true;
              }),
              HasSubstr("network.target_encoder: nothing is encoded without observation.pixels"));
}

TEST(Validate, PrivilegedInputsAreOfSac) {
  const auto asymmetric = [](Config* c) {
    c->sac.critic_blocks = true;
    c->sac.aux = {"object"};
  };
  EXPECT_EQ(Refusal(asymmetric), "");
  for (const char* algorithm : {"td3", "ddpg", "drqv2"}) {
    EXPECT_THAT(Refusal([&](Config* c) {
                  asymmetric(c);
                  c->learner.algorithm = algorithm;
                }),
                HasSubstr("sac.critic_blocks belongs to learner.algorithm = sac: expected not"));
  }
  EXPECT_THAT(Refusal([](Config* c) {
                c->learner.algorithm = "ppo";
                c->sac.aux = {"object"};
              }),
              HasSubstr("sac.aux"));
  EXPECT_THAT(Refusal([&](Config* c) {
                asymmetric(c);
                c->network.encoders = "separate";
              }),
              HasSubstr("network.encoders: with sac.critic_blocks the critic has no encoder"));
  EXPECT_THAT(Refusal([&](Config* c) {
                asymmetric(c);
                c->network.target_encoder = true;
              }),
              HasSubstr("network.target_encoder: with sac.critic_blocks"));
  EXPECT_THAT(Refusal([&](Config* c) {
                asymmetric(c);
                c->observation.pixels = false;
                c->observation.proprioception = true;
              }),
              HasSubstr("sac.aux: nothing is encoded without observation.pixels"));
  EXPECT_THAT(Refusal([](Config* c) { c->sac.aux_weight = 2; }),
              HasSubstr("sac.aux_weight = 2: expected it unset without sac.aux"));
}

}  // namespace
}  // namespace shoal
