// SPDX-License-Identifier: Apache-2.0
#include "common/config/run_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class RunFiles : public ::testing::Test {
 protected:
  RunFiles()
      : run_(std::filesystem::path(::testing::TempDir()) /
             ("shoal-run-files-" + std::to_string(getpid()))) {
    std::filesystem::remove_all(run_);
    MakeFolders(run_);
  }
  ~RunFiles() override { std::filesystem::remove_all(run_); }

  static RunConfig Sample() {
    RunConfig run;
    run.config.seed = 9;
    run.config.learner.batch = 17;
    run.spec.task = "FetchReachDense";
    run.spec.blocks = {{"observation", 10}};
    run.spec.action_size = 4;
    run.spec.model_fingerprint = "1a2b";
    return run;
  }

  void Edit(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = ReadFile(run_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    WriteFileAtomically(run_ / file, text.replace(at, from.size(), to));
  }

  template <class Read>
  static std::string Mistake(Read read) {
    try {
      read();
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }

  std::filesystem::path run_;
};

TEST_F(RunFiles, RunConfigRoundTrips) {
  const RunConfig written = Sample();
  WriteRunConfig(run_, written);
  const RunConfig read = ReadRunConfig(run_);
  EXPECT_EQ(ToJson(read.config), ToJson(written.config));
  EXPECT_EQ(read.spec, written.spec);
}

TEST_F(RunFiles, RunConfigServesAsAConfigurationFile) {
  WriteRunConfig(run_, Sample());
  Config config;
  ApplyFile(run_ / "config.json", &config);
  EXPECT_EQ(config.learner.batch, 17);
}

TEST_F(RunFiles, AConfigurationFileWhoseSchemaIsNoTextIsRefusedByThatKey) {
  const std::filesystem::path file = run_ / "mine.json";
  WriteFileAtomically(file, R"({"schema": 5})");
  Config config;
  EXPECT_THAT(Mistake([&] { ApplyFile(file, &config); }), HasSubstr("unknown key 'schema'"));
}

TEST_F(RunFiles, RunConfigRefusesASpecThatIsNotTheHashedOne) {
  WriteRunConfig(run_, Sample());
  Edit("config.json", "\"action_size\": 4", "\"action_size\": 5");
  EXPECT_THAT(Mistake([&] { ReadRunConfig(run_); }),
              AllOf(HasSubstr("config.json"), HasSubstr("spec_hash")));
}

TEST_F(RunFiles, RunConfigRefusesAMissingFileAnotherSchemaAndAnUnknownKey) {
  EXPECT_THAT(Mistake([&] { ReadRunConfig(run_); }), HasSubstr("config.json"));
  WriteRunConfig(run_, Sample());
  Edit("config.json", "\"seed\"", "\"sead\"");
  EXPECT_THAT(Mistake([&] { ReadRunConfig(run_); }), HasSubstr("'sead'"));
  WriteRunConfig(run_, Sample());
  Edit("config.json", "shoal-config-1", "shoal-config-9");
  EXPECT_THAT(Mistake([&] { ReadRunConfig(run_); }), HasSubstr("shoal-config-1"));
}

TEST_F(RunFiles, ClusterAddressRoundTrips) {
  WriteClusterAddress(run_, {.domain = 42, .tag = "abc", .host = "10.0.0.1"});
  const ClusterAddress address = ReadClusterAddress(run_);
  EXPECT_EQ(address.domain, 42);
  EXPECT_EQ(address.tag, "abc");
  EXPECT_EQ(address.host, "10.0.0.1");
}

TEST_F(RunFiles, ClusterAddressRefusesMistakesByName) {
  EXPECT_THAT(Mistake([&] { ReadClusterAddress(run_); }), HasSubstr("cluster.json"));
  WriteClusterAddress(run_, {.domain = 41, .tag = "abc"});
  EXPECT_THAT(Mistake([&] { ReadClusterAddress(run_); }), HasSubstr("domain = 41"));
  WriteClusterAddress(run_, {.domain = 40, .tag = "abc"});
  Edit("cluster.json", "\"tag\"", "\"tog\"");
  EXPECT_THAT(Mistake([&] { ReadClusterAddress(run_); }), HasSubstr("'tag'"));
}

}  // namespace
}  // namespace shoal
