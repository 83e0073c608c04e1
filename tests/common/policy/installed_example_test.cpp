// SPDX-License-Identifier: Apache-2.0
// The installed library as a user has it: found by CMake, without the dependencies of training.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/common/policy/actors_actions.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal::policy {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::string Output(const std::vector<std::string>& command) {
  const ProgramResult result = RunCommand(command, std::chrono::seconds(120));
  EXPECT_EQ(ExitCode(result), 0) << command[0] << "\n" << result.out << result.err;
  return result.out;
}

// The library in Installed(), and, where a test asks for them, the examples in Built().
class InstalledExampleTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = std::make_unique<TemporaryFolder>();
    for (const char* component : {"policy", "policy-dev"}) {
      Output({SHOAL_CMAKE, "--install", SHOAL_BUILD, "--prefix", Installed(), "--component",
              component});
    }
  }
  static void BuildExamples() {
    Output({SHOAL_CMAKE, "-S", SourcePath("docs/examples/policy"), "-B", Built(), "-G",
            SHOAL_CMAKE_GENERATOR, "-DCMAKE_PREFIX_PATH=" + Installed(),
            std::string("-DCMAKE_C_COMPILER=") + SHOAL_C_COMPILER,
            std::string("-DCMAKE_CXX_COMPILER=") + SHOAL_CXX_COMPILER,
            std::string("-DCMAKE_C_FLAGS=") + SHOAL_C_FLAGS,
            std::string("-DCMAKE_CXX_FLAGS=") + SHOAL_CXX_FLAGS});
    Output({SHOAL_CMAKE, "--build", Built()});
  }
  static void TearDownTestSuite() { root_.reset(); }

  static std::string Installed() { return root_->path() / "installed"; }
  static std::string Built() { return root_->path() / "built"; }
  static std::string Library() {
    return fs::path(Installed()) / SHOAL_LIBDIR / "libshoal-policy.so.0";
  }

  // Output of `program` for the checkpoint and one observation, whose file this writes.
  static ProgramResult Act(const std::string& program, const fs::path& checkpoint,
                           const RandomObservations& random) {
    const fs::path input = root_->path() / "observation";
    std::ofstream stream(input, std::ios::binary);
    const auto write = [&](const auto& values) {
      stream.write(reinterpret_cast<const char*>(values.data()),
                   std::streamsize(values.size() * sizeof values[0]));
    };
    write(random.pixels);
    for (const auto& [name, values] : random.blocks) write(values);
    stream.close();
    return RunCommand({"/bin/sh", "-c", R"("$0" "$1" < "$2")", Built() + "/" + program,
                       checkpoint.string(), input.string()},
                      std::chrono::seconds(60));
  }

  static inline std::unique_ptr<TemporaryFolder> root_;
};

TEST_F(InstalledExampleTest, ExamplesInCAndCppActAsTheActorDoes) {
  BuildExamples();
  for (const char* algorithm : {"sac", "ppo"}) {
    const RunConfig run = SmallRun(algorithm, /*pixels=*/true);
    const TemporaryFolder folder;
    const fs::path trained = WriteCheckpointOf(run, folder.path() / "run");
    const fs::path checkpoint = folder.path() / "elsewhere";
    fs::copy(trained, checkpoint);
    fs::remove_all(folder.path() / "run");

    const RandomObservations random(run.spec, 1, 17);
    const std::vector<float> expected = ActorsActions(run, checkpoint, random);
    for (const char* program : {"act_c", "act_cpp"}) {
      const ProgramResult result = Act(program, checkpoint, random);
      EXPECT_EQ(ExitCode(result), 0) << program << result.err;
      std::istringstream printed(result.out);
      std::vector<float> actions;
      for (float action = 0; printed >> action;) actions.push_back(action);
      EXPECT_EQ(actions, expected) << program << ", " << algorithm;
    }
  }
}

TEST_F(InstalledExampleTest, ExamplesSayWhatIsWrongInOneLine) {
  BuildExamples();
  const RandomObservations random(SmallRun("sac", /*pixels=*/true).spec, 1, 17);
  for (const std::string program : {"act_c", "act_cpp"}) {
    const ProgramResult result = Act(program, "/nowhere/best", random);
    EXPECT_EQ(ExitCode(result), 1);
    EXPECT_EQ(result.err, program + ": '/nowhere/best': expected a folder with a checkpoint\n");
  }
}

TEST_F(InstalledExampleTest, NeedsNothingThatOnlyTrainingNeeds) {
  const std::string needed = Output({"/usr/bin/ldd", Library()});
  EXPECT_THAT(needed, HasSubstr("libdnnl"));
  for (const char* other : {"ddsc", "mujoco", "OSMesa", "libGL", "protobuf", "libpng", "crypto"}) {
    EXPECT_THAT(needed, Not(HasSubstr(other)));
  }
}

TEST_F(InstalledExampleTest, ShowsTheFunctionsOfItsHeaderAlone) {
  std::ifstream header(SourcePath("common/policy/shoal_policy.h"));
  int declared = 0;
  for (std::string line; std::getline(header, line);) {
    declared += line.starts_with("SHOAL_POLICY_API ");
  }
  EXPECT_GT(declared, 10);

  std::istringstream symbols(Output({SHOAL_NM, "-D", "--defined-only", Library()}));
  int functions = 0;
  for (std::string line; std::getline(symbols, line);) {
    const std::string name = line.substr(line.rfind(' ') + 1);
    if (name == "SHOAL_POLICY_0") continue;  // the version itself
    EXPECT_TRUE(name.starts_with("shoal_policy_")) << name;
    ++functions;
  }
  EXPECT_EQ(functions, declared);
}

}  // namespace
}  // namespace shoal::policy
