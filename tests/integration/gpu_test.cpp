// SPDX-License-Identifier: Apache-2.0
// learner.device in the real programs, with a library in place of libshoal-cuda.so whose GPU is the
// host's memory (tests/support/fake_gpu.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Environment = std::vector<std::pair<std::string, std::string>>;

constexpr std::chrono::seconds kGpuDeadline{180};

Environment FakeGpu(const std::string& behaviour) {
  return {{"LD_LIBRARY_PATH", ProgramPath("fake_gpu")}, {"FAKE_GPU", behaviour}};
}

ProgramResult DryRun(const std::vector<std::string>& assignments, const Environment& environment) {
  std::vector<std::string> command{ProgramPath("shoal"), "train", "--preset", "fetch-reach-state",
                                   "--dry-run"};
  for (const std::string& assignment : assignments) {
    command.insert(command.end(), {"--set", assignment});
  }
  return RunCommand(command, kGpuDeadline, environment);
}

// The refusal of a run with learner.device=cuda, which must be one line.
std::string Refusal(const Environment& environment) {
  const ProgramResult result = DryRun({"learner.device=cuda"}, environment);
  EXPECT_EQ(ExitCode(result), 2) << result.out << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  return result.err;
}

// A short run whose networks are small enough for kernels on the host.
TrainingRun::Keys KeysOfGpuRun(const std::string& device) {
  return {{"learner.device", device},
          {"learner.batch", "16"},
          {"network.hidden", "[16]"},
          {"learner.precision", "f32"},
          {"env_steps", "1200"},
          {"replay.min_size", "200"},
          {"eval.interval", "100000"},
          {"actors", "1"},
          {"eval.final_episodes", "2"},
          {"replay.samples_per_insert", "4"},
          {"learner.checkpoint_period", "20"}};
}

ProgramResult Train(const TrainingRun& run, const std::string& device,
                    const Environment& environment) {
  std::vector<std::string> command = run.Command(KeysOfGpuRun(device));
  command[0] = ProgramPath(command[0]);
  return RunCommand(command, kGpuDeadline, environment);
}

// Lines of the learner's log that say that memory cannot be pinned.
int TimesPinningFailed(const TrainingRun& run) {
  const std::string log = ReadFile(run.path() / "logs" / "learner-0.log");
  const std::string line = "Fake GPU cannot pin the memory of batches";
  int times = 0;
  for (size_t at = log.find(line); at != std::string::npos; at = log.find(line, at + 1)) ++times;
  return times;
}

TEST(Gpu, ABuildWithoutCudaSaysWhatIsMissing) {
  const std::string library = ProgramPath("libshoal-cuda.so");
  const bool built = std::filesystem::exists(library);
  EXPECT_THAT(Refusal({}), AllOf(HasSubstr("learner.device = cuda: "),
                                 HasSubstr(built ? "NVIDIA" : "this build of Shoal has no CUDA")));
}

TEST(Gpu, ALibraryOfAnotherBuildIsRefusedWithBothVersions) {
  EXPECT_THAT(Refusal(FakeGpu("another build")),
              AllOf(HasSubstr("is of build 0.0.1 of yesterday"), HasSubstr("same build")));
}

TEST(Gpu, AGpuThatCannotBeUsedIsRefusedWithTheReasonOfTheLibrary) {
  EXPECT_THAT(Refusal(FakeGpu("refuses")),
              HasSubstr("learner.device = cuda: the fake GPU is taken"));
}

TEST(Gpu, OptionsAreComputedOnIt) {
  const ProgramResult result =
      DryRun({"learner.device=cuda", "sac.temperature=fixed", "network.layer_norm=false"},
             FakeGpu("works"));
  EXPECT_EQ(ExitCode(result), 0) << result.err;
  const ProgramResult large =
      RunCommand({ProgramPath("shoal"), "train", "--preset", "fetch-reach-drq", "--dry-run",
                  "--set", "learner.device=cuda", "--set", "network.encoder=resnet18"},
                 kGpuDeadline, FakeGpu("works"));
  EXPECT_EQ(ExitCode(large), 0) << large.err;
}

TEST(Gpu, ARunOnAGpuNamesItInItsFilesAndReports) {
  const TrainingRun run;
  const ProgramResult result = Train(run, "cuda", FakeGpu("works"));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("the learner computes on Fake GPU (2 GB, driver 1.2.3)"));
  EXPECT_EQ(TimesPinningFailed(run), 0);
  const nlohmann::json meta = run.Json("meta.json");
  EXPECT_EQ(meta.at("learner_device").at("device"), "cuda");
  EXPECT_EQ(meta.at("learner_device").at("card"), "Fake GPU");
  EXPECT_EQ(meta.at("learner_device").at("driver"), "1.2.3");
  EXPECT_EQ(meta.at("precision"), "f32");
  ExpectBalanced(meta);
  const std::string metrics = ReadFile(run.path() / "metrics.jsonl");
  EXPECT_THAT(metrics, AllOf(HasSubstr("\"card_busy\":0.25"), HasSubstr("\"card_memory_mb\":1000"),
                             HasSubstr("\"card_memory_size_mb\":")));
}

TEST(Gpu, AGpuThatCannotPinMemoryLearnsAndSaysSoOnce) {
  const TrainingRun run;
  const ProgramResult result = Train(run, "cuda", FakeGpu("pins nothing"));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_EQ(TimesPinningFailed(run), 1);
}

TEST(Gpu, PpoLearnsOnAGpuAndGoesOnOnTheCpu) {
  const TrainingRun run;
  std::vector<std::string> command = run.OnPolicyCommand({{"learner.device", "cuda"},
                                                          {"learner.batch", "64"},
                                                          {"network.hidden", "[16]"},
                                                          {"env_steps", "4096"},
                                                          {"actors", "1"},
                                                          {"eval.interval", "100000"}});
  command[0] = ProgramPath(command[0]);
  const ProgramResult result = RunCommand(command, kGpuDeadline, FakeGpu("works"));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_EQ(run.Json("meta.json").at("learner_device").at("device"), "cuda");
  ExpectBalanced(run.Json("meta.json"));
  EXPECT_THAT(ReadFile(run.path() / "metrics.jsonl"), HasSubstr("\"approx_kl\":"));
  const ProgramResult resumed =
      RunCommand({ProgramPath("shoal"), "train", "--resume", run.path().string(), "--set",
                  "learner.device=cpu", "--set", "env_steps=6000"},
                 kGpuDeadline);
  ASSERT_EQ(ExitCode(resumed), 0) << resumed.out << resumed.err;
  const nlohmann::json meta = run.Json("meta.json");
  EXPECT_EQ(meta.at("learner_device").at("device"), "cpu");
  ExpectBalanced(meta);
}

TEST(Gpu, AutoSaysWhyItTookTheCpu) {
  const TrainingRun run;
  const ProgramResult result = Train(run, "auto", FakeGpu("refuses"));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("the learner computes on the CPU: the fake GPU is taken"));
  EXPECT_EQ(run.Json("meta.json").at("learner_device").at("reason"), "the fake GPU is taken");
}

TEST(Gpu, ALostGpuEndsTheLearnerAndAutoContinuesOnTheCpuTheSecondTime) {
  const TrainingRun run;
  const ProgramResult result = Train(run, "auto", FakeGpu("is lost after 60"));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("exit code 5"), HasSubstr("the fake GPU is lost")));
  EXPECT_THAT(result.out,
              HasSubstr("the learner computes on the CPU: the GPU was lost 2 times in this run"));
  const nlohmann::json meta = run.Json("meta.json");
  EXPECT_EQ(meta.at("restarts"), 2);
  EXPECT_EQ(meta.at("learner_device").at("device"), "cpu");
  ExpectBalanced(meta);
}

}  // namespace
}  // namespace shoal
