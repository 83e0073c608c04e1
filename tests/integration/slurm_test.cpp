// SPDX-License-Identifier: Apache-2.0
// launch/slurm/train.sbatch and `shoal experiment run --slurm` under a Slurm of the test's own:
// controller, node and authentication on this machine, in a scratch folder. If SHOAL_SLURM_PROGRAMS
// names a folder, for example bin of an unpacked bundle, train.sbatch starts its programs instead
// of those of this build.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "common/base/clock.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/tiny_experiment.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

bool Never() { return false; }

class SlurmTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "srun"}) {
      if (!Run({"sh", "-c", std::string("command -v ") + program})) {
        GTEST_SKIP() << "needs " << program << " (Debian's slurm-wlm and munge)";
      }
    }
    if (geteuid() != 0) GTEST_SKIP() << "needs root: slurmd starts jobs for their users";
    StartMunge();
    WriteFileAtomically(conf_, Configuration());
    // Debian 13's slurmd does not start otherwise where no cgroups are mounted, as in containers.
    // Debian 12's (22.05) does not know this plugin.
    if (!Run({"sh", "-c", "slurmd -V | grep -q ' 22[.]'"})) {
      WriteFileAtomically(folder_.path() / "cgroup.conf", "CgroupPlugin=disabled\n");
    }
    setenv("SLURM_CONF", conf_.c_str(), 1);
    ASSERT_TRUE(Run({"slurmctld", "-f", conf_})) << Said();
    ASSERT_TRUE(Run({"slurmd", "-f", conf_})) << Said();
    const SteadyTime end = Now() + seconds(40);
    while (!Run({"sh", "-c", "test \"$(sinfo -h -o %t)\" = idle"})) {
      ASSERT_LT(Now(), end) << "the node does not become idle\n"
                            << Log("slurmctld.log") << Log("slurmd.log");
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  }
  void TearDown() override {
    for (const char* daemon : {"slurmd", "slurmctld", "munged"}) {
      const fs::path file = folder_.path() / (std::string(daemon) + ".pid");
      if (fs::exists(file)) kill(std::stoi(ReadFile(file)), SIGTERM);
      const SteadyTime end = Now() + seconds(10);
      while (fs::exists(file) && Now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    }
    unsetenv("SLURM_CONF");
  }

  void StartMunge() const {
    const std::string folder = folder_.path();
    WriteFileAtomically(folder_.path() / "munge.key",
                        std::string(64, 'k') + std::to_string(getpid()));
    ASSERT_TRUE(Run({"munged", "--force", "--key-file=" + folder + "/munge.key",
                     "--socket=" + folder + "/munge.socket", "--pid-file=" + folder + "/munged.pid",
                     "--log-file=" + folder + "/munged.log", "--seed-file=" + folder + "/seed"}))
        << Said();
  }

  std::string Configuration() const {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    const std::string host = std::string(name.data()).substr(0, std::string(name.data()).find('.'));
    const int port = 20'000 + getpid() % 10'000;
    return fmt::format(
        "ClusterName=shoal\nSlurmctldHost={0}(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\n"
        "SlurmctldPort={2}\nSlurmdPort={3}\nStateSaveLocation={1}\nSlurmdSpoolDir={1}/spool\n"
        "SlurmctldPidFile={1}/slurmctld.pid\nSlurmdPidFile={1}/slurmd.pid\n"
        "SlurmctldLogFile={1}/slurmctld.log\nSlurmdLogFile={1}/slurmd.log\n"
        "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n"
        "SelectTypeParameters=CR_Core\nAuthType=auth/munge\nAuthInfo=socket={1}/munge.socket\n"
        "CredType=cred/munge\nMpiDefault=none\nReturnToService=2\n"
        "NodeName={0} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN\n"
        "PartitionName=all Nodes=ALL Default=YES State=UP\n",
        host, folder_.path().string(), port, port + 1);
  }

  // Runs a program of the system; whether it ended well.
  bool Run(std::vector<std::string> command, seconds deadline = seconds(30)) const {
    command.insert(command.begin(), "/usr/bin/env");
    launch::ProcessSpec spec;
    spec.command = std::move(command);
    spec.output = folder_.path() / "said";
    const auto status = launch::RunToEnd(spec, deadline, Never);
    return status && status->Clean();
  }
  std::string Said() const { return Log("said"); }
  void ExpectTrainsWithActorsThatSrunStarts(const TrainingRun& run,
                                            const std::vector<std::string>& train);
  std::string Log(const std::string& name) const {
    const fs::path file = folder_.path() / name;
    return fs::exists(file) ? ReadFile(file) : "";
  }

  const TemporaryFolder folder_;
  const fs::path conf_ = folder_.path() / "slurm.conf";
};

// Runs as a job; `train` is "shoal train ...".
void SlurmTest::ExpectTrainsWithActorsThatSrunStarts(const TrainingRun& run,
                                                     const std::vector<std::string>& train) {
  const char* programs = std::getenv("SHOAL_SLURM_PROGRAMS");
  const fs::path output = folder_.path() / "job";
  std::vector<std::string> command{"sbatch",
                                   "--wait",
                                   "--quiet",
                                   "--cpus-per-task=2",
                                   "--output=" + output.string(),
                                   "--export=ALL,SHOAL_ADDRESS=127.0.0.1,SHOAL_RUNS_SHARED=false,"
                                   "SHOAL_ACTORS_PER_NODE=2,SHOAL_BIN=" +
                                       (programs ? std::string(programs) : ProgramPath("")),
                                   SourcePath("launch/slurm/train.sbatch")};
  command.insert(command.end(), train.begin() + 2, train.end());  // without "shoal train"
  ASSERT_TRUE(Run(command, seconds(150))) << Said() << Log("job") << Log("slurmd.log");

  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_EQ(meta.at("accounting").at("sessions_without_page"), 0);
  const auto hosts = run.Json("hosts.json");
  EXPECT_EQ(hosts.at("hosts").at(0).at("ssh").at(0), "srun");
  EXPECT_EQ(hosts.at("hosts").at(0).at("actors"), 1) << "half of two: this node learns, too";
  EXPECT_EQ(run.Json("config.json").at("actors"), 1) << "no other actor but srun's";
}

TEST_F(SlurmTest, TheBatchScriptTrainsWithActorsThatSrunStarts) {
  const TrainingRun run;
  ExpectTrainsWithActorsThatSrunStarts(run, run.Command({{"env_steps", "4000"}}));
}

TEST_F(SlurmTest, OnPolicyTheirRolloutsGoToTheLearner) {
  const TrainingRun run;
  ExpectTrainsWithActorsThatSrunStarts(run, run.OnPolicyCommand({{"env_steps", "4000"}}));
  EXPECT_GT(run.Json("meta.json").at("updates"), 0);
}

TEST_F(SlurmTest, AnExperimentIsAJobArrayOfItsRuns) {
  const fs::path definition = folder_.path() / "mine.json", out = folder_.path() / "experiment";
  WriteFileAtomically(definition, TinyExperiment().dump());
  const auto submit = [&](const std::vector<std::string>& flags = {}) {
    std::vector<std::string> command{"shoal", "experiment", "run",    definition,
                                     "--out", out,          "--slurm"};
    command.insert(command.end(), flags.begin(), flags.end());
    return RunProgram(command, seconds(120));
  };
  const ProgramResult held = submit({"--sbatch=--hold"});
  ASSERT_EQ(ExitCode(held), 0) << held.err;
  const auto job = nlohmann::json::parse(held.out);
  EXPECT_EQ(job.at("runs"), nlohmann::json({"a-s0", "b-s0"}));
  const std::string id = job.at("job");
  const ProgramResult again = submit();
  EXPECT_EQ(ExitCode(again), 2) << again.out;
  EXPECT_NE(again.err.find("job " + id + " of experiment"), std::string::npos) << again.err;

  ASSERT_TRUE(Run({"scontrol", "release", id})) << Said();
  ASSERT_TRUE(Run({"sh", "-c", "while squeue -h -j " + id + " | grep -q .; do sleep 0.2; done"},
                  seconds(240)))
      << Log("slurmd.log");
  const auto summary = nlohmann::json::parse(ReadFile(out / "summary.json"));
  for (const auto& arm : summary.at("arms")) {
    EXPECT_EQ(arm.at("runs").at(0).at("status"), "finished") << summary.dump(2);
  }
  const ProgramResult nothing = submit();
  EXPECT_EQ(ExitCode(nothing), 0);
  EXPECT_NE(nothing.err.find("no run is left to submit"), std::string::npos) << nothing.err;
}

}  // namespace
}  // namespace shoal
