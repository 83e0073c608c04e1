// SPDX-License-Identifier: Apache-2.0
#include "common/base/numa_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(ParseCpuList, ReadsRangesAndSingleCpus) {
  EXPECT_THAT(ParseCpuList("0\n", "f"), ElementsAre(0));
  EXPECT_THAT(ParseCpuList("0-3", "f"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(ParseCpuList("0-2,16-17,31\n", "f"), ElementsAre(0, 1, 2, 16, 17, 31));
  EXPECT_THAT(ParseCpuList("5-5,1", "f"), ElementsAre(1, 5));
  EXPECT_THAT(ParseCpuList("", "f"), IsEmpty());
  EXPECT_THAT(ParseCpuList("\n", "f"), IsEmpty()) << "a node of memory alone";
}

TEST(ParseCpuList, RefusesOtherTextsAndNamesTheirSource) {
  for (const char* text : {"x", "-1", "3-", "3-1", "1,,2", "1,", ",1", "0-3 5", " 1", "1\n\n",
                           "0-99999999", "99999999999999999999"}) {
    EXPECT_THAT([&] { ParseCpuList(text, "some/cpulist"); },
                ThrowsMessage<Error>(HasSubstr("'some/cpulist': '")))
        << text;
  }
}

// A machine's /sys as files.
class NumaNodesTest : public testing::Test {
 protected:
  void Write(const std::string& path, const std::string& content) {
    const std::filesystem::path file = folder_.path() / "sys/devices/system" / path;
    MakeFolders(file.parent_path());
    WriteFileAtomically(file, content);
  }
  void WriteNode(int number, const std::string& cpus) {
    Write("node/node" + std::to_string(number) + "/cpulist", cpus + "\n");
  }
  // Core c has the CPUs c and c + `cores` if there are two `threads` a core, else c alone.
  void WriteCores(int cores, int threads = 1) {
    for (int cpu = 0; cpu < cores * threads; ++cpu) {
      const int core = cpu % cores;
      std::string siblings = std::to_string(core);
      if (threads == 2) siblings += "," + std::to_string(core + cores);
      Write("cpu/cpu" + std::to_string(cpu) + "/topology/thread_siblings_list", siblings + "\n");
    }
  }
  std::vector<NumaNode> Nodes(const std::vector<int>& allowed) {
    return ReadNumaNodes(allowed, folder_.path());
  }

  TemporaryFolder folder_;
};

TEST_F(NumaNodesTest, WithoutTheFolderThereAreNone) { EXPECT_THAT(Nodes({0, 1}), IsEmpty()); }

TEST_F(NumaNodesTest, OneNodeHasAllCpus) {
  WriteCores(4);
  WriteNode(0, "0-3");
  EXPECT_THAT(Nodes({0, 1, 2, 3}), ElementsAre(NumaNode{0, {0, 1, 2, 3}, 4}));
}

TEST_F(NumaNodesTest, ThereAreOnlyCpusThatTheProcessMayUse) {
  WriteCores(12);
  WriteNode(0, "0-3");
  WriteNode(1, "4-7");
  WriteNode(10, "8-11");
  WriteNode(2, "");  // memory alone
  Write("node/online", "0-2,10\n");
  EXPECT_THAT(Nodes({1, 2, 9, 10, 11}),
              ElementsAre(NumaNode{0, {1, 2}, 2}, NumaNode{10, {9, 10, 11}, 3}));
}

TEST_F(NumaNodesTest, HyperThreadsOfACoreCountAsOneCore) {
  WriteCores(4, 2);
  WriteNode(0, "0-1,4-5");
  WriteNode(1, "2-3,6-7");
  EXPECT_THAT(Nodes({0, 1, 2, 3, 4, 5, 6, 7}),
              ElementsAre(NumaNode{0, {0, 1, 4, 5}, 2}, NumaNode{1, {2, 3, 6, 7}, 2}));
  EXPECT_THAT(Nodes({1, 5, 6}), ElementsAre(NumaNode{0, {1, 5}, 1}, NumaNode{1, {6}, 1}));
}

TEST_F(NumaNodesTest, AnAbsentOrMalformedListIsAnErrorThatNamesIt) {
  WriteCores(2);
  WriteNode(0, "0");
  MakeFolders(folder_.path() / "sys/devices/system/node/node1");
  EXPECT_THAT([&] { Nodes({0, 1}); }, ThrowsMessage<Error>(HasSubstr("node/node1/cpulist'")));
  WriteNode(1, "many");
  EXPECT_THAT(
      [&] {
        Nodes({0, 1});
      },
      ThrowsMessage<Error>(HasSubstr("node/node1/cpulist': 'many")));
  WriteNode(1, "1,7");
  EXPECT_THAT(Nodes({0, 1}), ElementsAre(NumaNode{0, {0}, 1}, NumaNode{1, {1}, 1}));
  EXPECT_THAT([&] { Nodes({0, 1, 7}); }, ThrowsMessage<Error>(HasSubstr("cpu/cpu7/topology")));
}

std::vector<NumaNode> NodesOf(const std::vector<int>& cores) {
  std::vector<NumaNode> nodes;
  nodes.reserve(cores.size());
  for (const int count : cores) nodes.push_back({int(nodes.size()), {}, count});
  return nodes;
}

TEST(NodeFor, IsTheFirstOfTheLargestWhereTheThreadsFit) {
  const auto number = [](int threads, const std::vector<NumaNode>& nodes) {
    const NumaNode* node = NodeFor(threads, nodes);
    return node == nullptr ? -1 : node->number;
  };
  EXPECT_EQ(number(1, NodesOf({8, 8})), 0);
  EXPECT_EQ(number(8, NodesOf({8, 8})), 0);
  EXPECT_EQ(number(9, NodesOf({8, 8})), -1);
  EXPECT_EQ(number(2, NodesOf({2, 8, 4, 8})), 1) << "also where a smaller one would do";
  EXPECT_EQ(number(1, NodesOf({8})), -1) << "there is no other to stay away from";
  EXPECT_EQ(number(1, {}), -1);
}

}  // namespace
}  // namespace shoal
