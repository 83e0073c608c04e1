// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/base/files.h"
#include "common/tasks/task_registry.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ordered_json ValidReference() {
  return ordered_json::parse(R"({
    "schema": "shoal-reference-1",
    "source": "a paper, table 1",
    "results": [
      {"method": "A", "task": "reacher_easy", "frames": [100, 500], "returns": [601, -0.5]},
      {"method": "B", "source": "its own", "task": "reacher_easy", "frames": [7], "returns": [1]}
    ]})");
}

TEST(Reference, HasTheNumbersOfTheFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "mine.json";
  WriteFileAtomically(file, ValidReference().dump());
  const Reference reference = ReadReference(FindReference(file.string()));
  EXPECT_EQ(reference.name, "mine");
  EXPECT_EQ(reference.source, "a paper, table 1");
  ASSERT_EQ(reference.results.size(), 2u);
  EXPECT_EQ(reference.results[0].method, "A");
  EXPECT_EQ(reference.results[0].task, "reacher_easy");
  EXPECT_THAT(reference.results[0].frames, ElementsAre(100, 500));
  EXPECT_THAT(reference.results[0].returns, ElementsAre(601, -0.5));
  EXPECT_EQ(reference.results[1].source, "its own");
}

TEST(Reference, MistakesAreRefusedInOneLine) {
  struct Case {
    const char* path;
    ordered_json value;
    const char* message;
  };
  const std::vector<Case> cases = {
      {"/schema", "shoal-reference-2", "x.json: expected an object of schema 'shoal-reference-1'"},
      {"/source", "", "x.json: source = \"\": expected a string that is not empty"},
      {"/results", ordered_json::array(), "x.json: results = []: expected a list of at least one"},
      {"/title", "t", "x.json: unknown member 'title', there are: schema, source, results"},
      {"/results/1/metod", "B", "x.json: result 2: unknown member 'metod'"},
      {"/results/0/method", "", "x.json: result 1: method = \"\": expected"},
      {"/results/0/task", 3, "x.json: result 1: task = 3: expected a string"},
      {"/results/0/source", 3, "x.json: result 1: source = 3: expected a string"},
      {"/results/0/frames", {500, 100}, "x.json: result 1: frames = [500,100]: expected a list of"},
      {"/results/0/returns", {1}, "x.json: result 1: returns = [1]: expected a list with a number"},
      {"/results/0/returns", {1, nullptr}, "x.json: result 1: returns = [1,null]: expected a list"},
      {"/results/1/method", "A",
       "x.json: result 2: method 'A' has another result on task 'reacher_easy'"}};
  for (const Case& mistake : cases) {
    ordered_json object = ValidReference();
    object[ordered_json::json_pointer(mistake.path)] = mistake.value;
    const std::string refusal = UsageMessage([&] { ParseReference(object, "x.json", "x"); });
    EXPECT_THAT(refusal, StartsWith(mistake.message));
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  }
  for (const char* needed : {"source", "results"}) {
    ordered_json object = ValidReference();
    object.erase(needed);
    EXPECT_THAT(UsageMessage([&] { ParseReference(object, "x.json", "x"); }), HasSubstr(needed));
  }
  for (const char* needed : {"method", "task", "frames", "returns"}) {
    ordered_json object = ValidReference();
    object["results"][0].erase(needed);
    EXPECT_THAT(UsageMessage([&] { ParseReference(object, "x.json", "x"); }),
                AllOf(StartsWith("x.json: result 1:"), HasSubstr(needed)));
  }
}

TEST(Reference, AnUnknownNameListsThoseThereAre) {
  EXPECT_THAT(UsageMessage([] { FindReference("nope"); }),
              AllOf(StartsWith("no reference 'nope': expected a file"), HasSubstr("planet-6")));
}

TEST(Reference, EveryCommittedOneIsOfKnownTasks) {
  for (const std::string& name : ListReferences()) {
    const Reference reference = ReadReference(FindReference(name));
    EXPECT_EQ(reference.name, name);
    for (const ReferenceResult& result : reference.results) {
      EXPECT_NO_THROW(tasks::FindTask(result.task)) << name;
    }
  }
}

// The papers print these means of the six tasks, so a wrong digit in a row is found.
TEST(Reference, PlanetHasTheMeansOfThePapers) {
  const Reference reference = ReadReference(FindReference("planet-6"));
  const auto mean_of = [&](const std::string& method, size_t i) {
    std::set<std::string> seen;
    double sum = 0;
    for (const ReferenceResult& result : reference.results) {
      if (result.method != method) continue;
      EXPECT_THAT(result.frames, ElementsAre(100'000, 500'000));
      sum += result.returns.at(i);
      seen.insert(result.task);
    }
    EXPECT_EQ(seen.size(), 6u) << method;
    return sum / 6;
  };
  EXPECT_NEAR(mean_of("DrQ", 0), 688, 0.5);
  EXPECT_NEAR(mean_of("DrQ", 1), 882, 0.5);
  EXPECT_NEAR(mean_of("CURL", 0), 552, 0.5);
  EXPECT_NEAR(mean_of("CURL", 1), 834, 0.5);
  EXPECT_NEAR(mean_of("SAC state", 0), 699, 0.5);
  EXPECT_NEAR(mean_of("SAC state", 1), 915, 0.51);
  EXPECT_NEAR(mean_of("Simoun", 0), 832, 0.5);
  EXPECT_NEAR(mean_of("Simoun", 1), 908, 0.5);
}

}  // namespace
}  // namespace shoal::launch
