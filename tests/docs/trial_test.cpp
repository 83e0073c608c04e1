// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/trial.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/docs/commands.h"
#include "tests/support/program.h"
#include "tests/support/roomy_folder.h"
#include "tests/support/tiny_experiment.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

constexpr std::chrono::seconds kDeadline{400};  // of a machine that has much else to do

// A folder that looks like the repository, with the files that the pages' commands need: two runs
// and an experiment that take seconds, under every name that the pages use.
class Surroundings {
 public:
  Surroundings() {
    for (const char* folder : {"docs/images", "docs/results", "home"}) {
      fs::create_directories(folder_.path() / folder);
    }
    Link("tests", SourcePath("tests"));
    Link("docs/examples", SourcePath("docs/examples"));
    Link("docs/results/experiments", SourcePath("docs/results/experiments"));
    fs::create_directories(folder_.path() / "build/release");
    const fs::path bin = fs::path(ProgramPath("shoal")).parent_path();
    Link("build/release/bin", bin);
    for (const char* file : {"shoal", "point_reach.so", "point_reach_physics.so"}) {
      Link(file, bin / file);
    }
    path_ = fmt::format("{}:{}", bin.string(), getenv("PATH"));
  }

  void Link(const fs::path& name, const fs::path& target) const {
    fs::create_directories((folder_.path() / name).parent_path());
    fs::create_symlink(target, folder_.path() / name);
  }
  void Write(const fs::path& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }
  // The fault, or empty.
  std::string Run(const std::string& script) const {
    const std::string head =
        fmt::format("cd '{}'\nset -eu -o pipefail\ntrap 'echo \"failed: $BASH_COMMAND\" >&2' ERR\n",
                    folder_.path().string());
    const ProgramResult result =
        RunCommand({"/bin/bash", "-c", head + script}, kDeadline,
                   {{"PATH", path_}, {"HOME", (folder_.path() / "home").string()}});
    return ExitCode(result) == 0 ? ""
                                 : result.err + (result.ended ? "" : "killed at the deadline\n");
  }

 private:
  TemporaryFolder folder_{"shoal-", RoomyFolder()};
  std::string path_;
};

constexpr char kRuns[] = R"(
shoal train --preset fetch-reach-state --run-name reach --set env_steps=600 --set eval.interval=300 \
  --set eval.episodes=2 --set eval.final_episodes=2 --set stop.success=2 --set replay.samples_per_insert=16 \
  --set replay.keep=true
shoal train --preset fetch-reach-drq --run-name pixels --set env_steps=400 --set eval.interval=200 \
  --set eval.episodes=2 --set eval.final_episodes=2 --set stop.success=2 --set learner.batch=16 \
  --set replay.capacity=2000 --set replay.min_size=100 --set replay.samples_per_insert=4
shoal train --preset hopper-state --run-name plain --set task=CustomHopper-source --set env_steps=400 \
  --set eval.interval=400 --set eval.episodes=1 --set eval.final_episodes=1 --set replay.min_size=100
shoal experiment run batches.json
)";

void Prepare(const Surroundings& surroundings) {
  nlohmann::json definition = TinyExperiment(nlohmann::json::object(), 600);
  definition["set"]["network.layer_norm"] = false;  // as Stable-Baselines3 has it
  definition["arms"][0]["name"] = "batch-256";
  definition["arms"][1]["name"] = "batch-64";
  surroundings.Write("batches.json", definition.dump());
  surroundings.Write("mine.json", "{}");
  ASSERT_EQ(surroundings.Run(kRuns), "");
  for (const char* name :
       {"fetch-reach-drq-s1", "fetch-reach-drq-s2", "fetch-reach-drq-s3", "fetch-reach-fast-s1",
        "fetch-reach-fast-s131", "fetch-reach-fast-s132", "fetch-reach-fast-s133",
        "fetch-reach-fast-s134", "fetch-reach-fast-s135"}) {
    surroundings.Link(std::string("runs/") + name, "pixels");
  }
  surroundings.Link("runs/first", "reach");
  surroundings.Link("runs/reach-kept", "reach");
  surroundings.Link("runs/source", "plain");
  surroundings.Link("runs/reach-sb3", "../experiments/batches/runs/batch-256-s0");
  for (const char* name :
       {"reach-three-way", "reach-algorithms", "reach-ppo", "reach-recipe", "reach-encoder",
        "reach-precision", "push-her", "pick-and-place-movement", "pick-and-place-pixels",
        "push-pixels", "push-image-goals"}) {
    surroundings.Link(std::string("experiments/") + name, "batches");
  }
  for (const char* name :
       {"pixels-drq-s0", "preset-s11", "preset-s12", "preset-s13", "faster-s11", "faster-s12",
        "faster-s13", "asymmetric-s0", "symmetric-s0", "image-goals-s0"}) {
    surroundings.Link(std::string("experiments/batches/runs/") + name, "../../../runs/pixels");
  }
  for (const char* name : {"her-s0", "her-s1", "her-s2", "movement-s0"}) {
    surroundings.Link(std::string("experiments/batches/runs/") + name, "../../../runs/reach");
  }
}

std::vector<Page> PagesWithCommands() {
  std::vector<Page> pages = ReadPages(SourcePath(""));
  std::erase_if(pages, [](const Page& page) { return page.file == "CHANGELOG.md"; });
  return pages;
}

// A block as one script, since later commands build on earlier ones.
std::string ScriptOf(const Block& block, std::vector<size_t>* used) {
  std::string script;
  for (const Command& command : CommandsOf(block)) script += Tried(command.text, used) + "\n";
  return script;
}

TEST(DocsTrial, EveryCommandOfThePagesRuns) {
  const Surroundings surroundings;
  ASSERT_NO_FATAL_FAILURE(Prepare(surroundings));
  int ran = 0;
  for (const Page& page : PagesWithCommands()) {
    for (const Block& block : page.blocks) {
      std::vector<size_t> used;
      const std::string script = ScriptOf(block, &used);
      if (script.find_first_not_of(":\n") == std::string::npos) continue;
      ++ran;
      EXPECT_EQ(surroundings.Run(script), "") << page.file << ":" << block.line << "\n" << script;
    }
  }
  EXPECT_GT(ran, 30);
}

TEST(DocsTrial, EveryRuleIsUsed) {
  std::vector<size_t> used;
  for (const Page& page : PagesWithCommands()) {
    for (const Block& block : page.blocks) ScriptOf(block, &used);
  }
  for (size_t i = 0; i < TrialRules().size(); ++i) {
    EXPECT_THAT(used, testing::Contains(i)) << TrialRules()[i].pattern;
  }
}

TEST(DocsTrial, TestsThatRulesNameAreThere) {
  std::set<std::string> missing;
  for (const TrialRule& rule : TrialRules()) {
    if (rule.trial == Trial::kElsewhere) missing.insert(rule.text);
  }
  ASSERT_FALSE(missing.empty());
  for (const auto& entry : fs::recursive_directory_iterator(SourcePath("tests"))) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string source = ReadFile(entry.path());
    std::erase_if(missing, [&](const std::string& name) {
      const size_t dot = name.find('.');
      return source.find(fmt::format("({}, {})", name.substr(0, dot), name.substr(dot + 1))) !=
             std::string::npos;
    });
  }
  EXPECT_THAT(missing, IsEmpty());
}

TEST(DocsTrial, ACommandIsTriedAsItStandsOrSmaller) {
  std::vector<size_t> used;
  EXPECT_EQ(Tried("shoal env list   # all", &used), "shoal env list   # all");
  EXPECT_THAT(used, IsEmpty());
  EXPECT_EQ(Tried("shoal train --preset a   # why", &used),
            "shoal train --preset a --dry-run   # why");
  EXPECT_EQ(Tried("./run train   # why", &used),
            "shoal train --preset fetch-reach-fast --dry-run   # why");
  EXPECT_EQ(Tried("shoal eval --checkpoint a", &used), "shoal eval --episodes 1 --checkpoint a");
  EXPECT_EQ(Tried("ssh node4 rm x", &used), ":");
}

}  // namespace
}  // namespace shoal
