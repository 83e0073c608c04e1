// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

class RunRequestTest : public testing::Test {
 protected:
  RunRequest Fresh(const std::string& name = "") const {
    RunRequest request;
    request.config.config.run_dir = folder_.path();
    request.config.config.run_name = name;
    request.config.config.task = "point-reach";
    request.config.config.seed = 7;
    return request;
  }

  TemporaryFolder folder_;
};

TEST_F(RunRequestTest, ToShowItTheConfigurationIsResolvedWithItsHosts) {
  const std::string hosts = folder_.path() / "hosts.json";
  WriteFileAtomically(hosts, R"({"schema": "shoal-hosts-1",
    "servers": {"address": "10.0.0.1", "actors": 2}, "hosts": [{"name": "far", "actors": 3}]})");
  TrainOptions options;
  options.print_config = true;
  options.hosts = hosts;
  const RunRequest request = ResolveFresh(options);
  EXPECT_EQ(request.config.config.actors, 5);
  EXPECT_EQ(request.hosts.address, "10.0.0.1");
  EXPECT_FALSE(request.resumed());
  EXPECT_EQ(request.config.spec, ObservationSpec()) << "no program was asked";
}

TEST_F(RunRequestTest, AFreshRunIsNamedAfterTaskOrPresetAndSeed) {
  RunRequest request = Fresh();
  const RunFolder folder = TakeFolder({}, &request);
  EXPECT_EQ(folder.path(), folder_.path() / "point-reach-s7");
  EXPECT_EQ(request.config.config.run_name, "point-reach-s7");
  EXPECT_FALSE(request.meta.started.empty());
  RunRequest other = Fresh();
  other.config.config.preset = "mine";
  EXPECT_EQ(TakeFolder({}, &other).name(), "mine-s7");
}

TEST_F(RunRequestTest, AGivenNameIsTakenOnce) {
  RunRequest request = Fresh("a"), again = Fresh("a");
  EXPECT_EQ(TakeFolder({}, &request).name(), "a");
  EXPECT_THAT(UsageMessage([&] { TakeFolder({}, &again); }),
              HasSubstr("exists: choose another --run-name"));
}

TEST_F(RunRequestTest, TheFolderHasTheInitialWeights) {
  RunRequest request = Fresh("a");
  EXPECT_FALSE(std::filesystem::exists(TakeFolder({}, &request).path() / kInitialWeightsFile));
  RunRequest other = Fresh("b");
  other.initial_weights["actor.bias"] = {.dtype = "F32", .shape = {1}, .data = {0, 0, 0, 0}};
  EXPECT_TRUE(std::filesystem::exists(TakeFolder({}, &other).path() / kInitialWeightsFile));
}

TEST_F(RunRequestTest, AResumedRunKeepsItsFolderAndItsBeginning) {
  RunRequest first = Fresh("a");
  RunRequest request;
  request.config.config.run_name = "a";
  request.meta.started = "long ago";
  request.folder = TakeFolder({}, &first);
  ASSERT_TRUE(request.resumed());
  EXPECT_EQ(TakeFolder({}, &request).path(), folder_.path() / "a");
  EXPECT_EQ(request.meta.started, "long ago");
}

}  // namespace
}  // namespace shoal::launch
