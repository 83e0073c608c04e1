// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/definition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/tasks/task_registry.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

ordered_json Valid() {
  return ordered_json::parse(R"({
    "schema": "shoal-experiment-definition-1",
    "base": "fetch-reach-state",
    "arms": [{"name": "slow"}, {"name": "fast", "set": {"learner.learning_rate": 0.01}}],
    "seeds": [0, 1]})");
}

// The error of parsing and resolving; empty if there is none.
std::string Refusal(const ordered_json& object) {
  return UsageMessage([&] {
    const Definition definition = ParseDefinition(object, "x.json", "x");
    const Config base = ResolveBase(definition, "x.json");
    for (const Arm& arm : definition.arms) ArmConfig(base, arm, "x.json");
    CheckTransfer(definition, "x.json");
    CheckReference(definition, "x.json");
  });
}

TEST(Definition, ArmsAreDifferencesFromTheBase) {
  ordered_json object = Valid();
  object["set"] = {{"env_steps", 500}, {"eval.interval", 100}};
  object["final_episodes"] = 7;
  const Definition definition = ParseDefinition(object, "x.json", "x");
  EXPECT_EQ(definition.name, "x");
  EXPECT_EQ(definition.target_success, 0.9);
  EXPECT_THAT(definition.seeds, ElementsAre(0, 1));
  const Config base = ResolveBase(definition, "x.json");
  EXPECT_EQ(base.preset, "fetch-reach-state");
  EXPECT_EQ(base.env_steps, 500);
  EXPECT_EQ(base.eval.interval, 100);
  EXPECT_EQ(base.eval.final_episodes, 7);
  const Config fast = ArmConfig(base, definition.arms[1], "x.json");
  EXPECT_EQ(fast.learner.learning_rate, 0.01);
  EXPECT_EQ(fast.env_steps, 500);
  EXPECT_EQ(ArmConfig(base, definition.arms[0], "x.json").learner.learning_rate,
            base.learner.learning_rate);
}

TEST(Definition, SurvivesItsOwnJson) {
  ordered_json object = Valid();
  object["name"] = "named";
  object["question"] = "Does it?";
  object["target_success"] = 0.5;
  object["transfer"] = {"FetchReach"};
  object["final_episodes"] = 3;
  object["frames"] = {100, 500};
  object["reference"] = "planet-6";
  const Definition definition = ParseDefinition(object, "x.json", "x");
  const Definition again = ParseDefinition(ToJson(definition), "y.json", "y");
  EXPECT_EQ(ToJson(again), ToJson(definition));
  EXPECT_THAT(again.frames, ElementsAre(100, 500));
  EXPECT_EQ(again.reference, "planet-6");
  EXPECT_EQ(definition.name, "named");
}

// An experiment that an earlier version began goes on with the definition of the present one.
TEST(Definition, FormerNamesOfKeysAreReadAsThePresentOnes) {
  ordered_json former = Valid(), present = Valid();
  former["set"] = {{"learner.initial_temperature", 0.5}};
  present["set"] = {{"sac.initial_temperature", 0.5}};
  former["arms"][1]["set"] = {{"learner.temperature", "fixed"}};
  present["arms"][1]["set"] = {{"sac.temperature", "fixed"}};
  const Definition definition = ParseDefinition(former, "x.json", "x");
  EXPECT_EQ(ToJson(definition), ToJson(ParseDefinition(present, "x.json", "x")));
  EXPECT_EQ(Refusal(former), "");

  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "x.json", former.dump());
  testing::internal::CaptureStderr();
  ReadDefinition(folder.path() / "x.json");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("learner.initial_temperature is called sac.initial_temperature"),
                    HasSubstr("learner.temperature is called sac.temperature")));

  former["set"]["sac.initial_temperature"] = 1;
  EXPECT_THAT(Refusal(former), HasSubstr("key 'sac.initial_temperature' given twice"));
}

TEST(Definition, MistakesAreRefusedByName) {
  EXPECT_EQ(Refusal(Valid()), "");
  struct Case {
    const char* path;
    ordered_json value;
    std::vector<const char*> mentions;
  };
  const std::vector<Case> cases = {
      {"/schema", "shoal-experiment-2", {"x.json", "shoal-experiment-definition-1"}},
      {"/base", "nope", {"x.json", "nope", "fetch-reach-state"}},
      {"/arms", ordered_json::array(), {"x.json", "arms"}},
      {"/arms/1/name", "slow", {"arm 2", "slow", "twice"}},
      {"/arms/1/name", "a/b", {"arm 2", "a/b"}},
      {"/arms/1/sets", ordered_json::object(), {"arm 2", "sets"}},
      {"/arms/1/set/learner.bach", 3, {"arm 'fast'", "learner.bach", "learner.batch"}},
      {"/arms/1/set/learner.batch", "many", {"arm 'fast'", "learner.batch", "many"}},
      {"/arms/1/set/learner", ordered_json::object(), {"arm 'fast'", "learner.KEY"}},
      {"/arms/1/set/seed", 3, {"arm 'fast'", "seed"}},
      {"/arms/1/set/task", "FetchFly", {"arm 'fast'", "FetchFly", "FetchReachDense"}},
      {"/arms/1/set/replay.copies", 7, {"arm 'fast'", "replay.copies", "learner.batch"}},
      {"/set", {{"nothing", 3}}, {"x.json: set", "nothing"}},
      {"/seeds", {1, 1}, {"seeds"}},
      {"/seeds", {-1}, {"seeds"}},
      {"/seeds", ordered_json::array(), {"seeds"}},
      {"/final_episodes", 0, {"final_episodes"}},
      {"/target_success", 1.5, {"target_success"}},
      {"/transfer", {"FetchFly"}, {"transfer", "FetchFly"}},
      {"/frames", {200, 100}, {"x.json: frames = [200,100]: expected a list of increasing"}},
      {"/frames", ordered_json::array(), {"x.json: frames = []"}},
      {"/reference", "a/b.json", {"x.json: reference = \"a/b.json\": expected the name"}},
      {"/reference", 3, {"x.json: reference = 3"}},
      {"/reference", "nope", {"x.json: reference: no reference 'nope'", "planet-6"}},
      {"/jobs", 2, {"unknown member 'jobs'"}}};
  for (const Case& mistake : cases) {
    ordered_json object = Valid();
    object[ordered_json::json_pointer(mistake.path)] = mistake.value;
    const std::string refusal = Refusal(object);
    for (const char* word : mistake.mentions) {
      EXPECT_THAT(refusal, HasSubstr(word)) << mistake.path;
    }
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  }
  for (const char* needed : {"schema", "base", "arms", "seeds"}) {
    ordered_json object = Valid();
    object.erase(needed);
    EXPECT_THAT(Refusal(object), HasSubstr(needed));
  }
}

TEST(Definition, AFileIsReadStrictly) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "mine.json";
  WriteFileAtomically(file, Valid().dump());
  EXPECT_EQ(ReadDefinition(file).name, "mine");
  WriteFileAtomically(file, R"({"base": "a", "base": "b"})");
  EXPECT_THROW(ReadDefinition(file), Error);
  EXPECT_THROW(ReadDefinition(folder.path() / "absent.json"), Error);
}

// Committed definitions are valid by the table of keys.
TEST(Definition, EveryCommittedOneIsGood) {
  const std::vector<std::string> names = ListDefinitions();
  EXPECT_THAT(names, testing::Contains("reach-three-way"));
  for (const std::string& name : names) {
    const auto file = FindDefinition(name);
    const Definition definition = ReadDefinition(file);
    EXPECT_EQ(definition.name, name) << "the name by which it is found";
    const Config base = ResolveBase(definition, file);
    for (const Arm& arm : definition.arms) EXPECT_NO_THROW(ArmConfig(base, arm, file));
    EXPECT_NO_THROW(CheckReference(definition, file));
  }
}

// All keys but those that an experiment sets itself.
ordered_json KeysOfRuns(const Config& config) {
  ordered_json keys = ToJson(config);
  keys.erase("preset");
  keys.at("eval").erase("final_episodes");
  return keys;
}

// An arm repeats the keys of its task's preset that differ between tasks, so the two could diverge.
TEST(Definition, ArmsOfPlanetHaveTheRecipesOfThePresets) {
  for (const char* name : {"planet-6", "planet-6-500k"}) {
    const Definition definition = ReadDefinition(FindDefinition(name));
    const Config base = ResolveBase(definition, name);
    EXPECT_EQ(definition.arms.size(), 6u);
    for (const Arm& arm : definition.arms) {
      Config preset = LoadPreset("dmc-" + arm.name + "-drq");
      if (definition.name == "planet-6-500k") preset.env_steps *= 5;
      EXPECT_EQ(KeysOfRuns(ArmConfig(base, arm, name)), KeysOfRuns(preset)) << arm.name;
      EXPECT_EQ(preset.task, arm.name);
      const int64_t frames = preset.env_steps * tasks::FindTask(arm.name).action_repeat();
      EXPECT_EQ(frames, definition.name == "planet-6" ? 100'000 : 500'000) << arm.name;
    }
  }
}

TEST(Definition, AnUnknownNameListsThoseThereAre) {
  try {
    FindDefinition("nope");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("nope"), HasSubstr("reach-three-way")));
    EXPECT_EQ(e.exit_code(), 2);
  }
}

}  // namespace
}  // namespace shoal::launch
