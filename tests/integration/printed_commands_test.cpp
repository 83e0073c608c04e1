// SPDX-License-Identifier: Apache-2.0
// Commands that the programs print work as printed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kDeadline{120};

// A command line as a source spells it: sub-commands and the options that follow.
struct Spelled {
  std::string source;                 // FILE: TEXT
  std::vector<std::string> commands;  // "env", "render"
  std::vector<std::string> options;   // "--quality"
};

// `shoal --help`, `shoal env --help`, ...; empty: no such command. Asked once.
const std::string& HelpOf(const std::vector<std::string>& commands) {
  static std::map<std::vector<std::string>, std::string> known;
  const auto [at, fresh] = known.emplace(commands, "");
  if (fresh) {
    std::vector<std::string> command{"shoal"};
    command.insert(command.end(), commands.begin(), commands.end());
    command.emplace_back("--help");
    const ProgramResult help = RunProgram(command, kDeadline);
    if (ExitCode(help) == 0) at->second = help.out;
  }
  return at->second;
}

// Commands in the string literals of a source. An unknown word counts as a command only if an
// option follows it, so that prose about Shoal does not count.
std::vector<Spelled> CommandsIn(const fs::path& file) {
  static const std::regex kLiteral(R"rx("(?:[^"\\\n]|\\.)*")rx");
  static const std::regex kCommand(R"(\bshoal ([a-z]+)((?: [A-Za-z0-9{}=_./-]+)*))");
  std::vector<Spelled> found;
  std::string text = ReadFile(file);
  // Literals that the compiler joins are one text.
  text = std::regex_replace(text, std::regex("\"\\s*\\n\\s*\""), "");
  for (std::sregex_iterator literal(text.begin(), text.end(), kLiteral), none; literal != none;
       ++literal) {
    const std::string inside = literal->str();
    for (std::sregex_iterator it(inside.begin(), inside.end(), kCommand); it != none; ++it) {
      Spelled spelled{file.filename().string() + ": " + it->str(), {(*it)[1]}, {}};
      std::istringstream words((*it)[2]);
      for (std::string word; words >> word;) {
        if (word.starts_with("--")) {
          spelled.options.push_back(word.substr(0, word.find('=')));
        } else if (spelled.options.empty() && spelled.commands.size() == 1 &&
                   (spelled.commands[0] == "env" || spelled.commands[0] == "experiment")) {
          spelled.commands.push_back(word);
        }
      }
      found.push_back(std::move(spelled));
    }
  }
  return found;
}

TEST(PrintedCommands, ThoseOfTheSourcesAreCommandsWithTheirOptions) {
  size_t looked_at = 0;
  for (const char* room : {"actor", "common", "launch", "learner", "replay_server"}) {
    for (const auto& entry : fs::recursive_directory_iterator(SourcePath(room))) {
      const std::string kind = entry.path().extension();
      if (kind != ".cpp" && kind != ".h" && kind != ".js") continue;
      for (const Spelled& spelled : CommandsIn(entry.path())) {
        std::vector<std::string> commands = spelled.commands;
        if (commands.size() == 2 && HelpOf(commands).empty()) commands.pop_back();  // prose
        const std::string& help = HelpOf(commands);
        EXPECT_FALSE(help.empty()) << spelled.source << ": no such command";
        for (const std::string& option : spelled.options) {
          EXPECT_THAT(help, HasSubstr(option)) << spelled.source;
        }
        ++looked_at;
      }
    }
  }
  EXPECT_GT(looked_at, 30u) << "the sources name more than that";
}

// Runs the lines in a folder of their own with the programs in the PATH, as a user would.
void ExpectAllWork(const std::vector<std::string>& lines) {
  const TemporaryFolder elsewhere;
  const std::string bin = fs::path(ProgramPath("shoal")).parent_path();
  for (const std::string& line : lines) {
    const ProgramResult result =
        RunCommand({"/bin/sh", "-c",
                    "cd " + elsewhere.path().string() + " && PATH=" + bin + ":$PATH && " + line},
                   kDeadline);
    EXPECT_EQ(ExitCode(result), 0) << line << "\n" << result.out << result.err;
  }
}

// "shoal plot /x" of "curves: shoal plot /x; page: ...".
std::vector<std::string> CommandsOf(const std::string& said) {
  static const std::regex kCommand(R"(: (shoal [a-z]+ [^;,\n]+))");
  std::vector<std::string> commands;
  for (std::sregex_iterator it(said.begin(), said.end(), kCommand), none; it != none; ++it) {
    commands.push_back((*it)[1]);
  }
  return commands;
}

TEST(PrintedCommands, ThoseOfARunsEndWork) {
  const TrainingRun run;
  const ProgramResult trained = run.Train({{"env_steps", "2000"}, {"eval.interval", "500"}});
  ASSERT_EQ(ExitCode(trained), 0) << trained.err;
  // Before that it prints how to watch it while it runs.
  const std::vector<std::string> commands =
      CommandsOf(trained.out.substr(trained.out.find(" ended (")));
  EXPECT_EQ(commands.size(), 3u) << "plot, report, film\n" << trained.out << trained.err;
  ExpectAllWork(commands);
  // A checkpoint that is copied away and a card can act without the run.
  const std::string path = run.path().string();
  ExpectAllWork({"cp -r " + path + "/checkpoints/best ck && mv " + path + " " + path + "-away && " +
                     "shoal eval ck --episodes 2 && shoal film ck --episodes 1 && " +
                     "shoal export ck --onnx policy.onnx; status=$?; mv " + path + "-away " + path +
                     "; exit $status",
                 "shoal card " + path + " --output card && shoal eval card --episodes 2 && " +
                     "shoal film card --episodes 1"});
}

}  // namespace
}  // namespace shoal
