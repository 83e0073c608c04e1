// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string JsonMistake(const std::string& text) {
  return UsageMessage([&] {
    Config config;
    ApplyJson(ParseStrictJson(text, "x.json"), "x.json", &config);
  });
}

std::string SetMistake(const std::vector<std::string>& assignments) {
  return UsageMessage([&] {
    Config config;
    ApplyAssignments(assignments, &config);
  });
}

TEST(ApplyJson, SetsNestedKeysAndLeavesTheOthers) {
  Config config;
  ApplyJson(ParseStrictJson(R"({"seed": 7, "learner": {"batch": 32, "discount": 0},
                                "network": {"filters": [8, 16]}})",
                            "x.json"),
            "x.json", &config);
  EXPECT_EQ(config.seed, 7);
  EXPECT_EQ(config.learner.batch, 32);
  EXPECT_EQ(config.learner.discount, 0);
  EXPECT_THAT(config.network.filters, ElementsAre(8, 16));
  EXPECT_EQ(config.replay.capacity, Config().replay.capacity);
}

TEST(ApplyJson, TakesIntervalsByName) {
  Config config;
  ApplyJson(ParseStrictJson(R"({"randomization": {"body_mass": {"thigh": [3.5, 4.5],
                                "foot": [5, 5]}}})",
                            "x.json"),
            "x.json", &config);
  using Interval = std::array<double, 2>;
  EXPECT_THAT(config.randomization.body_mass, ElementsAre(std::pair("foot", Interval{5, 5}),
                                                          std::pair("thigh", Interval{3.5, 4.5})));
  // And back, whole: a later value replaces an earlier one.
  Config other;
  ApplyAssignments({R"(randomization.body_mass={"leg":[1,2]})"}, &other);
  ApplyJson(ToJson(config), "again", &other);
  EXPECT_EQ(other.randomization.body_mass, config.randomization.body_mass);
  EXPECT_NE(ConfigHash(config), ConfigHash(Config()));
}

TEST(ApplyJson, RefusesIntervalsThatAreNone) {
  for (const char* bad :
       {"[3, 4]", "{\"thigh\": 3}", "{\"thigh\": [3]}", "{\"thigh\": [4, 3]}",
        "{\"thigh\": [0, 3]}", "{\"thigh\": [1, 2, 3]}", "{\"thigh\": [\"a\", 2]}"}) {
    EXPECT_THAT(JsonMistake(std::string(R"({"randomization": {"body_mass": )") + bad + "}}"),
                AllOf(HasSubstr("randomization.body_mass"), HasSubstr("low <= high")))
        << bad;
  }
}

TEST(ApplyJson, RefusesAnUnknownKeyNamingItAndTheNearest) {
  EXPECT_THAT(
      JsonMistake(R"({"learner": {"bach": 3}})"),
      AllOf(HasSubstr("x.json"), HasSubstr("'learner.bach'"), HasSubstr("'learner.batch'")));
  EXPECT_THAT(JsonMistake(R"({"batch": 3})"),
              AllOf(HasSubstr("'batch'"), HasSubstr("'learner.batch'")));
  EXPECT_THAT(JsonMistake(R"({"replya": {"capacity": 3}})"),
              AllOf(HasSubstr("'replya'"), HasSubstr("'replay'")));
  EXPECT_THAT(JsonMistake(R"({"learner.batch": 3})"),
              AllOf(HasSubstr("'learner.batch'"), HasSubstr("nested")));
}

TEST(ApplyJson, RefusesAnIllTypedValueNamingKeyValueAndType) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"learner": {"batch": "32"}})", "learner.batch = \"32\": expected an integer"},
      {R"({"learner": {"batch": 32.5}})", "learner.batch = 32.5: expected an integer"},
      {R"({"learner": {"tau": true}})", "learner.tau = true: expected a number"},
      {R"({"lockstep": 1})", "lockstep = 1: expected true or false"},
      {R"({"task": 1})", "task = 1: expected a string"},
      {R"({"network": {"filters": 32}})", "network.filters = 32: expected a list of integers"},
      {R"({"network": {"filters": [1, "a"]}})", "network.filters = [1,\"a\"]: expected a list"},
      {R"({"observation": {"cameras": [1]}})", "observation.cameras = [1]: expected a list of str"},
      {R"({"learner": 5})", "learner = 5: expected an object"},
      {R"({"seed": {"a": 1}})", "seed = {\"a\":1}: expected an integer"},
      {R"({"seed": null})", "seed = null: expected an integer"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(JsonMistake(text), HasSubstr(message));
  EXPECT_THAT(JsonMistake("[1]"), HasSubstr("expected one JSON object"));
}

TEST(ApplyJson, RefusesAValueOutOfRangeNamingTheRange) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"learner": {"batch": 0}})", "learner.batch = 0: expected an integer in 1..65536"},
      {R"({"learner": {"batch": 65537}})", "learner.batch = 65537"},
      {R"({"learner": {"discount": 1}})", "learner.discount = 1: expected a number in [0, 1)"},
      {R"({"learner": {"tau": 0}})", "learner.tau = 0: expected a number in (0, 1]"},
      {R"({"learner": {"precision": "f64"}})", "expected auto | f32 | bf16"},
      {R"({"network": {"strides": [2, 0]}})", "network.strides = [2,0]"},
      {R"({"seed": -1})", "seed = -1"},
      {R"({"seed": 18446744073709551615})", "seed = 18446744073709551615"},
      {R"({"run_name": "../up"})", "run_name = \"../up\""},
      {R"({"task": ""})", "task = \"\""},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(JsonMistake(text), HasSubstr(message));
}

TEST(ApplyJson, AcceptsBothEndsOfARange) {
  Config config;
  ApplyAssignments({"learner.batch=65536", "learner.tau=1", "learner.discount=0"}, &config);
  EXPECT_EQ(config.learner.batch, 65536);
  EXPECT_EQ(config.learner.tau, 1);
}

TEST(ApplyAssignments, TakesJsonValuesAndBareWords) {
  Config config;
  ApplyAssignments({"learner.precision=bf16", "observation.pixels=false", "run_name=7",
                    "observation.cameras=[\"front\"]", "model=a=b.xml"},
                   &config);
  EXPECT_EQ(config.learner.precision, "bf16");
  EXPECT_FALSE(config.observation.pixels);
  EXPECT_EQ(config.run_name, "7");
  EXPECT_EQ(config.model, "a=b.xml");
  EXPECT_THAT(config.observation.cameras, ElementsAre("front"));
}

TEST(ApplyAssignments, IntegersMayHaveAnExponent) {
  Config config;
  ApplyAssignments({"env_steps=1e5", "learner.batch=2.56e2"}, &config);
  EXPECT_EQ(config.env_steps, 100'000);
  EXPECT_EQ(config.learner.batch, 256);
  EXPECT_THAT(SetMistake({"env_steps=1e-5"}), HasSubstr("expected an integer"));
  EXPECT_THAT(SetMistake({"env_steps=1e18"}), HasSubstr("expected an integer"));
  EXPECT_THAT(SetMistake({"env_steps=1e300"}), HasSubstr("expected an integer"));
}

TEST(ApplyAssignments, RefusesMistakesByName) {
  EXPECT_THAT(SetMistake({"learner.batch"}), HasSubstr("expected KEY=VALUE"));
  EXPECT_THAT(SetMistake({"=3"}), HasSubstr("expected KEY=VALUE"));
  EXPECT_THAT(SetMistake({"learner=3"}), HasSubstr("'learner' is a section"));
  EXPECT_THAT(SetMistake({"learner.bat=3"}), HasSubstr("'learner.batch'"));
  EXPECT_THAT(SetMistake({"seed=1", "seed=1"}), HasSubstr("'seed' given twice"));
  EXPECT_THAT(SetMistake({"seed=many"}), HasSubstr("seed = \"many\": expected an integer"));
  EXPECT_THAT(SetMistake({"seed="}), HasSubstr("seed = \"\""));
  EXPECT_THAT(SetMistake({"model=\xb4.xml"}), HasSubstr(".xml\": expected text in UTF-8"));
}

TEST(ToJson, RoundTripsEveryKey) {
  Config config;
  ApplyAssignments(
      {"seed=3", "run_name=a.b", "observation.grey=true", "replay.band=12.5", "learner.batch=9",
       "network.hidden=[5]", "eval.envs=2", "stop.success=1.5", "transport.flush_ms=7"},
      &config);
  const nlohmann::ordered_json first = ToJson(config);
  Config again;
  ApplyJson(ParseStrictJson(first.dump(), "again"), "again", &again);
  EXPECT_EQ(ToJson(again), first);
  EXPECT_EQ(again.stop.success, 1.5);
}

TEST(ToJson, ListsSectionsInTheOrderOfTheStruct) {
  std::vector<std::string> names;
  const nlohmann::ordered_json object = ToJson(Config());
  for (const auto& [name, value] : object.items()) {
    if (value.is_object()) names.push_back(name);
  }
  EXPECT_THAT(names, ElementsAre("env", "observation", "randomization", "replay", "learner", "sac",
                                 "ppo", "td3", "drqv2", "mrq", "exploration", "network", "eval",
                                 "stop", "transport"));
}

TEST(ConfigHash, ChangesWithWhatIsComputedButNotWithNameOrLength) {
  const uint64_t base = ConfigHash(Config());
  const auto hash = [](const std::string& assignment) {
    Config config;
    ApplyAssignments({assignment}, &config);
    return ConfigHash(config);
  };
  EXPECT_NE(hash("learner.batch=3"), base);
  EXPECT_NE(hash("seed=3"), base);
  EXPECT_EQ(hash("run_name=other"), base);
  EXPECT_EQ(hash("env_steps=5"), base);
  EXPECT_EQ(hash("stop.success=2"), base);
  EXPECT_EQ(hash("learner.device=auto"), base) << "a resumed run may change its device";
}

TEST(Validate, AcceptsTheDefaults) { EXPECT_NO_THROW(Validate(Config())); }

TEST(Validate, RefusesCombinationsThatCannotWork) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"observation.pixels=false"}, "nothing to observe"},
      {{"observation.cameras=[]"}, "observation.cameras"},
      {{"observation.cameras=[\"a\",\"a\"]"}, "'a' is listed twice"},
      {{"observation.height=1024", "observation.width=1024"}, "6291456 bytes"},
      {{"replay.min_size=60000"}, "replay.min_size = 60000"},
      {{"lockstep=true", "actors=2"}, "lockstep takes one actor"},
      {{"replay.samples_per_insert=linear(64,0,1000)"},
       "replay.samples_per_insert = linear(64,0,1000): expected both ends of a schedule above 0"},
      {{"replay.samples_per_insert=linear(0,64,1000)"}, "replay.samples_per_insert = linear(0,64"},
      {{"replay.copies=3"}, "replay.copies = 3: expected a divisor of learner.batch = 128"},
      {{"replay.copies=4", "replay.target_shifts=3"},
       "replay.target_shifts = 3: expected a divisor of replay.copies = 4, or 0"},
      {{"replay.critic_shifts=2"}, "replay.critic_shifts = 2: expected a divisor of replay.copies"},
      {{"replay.shift_pad=0", "replay.target_shifts=1"},
       "replay.target_shifts = 1: nothing is shifted without replay.shift_pad"},
      {{"observation.pixels=false", "observation.goal_mode=desired", "replay.critic_shifts=1"},
       "replay.critic_shifts = 1: nothing is shifted without observation.pixels"},
      {{"run_dir="}, "run_dir"},
      {{"transport.interface="}, "transport.interface"},
      {{"replay.shift_pad=32", "observation.height=64"}, "replay.shift_pad = 32"},
      {{"replay.shift_pad=20", "observation.width=16"},
       "observation.height = 84, observation.width = 16"},
  };
  for (const auto& [assignments, message] : cases) {
    Config config;
    ApplyAssignments(assignments, &config);
    EXPECT_THAT(UsageMessage([&] { Validate(config); }), HasSubstr(message));
  }
}

TEST(Validate, RefusesWhatOnPolicyLearningHasNoUseForByName) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"replay.n_step=3"}, "replay.n_step = 3: learner.algorithm = ppo learns from rollouts"},
      {{"replay.hindsight=future"}, "replay.hindsight = \"future\""},
      {{"replay.samples_per_insert=8"}, "expected it unset (64.0), or learner.algorithm = sac"},
      {{"replay.samples_per_insert=linear(64,8,1000)"},
       "replay.samples_per_insert = \"linear(64,8,1000)\": learner.algorithm = ppo learns from"},
      {{"replay.priorities=lap"}, "replay.priorities = \"lap\""},
      {{"exploration.random_steps=10"}, "exploration.random_steps = 10"},
      {{"learner.tau=0.5"}, "learner.tau = 0.5"},
      {{"learner.weights_period=3"}, "learner.weights_period = 3"},
      {{"ppo.rollout_steps=1"}, "ppo.rollout_steps = 1: a rollout needs"},
      {{"ppo.rollout_steps=1000000", "actors=64", "envs_per_actor=256"},
       "ppo.rollout_steps = 1000000: 64 actor(s) with 256 environments each play 16384000000"},
      {{"ppo.rollout_steps=100", "actors=2", "learner.batch=256"},
       "are 800, which learner.batch = 256 does not divide; expected a multiple of 32, 128 for"},
      {{"lockstep=true", "ppo.versions_ahead=1"}, "ppo.versions_ahead = 1: in lockstep"},
      {{"learner.normalise_vectors=true"}, "learner.normalise_vectors = true: the run observes"},
  };
  for (const auto& [assignments, message] : cases) {
    Config config;
    ApplyAssignments({"learner.algorithm=ppo"}, &config);
    EXPECT_NO_THROW(Validate(config));
    ApplyAssignments(assignments, &config);
    EXPECT_THAT(UsageMessage([&] { Validate(config); }), HasSubstr(message));
  }
  Config config;
  ApplyAssignments({"ppo.epochs=3"}, &config);
  EXPECT_THAT(UsageMessage([&] { Validate(config); }),
              HasSubstr("ppo.epochs belongs to learner.algorithm = ppo: expected not to be set"));
  config = Config();
  ApplyAssignments({"td3.target_noise=0.1"}, &config);
  EXPECT_THAT(UsageMessage([&] { Validate(config); }),
              HasSubstr("td3.target_noise belongs to learner.algorithm = td3"));
}

// A run's config.json lists every key.
TEST(Validate, AcceptsEveryKeyOfAnOnPolicyRunAsItIs) {
  Config config = LoadPreset("fetch-reach-ppo"), again;
  ApplyJson(nlohmann::json::parse(ToJson(config).dump()), "config.json", &again);
  EXPECT_NO_THROW(Validate(again));
  EXPECT_EQ(ToJson(again), ToJson(config));
}

TEST(DescribeKeys, IsWhatTheDocumentationShows) {
  EXPECT_THAT(ReadFile(SourcePath("docs/configuration.md")), HasSubstr(DescribeKeys()));
}

}  // namespace
}  // namespace shoal
