// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/trial.h"

#include <regex>

namespace shoal {
namespace {

using enum Trial;

const std::string kInstalls = "installs on the system that the tests run on";
const std::string kOtherHosts = "needs hosts that are only in the example";
const std::string kPyPI = "takes packages from PyPI";

}  // namespace

const std::vector<TrialRule>& TrialRules() {
  static const std::vector<TrialRule> rules = {
      // Commands that build, install, measure or need another machine.
      {"^\\./run build\\b", kElsewhere, "NewProject.AnInstallationHasItsPartsWhereTheyBelong"},
      {"^\\./run (package|python|docs|bundle)\\b", kNotHere,
       "builds everything once more; a stage of its own"},
      {"^\\./run bench", kNotHere, "measures for minutes"},
      {"^(taskset -c [0-9,]+ )?build/release/bin/shoal-(bench|pictures)\\b", kNotHere,
       "measures for minutes"},
      {"^\\./run test\\b", kNotHere, "runs the tests from a test"},
      {"^cmake --install build/release --prefix ~", kElsewhere,
       "NewProject.AnInstallationHasItsPartsWhereTheyBelong"},
      {"^cmake --install .* --component policy", kElsewhere,
       "InstalledExampleTest.ExamplesInCAndCppActAsTheActorDoes"},
      {"^cmake (-S docs/examples/policy|--build /tmp/act)|/tmp/act/act_c", kElsewhere,
       "InstalledExampleTest.ExamplesInCAndCppActAsTheActorDoes"},
      {"^shoal new |^cd robot|^cmake -B build|^shoal .* point-reach", kElsewhere,
       "NewProject.BuildsAndTrainsAgainstTheInstallation"},
      {"^cmake --preset release -DSHOAL_OWN_TASKS|^ninja .* point_reach", kElsewhere,
       "OwnTaskRun.TheCommandsOfItsPageWork"},
      {"learner.algorithm=averaged_ddpg", kElsewhere, "OwnAlgorithm.LearnsABandit"},
      {"network.encoder=strided", kElsewhere,
       "OwnEncoder.IsAPlanFromWhichShapesAndParametersFollow"},
      {"^gdb ", kElsewhere, "InProcess.TheBreakpointsOfTheDebuggersScriptAreFunctionsOfTheProgram"},
      {"^cmake (--preset release -B|--build) build/training\\b", kElsewhere,
       "WithoutTools.TheProgramNeedsNoLibraryOfTheTools"},
      {"^cmake --preset debug|^ninja -C build/(debug|release shoal-simulate)", kNotHere,
       "builds everything once more"},
      {"^build/release/bin/shoal-simulate\\b", kElsewhere,
       "SimulatedRun.FixedSeedsKeepWhatIsPromised"},
      {"^sudo apt-get|^man ", kNotHere, kInstalls},
      {"^(ssh|scp) ", kNotHere, kOtherHosts},
      {"^shoal train .*--hosts", kElsewhere, "Cluster.AnActorOnAnotherHostTrains"},
      {"^sbatch ", kElsewhere, "SlurmTest.TheBatchScriptTrainsWithActorsThatSrunStarts"},
      {"^shoal experiment run .*--slurm", kElsewhere, "SlurmTest.AnExperimentIsAJobArrayOfItsRuns"},
      {"^podman ", kNotHere, "takes an image of Debian from a registry"},
      {"^pip |/bin/pip |^(/usr/bin/)?python3 -m venv", kNotHere, kPyPI},
      {"python tests/comparison/|^shoal experiment run tests/comparison/", kNotHere, kPyPI},

      {"^cmake .*(own_environment_cpp|build/catch_light)|^shoal train --env build/catch_light",
       kElsewhere, "OwnEnvironment.IsBuiltTrainedAndFilmedWithAnInstallation"},
      {"^shoal train --env .*(catch_light|CarRacing|Pendulum)", kElsewhere,
       "Environments.TheWorkedExampleIsTrainedAndFilmed"},
      {"^shoal (film|eval) light\\b", kElsewhere,
       "Environments.TheWorkedExampleIsTrainedAndFilmed"},
      {"^shoal env (check|describe) Pendulum", kElsewhere,
       "Environments.CheckSaysWhatIsObservedAndWhetherItRepeats"},
      {"^shoal .*gymnasium_robotics:", kElsewhere,
       "Environments.RewardsOfAGoalEnvironmentAreComputedForOtherGoals"},
      {"--name-map", kElsewhere, "NamedWeightsTest.AMapNamesAndPutsTogether"},
      {"--contact-sheet", kElsewhere,
       "ContactSheet.ShowsEveryTaskWithEachOfItsCamerasInAllQualities"},

      // Commands that watch or steer a running run.
      {"^(build/release/bin/)?shoal top", kElsewhere,
       "Operate.TopShowsEveryProcessUntilTheRunEnds"},
      {"^shoal (set|scale)", kElsewhere, "Operate.ARunIsSteeredWhileItGoesOnAndItsRecordSaysSo"},
      {"^shoal (attach|stop)|--detach", kElsewhere, "Operate.ADetachedRunIsAttachedToAndStopped"},
      {"^shoal web|^curl ", kElsewhere, "Web.ThePageShowsWhatTopShowsAndSteers"},

      {"\\$\\(cpu\\)|^cpu\\(\\)|api/runs/RUN\\$part", kNotHere, "measures a page for a minute"},

      // Trainings are checked, not run: two small ones have been before.
      {"\\./run train(\n|  |$)", kSmaller, "shoal train --preset fetch-reach-fast$1"},
      {"^\\./run ", kSmaller, "shoal "},
      {" --film\\b", kSmaller, ""},
      {"(shoal train [^;#\n]*[^;#\n ])", kSmaller, "$1 --dry-run"},
      {"(shoal experiment run (?!.*--out)[^;#\n]*[^;#\n ])", kSmaller, "$1 --out fresh"},
      {"(shoal experiment run (?!.*--dry-run)[^;#\n]*[^;#\n ])", kSmaller, "$1 --dry-run"},
      {"--episodes [0-9]+", kSmaller, "--episodes 1"},
      {"shoal eval (?!.*--episodes)", kSmaller, "shoal eval --episodes 1 "},
      {"(shoal film [^#\n]*[^#\n ])", kSmaller, "$1 --episodes 1"},
      {"(shoal env observability [^#\n]*) --samples [0-9]+", kSmaller, "$1"},
      {"(shoal env observability [^#\n]*) --updates [0-9]+", kSmaller, "$1"},
      {"(shoal env observability [^#\n]*[^#\n ])", kSmaller, "$1 --samples 100 --updates 2"},
      {"^cd build/release/bin$", kSmaller, ":"},
  };
  return rules;
}

std::string Tried(const std::string& command, std::vector<size_t>* used) {
  std::string text = command;
  for (size_t i = 0; i < TrialRules().size(); ++i) {
    const TrialRule& rule = TrialRules()[i];
    const std::regex pattern(rule.pattern);
    if (!std::regex_search(text, pattern)) continue;
    used->push_back(i);
    if (rule.trial != kSmaller) return ":";
    text = std::regex_replace(text, pattern, rule.text);
  }
  return text;
}

}  // namespace shoal
