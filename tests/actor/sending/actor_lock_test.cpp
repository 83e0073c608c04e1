// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/actor_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "common/base/error.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

bool NeverStopped() { return false; }

TEST(ActorLock, RefusesASecondProcessOfAnActorByName) {
  const TemporaryFolder run;
  const ActorLock first(run.path(), 3, seconds(0), NeverStopped);
  const ActorLock other(run.path(), 4, seconds(0), NeverStopped);
  try {
    const ActorLock second(run.path(), 3, seconds(0), NeverStopped);
    FAIL() << "two actors 3";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("actor 3"), HasSubstr("made/actor-3.lock")));
  }
}

TEST(ActorLock, WaitsForAPredecessorThatLeaves) {
  const TemporaryFolder run;
  std::optional<ActorLock> first(std::in_place, run.path(), 0, seconds(0), NeverStopped);
  const ActorLock second(run.path(), 0, seconds(10), [&] {
    first.reset();
    return false;
  });
  EXPECT_FALSE(first.has_value());
}

TEST(ActorLock, GivesUpWhenAskedToStop) {
  const TemporaryFolder run;
  const ActorLock first(run.path(), 0, seconds(0), NeverStopped);
  EXPECT_THROW(ActorLock(run.path(), 0, seconds(100), [] { return true; }), Error);
}

}  // namespace
}  // namespace shoal::actor
