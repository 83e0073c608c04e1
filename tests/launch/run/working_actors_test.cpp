// SPDX-License-Identifier: Apache-2.0
#include "launch/run/working_actors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Optional;

constexpr seconds kPatience{60};
const SteadyTime kStart{};

DownProcess Down(const std::string& name, const std::string& hopeless = "") {
  return {.name = name,
          .reason = "exit code 1: no way to host",
          .deaths = 8,
          .restart_in = seconds(25),
          .hopeless = hopeless};
}

// `processes` actors of which some work; the others are down where they are named, else starting.
RoleStanding Actors(int processes, int working, std::vector<DownProcess> down = {}) {
  return {.processes = processes, .working = working, .down = std::move(down)};
}

// Looks ten times a second of the run's time; after how many seconds it has to end, -1 if not
// within `limit`.
int SecondsUntilEnd(WorkingActors* rule, const RoleStanding& actors, seconds limit,
                    SteadyTime* now) {
  const SteadyTime start = *now;
  while (*now - start < limit) {
    if (rule->Look(actors, kPatience, *now)) {
      return static_cast<int>(std::chrono::floor<seconds>(*now - start).count());
    }
    *now += milliseconds(100);
  }
  return -1;
}

TEST(WorkingActors, OneThatWorksKeepsTheRunGoing) {
  WorkingActors rule(kStart);
  SteadyTime now = kStart;
  const RoleStanding actors =
      Actors(3, 1, {Down("actor-1", "in vain"), Down("actor-2", "in vain")});
  EXPECT_EQ(SecondsUntilEnd(&rule, actors, seconds(1000), &now), -1);
}

TEST(WorkingActors, TheRunEndsWhenNoneHasWorkedForSoLong) {
  WorkingActors rule(kStart);
  SteadyTime now = kStart;
  EXPECT_EQ(SecondsUntilEnd(&rule, Actors(2, 2), seconds(20), &now), -1);
  const RoleStanding none = Actors(2, 0, {Down("actor-0", "in vain"), Down("actor-1", "in vain")});
  EXPECT_EQ(SecondsUntilEnd(&rule, none, seconds(50), &now), -1);
  EXPECT_EQ(SecondsUntilEnd(&rule, Actors(2, 1, {Down("actor-1")}), seconds(1), &now), -1);
  EXPECT_EQ(SecondsUntilEnd(&rule, none, seconds(1000), &now), kPatience.count());
  EXPECT_THAT(rule.Look(none, kPatience, now),
              Optional(AllOf(HasSubstr("no training actor has worked for 60 s"),
                             HasSubstr("stop.without_actors"), HasSubstr("actor-0: exit code 1"),
                             HasSubstr("actor-1"))));
}

TEST(WorkingActors, AMistakeInTheConfigurationEndsTheRunAtOnce) {
  WorkingActors rule(kStart);
  EXPECT_EQ(rule.Look(Actors(2, 0), kPatience, kStart), std::nullopt);
  EXPECT_EQ(rule.Look(Actors(2, 0, {Down("actor-0", "bad batch")}), kPatience, kStart),
            std::nullopt)
      << "the other one may come to work";
  EXPECT_EQ(
      rule.Look(Actors(2, 0, {Down("actor-0", "bad batch"), Down("actor-1")}), kPatience, kStart),
      std::nullopt);
  EXPECT_EQ(rule.Look(Actors(2, 0, {Down("actor-0", "bad batch"), Down("actor-1", "too often")}),
                      kPatience, kStart),
            "actor-0: bad batch");
}

TEST(WorkingActors, OnceOneHasWorkedRestartsAreNotSeenAsVain) {
  WorkingActors rule(kStart);
  SteadyTime now = kStart;
  EXPECT_EQ(rule.Look(Actors(1, 1), kPatience, now), std::nullopt);
  EXPECT_EQ(SecondsUntilEnd(&rule, Actors(1, 0, {Down("actor-0", "too often")}), seconds(50), &now),
            -1);
}

TEST(WorkingActors, ActorsThatNeverDiedAreNotTimed) {
  WorkingActors rule(kStart);
  SteadyTime now = kStart;
  EXPECT_EQ(SecondsUntilEnd(&rule, Actors(2, 0), seconds(1000), &now), -1);
}

TEST(WorkingActors, ThePauseOfThisProcessIsNotTimed) {
  WorkingActors rule(kStart);
  const RoleStanding none = Actors(1, 0, {Down("actor-0")});
  EXPECT_EQ(rule.Look(none, kPatience, kStart), std::nullopt);
  EXPECT_EQ(rule.Look(none, kPatience, kStart + std::chrono::hours(1)), std::nullopt);
}

TEST(MissingEvaluations, EndTheRunUntilTheFirstOneCame) {
  EXPECT_EQ(MissingEvaluations(Actors(1, 1), false), std::nullopt);
  EXPECT_EQ(MissingEvaluations(Actors(1, 0, {Down("eval-0")}), false), std::nullopt);
  EXPECT_EQ(MissingEvaluations(Actors(1, 0, {Down("eval-0", "too often")}), false),
            "eval-0: too often");
  EXPECT_EQ(MissingEvaluations(Actors(1, 0, {Down("eval-0", "too often")}), true), std::nullopt);
}

TEST(DescribeTrouble, CountsThoseThatAreNotDownAndSaysWhy) {
  EXPECT_EQ(DescribeTrouble(Actors(2, 0), Actors(1, 0)), "");
  // Two are not down: one works, and one is starting.
  EXPECT_EQ(DescribeTrouble(Actors(3, 1, {Down("actor-1")}), Actors(1, 1)),
            "actors 2 of 3: actor-1: exit code 1: no way to host (death 8, next try in 25 s)");
  DownProcess tried = Down("eval-0");
  tried.restart_in.reset();
  EXPECT_EQ(
      DescribeTrouble(Actors(2, 2), Actors(1, 0, {tried})),
      "no evaluation actor: eval-0: exit code 1: no way to host (death 8, being tried again)");
}

TEST(DescribeTrouble, NamesTwoAndCountsTheRest) {
  const std::string text = DescribeTrouble(
      Actors(9, 5, {Down("actor-1"), Down("actor-2"), Down("actor-3"), Down("actor-4")}), {});
  EXPECT_THAT(text,
              AllOf(HasSubstr("actors 5 of 9"), HasSubstr("actor-2:"), HasSubstr("; and 2 more")));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("actor-3")));
}

}  // namespace
}  // namespace shoal::launch
