// SPDX-License-Identifier: Apache-2.0
// Compares the policies of three short lockstep runs of the real programs with recorded ones:
// a change that should not change behaviour must not change any bit of the policy.
//
// tests/golden/fingerprints.json contains a CRC-32 of each tensor of the policy for each platform:
// the bits depend on the code that oneDNN and the C library choose for the CPU, on the compiler and
// on the versions of libraries. On a platform without a recording the test is skipped.
//
// If a change must change the numbers, record them again; the commit message says which and why:
//   SHOAL_RECORD_FINGERPRINTS=1 ctest --test-dir build/release -R Fingerprint
#include <fmt/core.h>
#include <gnu/libc-version.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "common/base/crc32.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"
#include "tests/support/paths.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

using nlohmann::ordered_json;

struct ShortRun {
  const char* name;
  const char* preset;
  const char* precision;
  TrainingRun::Keys keys;
};

void PrintTo(const ShortRun& run, std::ostream* out) { *out << run.name; }

// The three together pass through both precisions, pictures of two qualities with and without a
// vector, stacks, several copies and n-step returns.
std::vector<ShortRun> Runs() {
  return {{"state_f32",
           "fetch-reach-state",
           "f32",
           {{"env_steps", "2200"}, {"replay.samples_per_insert", "32"}}},
          {"pixels_bf16",
           "fetch-reach-drq",
           "bf16",
           {{"env_steps", "800"},
            {"learner.batch", "32"},
            {"replay.min_size", "200"},
            {"replay.samples_per_insert", "12"}}},
          {"pixels_and_vector_bf16",
           "fetch-reach-drq",
           "bf16",
           {{"env_steps", "800"},
            {"learner.batch", "16"},
            {"observation.goal_mode", "both"},
            {"observation.grey", "true"},
            {"observation.proprioception", "true"},
            {"observation.quality", "fast"},
            {"observation.stack", "2"},
            {"replay.copies", "2"},
            {"replay.min_size", "200"},
            {"replay.n_step", "3"},
            {"replay.samples_per_insert", "6"}}}};
}

std::filesystem::path Recorded() { return GoldenPath("fingerprints.json"); }

// Everything below the project's own code that may choose another order of additions.
std::string Surroundings(const nlohmann::json& meta) {
  const auto text = [](const nlohmann::json& value) { return value.get<std::string>(); };
  const nlohmann::json& versions = meta.at("versions");
  // oneDNN cuts its products into blocks that fit the second-level cache.
  const long cache_kib = sysconf(_SC_LEVEL2_CACHE_SIZE) / 1024;
  return fmt::format("{}, L2 {} KiB, compiler {}, oneDNN {}, MuJoCo {}, glibc {}",
                     text(meta.at("machine").at("isa")), cache_kib, text(versions.at("compiler")),
                     text(versions.at("onednn")), text(versions.at("mujoco")),
                     gnu_get_libc_version());
}

// The last checkpoint, because the best one depends on the evaluations, and a loaded machine may
// skip an evaluation.
std::filesystem::path LastCheckpoint(const TrainingRun& run) {
  std::filesystem::path last;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "checkpoints")) {
    if (entry.path().filename().string().starts_with("step_")) last = std::max(last, entry.path());
  }
  return last;
}

ordered_json PolicyFingerprint(const TrainingRun& run) {
  const CheckpointFiles files = ReadCheckpointFiles(LastCheckpoint(run));
  ordered_json fingerprint;
  for (const auto& [name, tensor] : nn::ReadSafetensors(files.policy, "policy")) {
    fingerprint[name] = fmt::format("{:08x}", Crc32(tensor.data));
  }
  return fingerprint;
}

void Record(const std::string& surroundings, const std::string& run,
            const ordered_json& fingerprint) {
  ordered_json all;
  if (std::filesystem::exists(Recorded())) all = ordered_json::parse(ReadFile(Recorded()));
  all[surroundings][run] = fingerprint;
  WriteFileAtomically(Recorded(), all.dump(1) + "\n");
}

class Fingerprint : public testing::TestWithParam<ShortRun> {};

TEST_P(Fingerprint, ThePolicyIsTheRecordedOneBitForBit) {
  const ShortRun& kind = GetParam();
  if (std::string(kind.precision) == "bf16" &&
      nn::ChoosePrecision("auto", /*pixels=*/true) != nn::Precision::kBf16) {
    GTEST_SKIP() << "this CPU has no bf16 arithmetic";
  }
  TrainingRun::Keys keys = kind.keys;
  keys.insert({{"actors", "1"},
               {"eval.episodes", "2"},
               {"eval.final_episodes", "2"},
               {"eval.interval", "100000"},
               {"learner.precision", kind.precision},
               {"replay.capacity", "3000"}});
  const TrainingRun run;
  const ProgramResult result = run.Train(keys, {"--preset", kind.preset, "--lockstep"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const nlohmann::json meta = run.Json("meta.json");
  ASSERT_GE(meta.at("updates").get<int>(), 200);
  const std::string surroundings = Surroundings(meta);
  const ordered_json fingerprint = PolicyFingerprint(run);
  ASSERT_GE(fingerprint.size(), 10u);
  if (std::getenv("SHOAL_RECORD_FINGERPRINTS") != nullptr) {
    Record(surroundings, kind.name, fingerprint);
  }
  const ordered_json recorded = ordered_json::parse(ReadFile(Recorded()));
  if (!recorded.contains(surroundings) || !recorded[surroundings].contains(kind.name)) {
    GTEST_SKIP() << "no fingerprint of " << kind.name << " recorded for: " << surroundings;
  }
  EXPECT_EQ(fingerprint.dump(1), recorded[surroundings][kind.name].dump(1))
      << "If this change must change what is learned, record it and say why; see the top of "
      << __FILE__;
}

INSTANTIATE_TEST_SUITE_P(Runs, Fingerprint, testing::ValuesIn(Runs()),
                         [](const auto& run) { return std::string(run.param.name); });

}  // namespace
}  // namespace shoal
