#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/layering/include_rules.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::filesystem::path kSourceTree = std::filesystem::path(SHOAL_TEST_DATA) / "../..";

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

TEST(Layering, LibrariesStayAtHome) {
  const PlantedTree tree;
  tree.Write("actor/a.cpp", "#include <mujoco/mujoco.h>\n");
  tree.Write("common/wire/a.cpp", "#include \"dds/dds.h\"\n");
  tree.Write("learner/a.cpp", "#include <dnnl.hpp>\n");
  EXPECT_THAT(tree.Breaches(),
              ElementsAre("actor/a.cpp:1: <mujoco/mujoco.h> belongs to actor/worlds alone",
                          "common/wire/a.cpp:1: <dds/dds.h> belongs to common/dds alone",
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
