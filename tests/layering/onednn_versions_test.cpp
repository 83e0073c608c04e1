// SPDX-License-Identifier: Apache-2.0
// Sources use no declaration that oneDNN 2 has and oneDNN 3 has not, or has by another name: those
// are wrapped in common/nn/primitive_descs.h. A machine has one version and compiles with it alone.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Methods of a memory's description, and descriptions of operations apart from their primitives.
std::vector<std::string> FaultsOf(const std::string& file, const std::string& text) {
  static const std::regex of_one_version(
      R"(\.(get_)?(dims|data_type)\(\)|\bdnnl::\w+(_forward|_backward)::desc\b)");
  std::vector<std::string> faults;
  for (std::sregex_iterator at(text.begin(), text.end(), of_one_version), end; at != end; ++at) {
    faults.push_back(fmt::format("{}: {}", file, at->str()));
  }
  return faults;
}

TEST(OneDnnVersions, DeclarationsOfOneVersionAreWrapped) {
  std::vector<std::string> faults;
  int looked = 0;
  for (const char* folder : {"common/nn", "tests/common/nn"}) {
    for (const auto& entry : fs::recursive_directory_iterator(SourcePath(folder))) {
      const std::string name = entry.path().filename();
      if (!name.ends_with(".h") && !name.ends_with(".cpp")) continue;
      if (name == "primitive_descs.h") continue;
      ++looked;
      for (const std::string& fault : FaultsOf(name, ReadFile(entry.path()))) {
        faults.push_back(fault);
      }
    }
  }
  EXPECT_GT(looked, 50);
  EXPECT_THAT(faults, IsEmpty());
}

TEST(OneDnnVersions, ADeclarationOfOneVersionIsFound) {
  EXPECT_THAT(FaultsOf("a.cpp", "auto n = desc.dims();"), ElementsAre("a.cpp: .dims()"));
  EXPECT_THAT(FaultsOf("a.cpp", "m.get_desc().get_data_type()"),
              ElementsAre("a.cpp: .get_data_type()"));
  EXPECT_THAT(FaultsOf("a.cpp", "dnnl::convolution_forward::desc(x)"),
              ElementsAre("a.cpp: dnnl::convolution_forward::desc"));
  EXPECT_THAT(FaultsOf("a.cpp", "DimsOf(desc); dnnl::memory::desc(x); dims()"), IsEmpty());
}

}  // namespace
}  // namespace shoal
