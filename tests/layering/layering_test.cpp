// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/layering/include_rules.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::filesystem::path kSourceTree = SourcePath("");

// A source tree with base before wire in common.
class PlantedTree {
 public:
  PlantedTree() {
    Write("common/CMakeLists.txt", "add_subdirectory(base)\nadd_subdirectory(wire)\n");
  }
  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    std::ofstream(folder_.path() / file) << text;
  }
  std::vector<std::string> Breaches() const { return FindBreaches(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

TEST(Layering, TheSourceTreeKeepsItsRules) {
  ASSERT_GT(CountSources(kSourceTree), 50u);
  EXPECT_THAT(FindBreaches(kSourceTree), IsEmpty());
}

TEST(Layering, UsingFoldersBeforeOneIsAllowed) {
  const PlantedTree tree;
  tree.Write("common/wire/a.cpp", "#include \"common/base/x.h\"\n#include \"common/wire/y.h\"\n");
  tree.Write("actor/a.cpp", "#include \"common/wire/x.h\"\n#include \"actor/worlds/y.h\"\n");
  tree.Write("launch/a.cpp", "#include \"actor/x.h\"\n#include \"learner/x.h\"\n");
  tree.Write("tests/learner/a.cpp", "#include \"learner/x.h\"\n#include \"launch/x.h\"\n");
  tree.Write("common/dds/a.cpp", "#include <dds/dds.h>\n");
  tree.Write("tests/common/dds/a.cpp", "#include \"dds/dds.h\"\n");
  EXPECT_THAT(tree.Breaches(), IsEmpty());
}

TEST(Layering, CommonKeepsItsOrderAndUsesNobodyElse) {
  const PlantedTree tree;
  tree.Write("common/base/a.cpp", "#include <vector>\n#include \"common/wire/x.h\"\n");
  tree.Write("common/wire/a.cpp", "  #  include \"actor/x.h\"\n");
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("common/base/a.cpp:2: common/base may not use common/wire/x.h",
                          "common/wire/a.cpp:1: common/wire may not use actor/x.h"));
}

TEST(Layering, RoomsDoNotUseEachOtherNorWhatComesAfterThem) {
  const PlantedTree tree;
  tree.Write("actor/a.cpp", "#include \"learner/x.h\"\n");
  tree.Write("learner/a.cpp", "#include \"launch/x.h\"\n");
  tree.Write("launch/a.cpp", "#include \"tests/support/x.h\"\n");
  EXPECT_THAT(tree.Breaches(), ElementsAre("actor/a.cpp:1: actor may not use learner/x.h",
                                           "launch/a.cpp:1: launch may not use tests/support/x.h",
                                           "learner/a.cpp:1: learner may not use launch/x.h"));
}

TEST(Layering, TheRoomsOfLaunchPointOneWay) {
  const PlantedTree tree;
  tree.Write("launch/check/a.cpp", "#include \"launch/commands/x.h\"\n");
  tree.Write("launch/commands/a.cpp", "#include \"launch/check/x.h\"\n");
  tree.Write("launch/main.cpp", "#include \"launch/commands/x.h\"\n");
  tree.Write("launch/processes/a.cpp", "#include \"launch/watch/x.h\"\n");
  tree.Write("launch/record/a.cpp",
             "#include \"launch/record/x.h\"\n#include \"launch/processes/x.h\"\n");
  tree.Write("launch/run/a.cpp", "#include \"launch/new_room/x.h\"\n");
  tree.Write("launch/watch/a.cpp",
             "#include \"launch/record/x.h\"\n#include \"launch/main_parts.h\"\n");
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("launch/check/a.cpp:1: launch/check may not use launch/commands/x.h",
                          "launch/processes/a.cpp:1: launch/processes may not use launch/watch/x.h",
                          "launch/record/a.cpp:2: launch/record may not use launch/processes/x.h",
                          "launch/run/a.cpp:1: launch/run may not use launch/new_room/x.h",
                          "launch/watch/a.cpp:2: launch/watch may not use launch/main_parts.h"));
}

TEST(Layering, TheReplayCoreKnowsNoServiceTransportClockOrThread) {
  const PlantedTree tree;
  tree.Write("replay_server/core/a.cpp",
             "#include <atomic>\n"
             "#include <chrono>\n"
             "#include <mutex>\n"
             "#include \"common/base/clock.h\"\n"
             "#include \"common/base/mutex.h\"\n"
             "#include \"common/dds/bus.h\"\n"
             "#include \"replay_server/core/x.h\"\n"
             "#include \"replay_server/service/x.h\"\n");
  tree.Write("replay_server/service/a.cpp",
             "#include \"common/base/clock.h\"\n"
             "#include \"common/link/hub.h\"\n"
             "#include \"replay_server/core/x.h\"\n");
  const std::string start = "replay_server/core/a.cpp:", core = ": replay_server/core may not use ";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre(start + "2" + core + "chrono: no clock here",
                          start + "3" + core + "mutex: no threads here",
                          start + "4" + core + "common/base/clock.h: no clock here",
                          start + "5" + core + "common/base/mutex.h: no threads here",
                          start + "6" + core + "common/dds/bus.h: no transport here",
                          start + "8" + core +
                              "replay_server/service/x.h: the core knows nothing of its service"));
}

TEST(Layering, ARoleKnowsTheLinkAlone) {
  const PlantedTree tree;
  for (const char* file :
       {"actor/loop/a.cpp", "actor/program.cpp", "learner/a.cpp", "learner/main.cpp",
        "replay_server/main.cpp", "replay_server/service/a.cpp"}) {
    tree.Write(file, "#include \"common/dds/bus.h\"\n");
  }
  const std::string why =
      " may not use common/dds/bus.h: a role knows the link alone (common/link)";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("actor/loop/a.cpp:1: actor/loop" + why, "learner/a.cpp:1: learner" + why,
                          "replay_server/service/a.cpp:1: replay_server/service" + why));
}

TEST(Layering, AClientKnowsTheLinkAndItsConnectionAnImplementation) {
  const PlantedTree tree;
  for (const char* file : {"launch/client/run_connection.cpp", "launch/client/run_orders.cpp"}) {
    tree.Write(file, "#include \"common/dds/bus.h\"\n");
  }
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("launch/client/run_orders.cpp:1: launch/client may not use "
                          "common/dds/bus.h: a client knows the link alone (common/link)"));
}

TEST(Layering, ASimulationCanRunTheRoles) {
  const PlantedTree tree;
  tree.Write("launch/client/a.cpp", "#include <thread>\n");
  tree.Write("actor/loop/a.cpp", "#include <thread>\n#include \"common/base/sleep.h\"\n");
  tree.Write("launch/run/a.cpp", "#include <mutex>\n");
  tree.Write("launch/tools/web/a.cpp", "#include <mutex>\n");
  const std::string why = ": waits and threads are those of common/base (scheduler.h)";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("actor/loop/a.cpp:1: actor/loop may not use thread" + why,
                          "launch/client/a.cpp:1: launch/client may not use thread" + why,
                          "launch/run/a.cpp:1: launch/run may not use mutex" + why));
}

TEST(Layering, AnAgentKnowsNoTransportClockFileOrThread) {
  const PlantedTree tree;
  tree.Write("learner/agent/replicated_agent.cpp",
             "#include \"common/nn/team.h\"\n#include \"common/base/clock.h\"\n");
  tree.Write("learner/agent/sac/a.cpp",
             "#include <fstream>\n"
             "#include <thread>\n"
             "#include \"common/base/clock.h\"\n"
             "#include \"common/dds/bus.h\"\n"
             "#include \"common/nn/team.h\"\n"
             "#include \"common/nn/x.h\"\n"
             "#include <fcntl.h>\n"
             "#include \"common/checkpoint/x.h\"\n"
             "#include \"common/config/run_config.h\"\n"
             "#include \"common/config/run_files.h\"\n"
             "#include \"common/run_folder/x.h\"\n");
  tree.Write("learner/a.cpp",
             "#include <fstream>\n"
             "#include \"common/base/clock.h\"\n"
             "#include \"common/run_folder/x.h\"\n");
  const std::string start = "learner/agent/sac/a.cpp:", room = ": learner/agent may not use ";
  const std::string files = ": an agent is in memory: checkpoints are kept for it";
  EXPECT_THAT(
      tree.Breaches(),
      ElementsAre(
          "learner/agent/replicated_agent.cpp:2" + room + "common/base/clock.h: no clock here",
          start + "1" + room + "fstream" + files, start + "2" + room + "thread: no threads here",
          start + "3" + room + "common/base/clock.h: no clock here",
          start + "4" + room + "common/dds/bus.h: no transport here",
          start + "5" + room + "common/nn/team.h: its threads are those of replicas",
          start + "7" + room + "fcntl.h" + files,
          start + "8" + room + "common/checkpoint/x.h" + files,
          start + "10" + room + "common/config/run_files.h" + files,
          start + "11" + room + "common/run_folder/x.h" + files));
}

TEST(Layering, AnAlgorithmDoesNotLookIntoArrays) {
  const PlantedTree tree;
  for (const char* file : {"learner/agent/sac/a.cpp", "learner/agent/a.cpp",
                           "learner/agent/ppo/a.cpp", "learner/engine/a.cpp"}) {
    tree.Write(file, "#include \"common/nn/array.h\"\n#include \"common/nn/host_memory.h\"\n");
  }
  const std::string why =
      ":2: learner/agent may not use common/nn/host_memory.h: an algorithm does not look into "
      "arrays";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("learner/agent/a.cpp" + why, "learner/agent/ppo/a.cpp" + why,
                          "learner/agent/sac/a.cpp" + why));
}

TEST(Layering, AnEngineKnowsNoAlgorithmClockOrFile) {
  const PlantedTree tree;
  tree.Write("learner/engine/a.cpp",
             "#include \"learner/agent/x.h\"\n"
             "#include \"common/base/clock.h\"\n"
             "#include <fstream>\n");
  const std::string start = "learner/engine/a.cpp:", room = ": learner/engine may not use ";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre(start + "1" + room + "learner/agent/x.h",
                          start + "2" + room + "common/base/clock.h: no clock here",
                          start + "3" + room + "fstream: an engine computes"));
}

TEST(Layering, TheRoomsOfTheLearnerPointOneWay) {
  const PlantedTree tree;
  tree.Write("learner/a.cpp",
             "#include \"learner/agent/x.h\"\n"
             "#include \"learner/batch_stream.h\"\n"
             "#include \"learner/rollouts/x.h\"\n");
  tree.Write("learner/agent/sac/a.cpp",
             "#include \"learner/agent/x.h\"\n"
             "#include \"learner/batch_stream.h\"\n"
             "#include \"learner/checkpoint.h\"\n"
             "#include \"learner/rollouts/x.h\"\n");
  tree.Write("learner/batch_stream.h",
             "#pragma once\n#include \"learner/agent/x.h\"\n#include \"learner/x.h\"\n");
  tree.Write("learner/rollouts/a.cpp",
             "#include \"learner/batch_stream.h\"\n"
             "#include \"learner/rollouts/x.h\"\n"
             "#include \"learner/training_loop.h\"\n");
  const std::string agent = "learner/agent/sac/a.cpp:", no = ": learner/agent may not use ";
  EXPECT_THAT(tree.Breaches(),
              ElementsAre(agent + "2" + no + "learner/batch_stream.h",
                          agent + "3" + no + "learner/checkpoint.h",
                          agent + "4" + no + "learner/rollouts/x.h",
                          "learner/batch_stream.h:3: learner may not use learner/x.h",
                          "learner/rollouts/a.cpp:3: learner/rollouts may not use "
                          "learner/training_loop.h"));
}

TEST(Layering, TheRoomsOfTheReplayServerPointOneWay) {
  const PlantedTree tree;
  tree.Write("replay_server/core/a.cpp", "#include \"replay_server/x.h\"\n");
  tree.Write("replay_server/main.cpp", "#include \"replay_server/service/x.h\"\n");
  tree.Write("replay_server/service/a.cpp",
             "#include \"replay_server/core/x.h\"\n#include \"replay_server/x.h\"\n");
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("replay_server/core/a.cpp:1: replay_server/core may not use "
                          "replay_server/x.h",
                          "replay_server/service/a.cpp:2: replay_server/service may not use "
                          "replay_server/x.h"));
}

TEST(Layering, TheRoomsOfTheActorPointOneWayAndWorldsUseNone) {
  const PlantedTree tree;
  tree.Write("actor/acting/a.cpp",
             "#include \"actor/worlds/x.h\"\n#include \"actor/sending/x.h\"\n");
  tree.Write("actor/main.cpp", "#include \"actor/loop/x.h\"\n");
  tree.Write("actor/sending/a.cpp", "#include \"actor/loop/x.h\"\n");
  tree.Write("actor/worlds/a.cpp", "#include \"actor/worlds/x.h\"\n#include \"actor/rollout.h\"\n");
  tree.Write("actor/worlds/tools/a.cpp", "#include \"actor/acting/x.h\"\n");
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("actor/acting/a.cpp:2: actor/acting may not use actor/sending/x.h",
                          "actor/sending/a.cpp:1: actor/sending may not use actor/loop/x.h",
                          "actor/worlds/a.cpp:2: actor/worlds may not use actor/rollout.h",
                          "actor/worlds/tools/a.cpp:1: actor/worlds may not use actor/acting/x.h"));
}

TEST(Layering, NothingOfARunUsesATool) {
  const PlantedTree tree;
  const std::string tool = "#include \"launch/tools/film/x.h\"\n";
  const std::vector<std::string> rooms = {"check",  "commands", "processes",
                                          "record", "run",      "watch"};
  std::vector<std::string> breaches;
  for (const std::string& room : rooms) {
    tree.Write("launch/" + room + "/a.cpp", tool);
    breaches.push_back("launch/" + room + "/a.cpp:1: launch/" + room +
                       " may not use launch/tools/film/x.h");
  }
  tree.Write("launch/tools/commands/a.cpp", tool + "#include \"launch/commands/x.h\"\n");
  tree.Write("launch/tools/film/a.cpp", "#include \"launch/tools/commands/x.h\"\n");
  breaches.push_back(
      "launch/tools/film/a.cpp:1: launch/tools/film may not use "
      "launch/tools/commands/x.h");
  EXPECT_THAT(tree.Breaches(), testing::UnorderedElementsAreArray(breaches));
}

TEST(Layering, LibrariesStayAtHome) {
  const PlantedTree tree;
  tree.Write("actor/a.cpp", "#include <mujoco/mujoco.h>\n");
  tree.Write("common/wire/a.cpp", "#include \"dds/dds.h\"\n");
  tree.Write("launch/tools/film/a.cpp", "#include <cairo.h>\n#include <libavcodec/avcodec.h>\n");
  tree.Write("launch/run/a.cpp", "#include <cairo.h>\n#include <libavcodec/avcodec.h>\n");
  tree.Write("learner/a.cpp", "#include <dnnl.hpp>\n");
  EXPECT_THAT(
      tree.Breaches(),
      ElementsAre("actor/a.cpp:1: <mujoco/mujoco.h> belongs to actor/worlds alone",
                  "common/wire/a.cpp:1: <dds/dds.h> belongs to common/dds alone",
                  "launch/run/a.cpp:1: <cairo.h> belongs to launch/tools/film alone",
                  "launch/run/a.cpp:2: <libavcodec/avcodec.h> belongs to launch/tools/film alone",
                  "learner/a.cpp:1: <dnnl.hpp> belongs to common/nn alone"));
}

TEST(Layering, HeadersAreGuardedAndNamesSaySomething) {
  const PlantedTree tree;
  tree.Write("actor/a.h", "// no guard\n");
  tree.Write("learner/helpers/a.cpp", "\n");
  tree.Write("learner/utils.h", "#pragma once\n");
  EXPECT_THAT(tree.Breaches(), ElementsAre("actor/a.h:1: no #pragma once",
                                           "learner/helpers/a.cpp:1: \"helpers\" says nothing",
                                           "learner/utils.h:1: \"utils.h\" says nothing"));
}

}  // namespace
}  // namespace shoal
