// SPDX-License-Identifier: Apache-2.0
#include "common/tensorboard/last_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "common/tensorboard/event_writer.h"
#include "tests/support/temporary_folder.h"

namespace shoal::tensorboard {
namespace {

using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

TEST(LastSteps, AreTheHighestOfEachTagOverAllFiles) {
  const TemporaryFolder folder;
  EXPECT_THAT(LastSteps(folder.path() / "absent"), IsEmpty());
  {
    EventWriter first(folder.path());
    first.Text("configuration", "text");
    first.Scalar("a", 100, 1);
    first.Scalar("a", 300, 1);
    first.Scalar("b", 200, 1);
  }
  EventWriter second(folder.path());
  second.Scalar("a", 250, 1);
  second.Scalar("c", 0, 1);
  second.Flush();
  WriteFileAtomically(folder.path() / "notes.txt", "not an event file");
  EXPECT_THAT(LastSteps(folder.path()),
              UnorderedElementsAre(Pair("a", 300), Pair("b", 200), Pair("c", 0)));
}

TEST(LastSteps, AFileIsReadUpToItsFirstDamagedRecord) {
  const TemporaryFolder folder;
  EventWriter writer(folder.path());
  writer.Scalar("a", 100, 1);
  writer.Flush();
  const auto sound = std::filesystem::file_size(writer.path());
  writer.Scalar("a", 200, 1);
  writer.Flush();
  std::filesystem::resize_file(writer.path(), std::filesystem::file_size(writer.path()) - 3);
  EXPECT_THAT(LastSteps(folder.path()), UnorderedElementsAre(Pair("a", 100)));
  std::string bytes = ReadFile(writer.path()).substr(0, sound) + std::string(200, '\xff');
  WriteFileAtomically(writer.path(), bytes);
  EXPECT_THAT(LastSteps(folder.path()), UnorderedElementsAre(Pair("a", 100)));
}

}  // namespace
}  // namespace shoal::tensorboard
