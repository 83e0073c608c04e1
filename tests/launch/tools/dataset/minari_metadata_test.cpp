// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/minari_metadata.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/replay_server/record_script.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

const MinariFacts kFacts = {
    .run = "reach.2 b", .algorithm = "sac", .episodes = 3, .steps = 150, .bytes = 12'340'000};

TEST(MinariMetadata, CountsAndNamesTheDataset) {
  json metadata;
  metadata = json::parse(MinariMetadata(replay::TinySpec(1), kFacts));
  EXPECT_EQ(metadata["dataset_id"], "shoal/reach-2-b-v0");
  EXPECT_EQ(metadata["total_episodes"], 3);
  EXPECT_EQ(metadata["total_steps"], 150);
  EXPECT_EQ(metadata["dataset_size"], 12.3);
  EXPECT_EQ(metadata["data_format"], "hdf5");
  EXPECT_EQ(metadata["jpeg_encoding"], false);
  EXPECT_EQ(metadata["algorithm_name"], "sac");
}

TEST(MinariMetadata, SpacesHaveEveryBlockAndTheFrame) {
  json metadata, space;
  metadata = json::parse(MinariMetadata(replay::TinySpec(1, 1, 2), kFacts));
  const std::string text = metadata["observation_space"];
  // Infinity is what Python's json reads and writes.
  EXPECT_THAT(text,
              HasSubstr(R"("achieved_goal": {"type": "Box", "dtype": "float32", "shape": [2],)"
                        R"( "low": [-Infinity, -Infinity], "high": [Infinity, Infinity]})"));
  EXPECT_THAT(text, HasSubstr(R"("grip": {)"));
  EXPECT_THAT(text, HasSubstr(R"("desired_goal": {)"));
  EXPECT_THAT(text,
              EndsWith(R"("pixels": {"type": "Box", "dtype": "uint8", "shape": [2,1,2],)"
                       R"( "low": [[[0, 0]], [[0, 0]]], "high": [[[255, 255]], [[255, 255]]]}}})"));
  EXPECT_EQ(metadata["action_space"], R"({"type": "Box", "dtype": "float32", "shape": [2],)"
                                      R"( "low": [-1.0, -1.0], "high": [1.0, 1.0]})");
}

TEST(MinariMetadata, WithoutPixelsThereAreNone) {
  ObservationSpec spec = replay::TinySpec(1);
  spec.cameras.clear();
  spec.channels = spec.height = spec.width = 0;
  EXPECT_THAT(MinariMetadata(spec, kFacts), testing::Not(HasSubstr("pixels")));
}

}  // namespace
}  // namespace shoal::launch
