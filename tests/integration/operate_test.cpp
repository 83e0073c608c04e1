// SPDX-License-Identifier: Apache-2.0
// Watching and steering a running run.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>

#include "common/base/usable_cores.h"
#include "launch/watch/run_metrics.h"
#include "learner/agent/frame_figures.h"
#include "learner/agent/sac/sac_agent.h"
#include "tests/support/paths.h"
#include "tests/support/run_views.h"
#include "tests/support/running_training.h"
#include "tests/support/terminal_program.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

// Runs until it is stopped.
const TrainingRun::Keys kLongRun{
    {"env_steps", "10000000"}, {"actors", "1"}, {"eval.interval", "5000"}};

TEST(Operate, TopShowsEveryProcessUntilTheRunEnds) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLongRun));
  const json view = WaitForView(run, Learns);
  ASSERT_TRUE(view.is_object());
  EXPECT_EQ(view.at("schema"), "shoal-top-1");
  EXPECT_EQ(view.at("run"), "run");
  EXPECT_GT(view.at("env_steps"), 1000);
  EXPECT_GT(view.at("updates"), 0);
  std::set<int> pids;
  for (const char* role : {"coordinator", "replay", "learner", "actor", "eval"}) {
    const json process = ProcessOf(view, role);
    ASSERT_TRUE(process.is_object()) << role;
    EXPECT_EQ(kill(process.at("pid").get<int>(), 0), 0) << role;
    pids.insert(process.at("pid").get<int>());
    for (const char* name : {"rss_mb", "open_files", "cpu_seconds"}) {
      EXPECT_GT(process.at(name), 0) << role << ' ' << name;
    }
  }
  EXPECT_EQ(pids.size(), 5u);
  const json replay = ProcessOf(view, "replay");
  for (const char* name :
       {"queue_depth", "queue_age_seconds", "limiter_blocked_insert_share",
        "limiter_blocked_sample_share", "policy_lag_p99", "data_age_seconds_p90"}) {
    EXPECT_GE(replay.at(name), 0) << name;
  }
  EXPECT_GE(ProcessOf(view, "learner").at("data_age_updates_p50"), replay.at("policy_lag_p50"));
  EXPECT_GE(ProcessOf(view, "actor").at("credit"), 0);

  const ProgramResult table = RunShoal(run, {"top", "--once", "--run", "run"});
  EXPECT_EQ(ExitCode(table), 0) << table.err;
  for (const char* word : {"learner-0", "actor-0", "updates/s", "LAG"}) {
    EXPECT_THAT(table.out, HasSubstr(word));
  }

  kill(training.pid(), SIGINT);
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  const ProgramResult over = RunShoal(run, {"top", "--run", "run"});
  EXPECT_EQ(ExitCode(over), 1);
  EXPECT_THAT(over.err, HasSubstr("is not running"));
}

TEST(Operate, ATerminalThatCannotMoveItsCursorGetsLines) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLongRun));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());
  for (const char* command : {"top", "attach"}) {
    TerminalProgram watcher({"shoal", command, "--run-dir", run.parent().string()}, "dumb");
    EXPECT_TRUE(watcher.WaitFor(" running | ", seconds(30))) << command;
    EXPECT_TRUE(watcher.WaitFor(" running | ", seconds(30))) << command;
    EXPECT_THAT(watcher.shown(), ::testing::Not(HasSubstr("\x1b"))) << command;
    watcher.Signal(SIGINT);
    EXPECT_EQ(watcher.End(seconds(30)), kInterruptedExit) << command;
  }
  kill(training.pid(), SIGINT);
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
}

TEST(Operate, TopOnATerminalIsALiveTableAndLeavesTheTerminalAsItWas) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLongRun));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());
  const std::vector<std::string> top{"shoal", "top", "--run", run.path().string()};
  {
    TerminalProgram program(top);
    EXPECT_TRUE(program.WaitFor("(now PROCESS)", seconds(30))) << program.shown();
    EXPECT_TRUE(program.WaitFor("learner-0", seconds(30))) << program.shown();
    program.Type("s");
    EXPECT_TRUE(program.WaitFor("(now HOST)", seconds(30))) << program.shown();
    program.Type("SS");
    EXPECT_TRUE(program.WaitFor("(now MOST TIME IN)", seconds(30))) << program.shown();
    program.Type("r");
    EXPECT_TRUE(program.WaitFor(", reversed)", seconds(30))) << program.shown();
    program.Type("q");
    EXPECT_EQ(program.End(seconds(30)), 0);
    EXPECT_TRUE(program.LeftAsItWas());
  }
  {
    TerminalProgram program(top);
    EXPECT_TRUE(program.WaitFor("(now PROCESS)", seconds(30))) << program.shown();
    EXPECT_FALSE(program.LeftAsItWas()) << "keys come at once while it runs";
    program.Signal(SIGTERM);
    EXPECT_EQ(program.End(seconds(30)), 128 + SIGTERM);
    EXPECT_TRUE(program.LeftAsItWas());
  }
  kill(training.pid(), SIGINT);
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
}

// Runs the client that knows only docs/monitoring.md for the address that the run showed.
ProgramResult RunStockClient(const std::string& output) {
  const size_t at = output.find("--peer 127.0.0.1:");
  EXPECT_NE(at, std::string::npos) << output;
  const int port = std::stoi(output.substr(output.find(':', at) + 1));
  EXPECT_EQ((port - 7410) % 250, 0) << port;
  const std::string uri = fmt::format(
      "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize></General>"
      "<Discovery><ParticipantIndex>none</ParticipantIndex><Peers><Peer "
      "Address=\"127.0.0.1:{}\"/></Peers></Discovery>",
      port);
  setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  ProgramResult result =
      RunProgram({"stock_client", std::to_string((port - 7410) / 250), "20"}, seconds(60));
  unsetenv("CYCLONEDDS_URI");
  return result;
}

TEST(Operate, AStockDdsClientReadsWhatTheDocumentationDescribes) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLongRun));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());
  const ProgramResult client = RunStockClient(training.Output());
  EXPECT_EQ(ExitCode(client), 0) << client.err;
  EXPECT_THAT(client.out, HasSubstr("view shoal-top-1 run run state running env_steps "));
  for (const char* text : {"process actor 0 host ", "process learner 0 host ",
                           " rss_mb=", " policy_lag_p90=", " critic_loss="}) {
    EXPECT_THAT(client.out, HasSubstr(text));
  }
  kill(training.pid(), SIGINT);
  EXPECT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
}

TEST(Operate, ARunIsSteeredWhileItGoesOnAndItsRecordSaysSo) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLongRun));
  ASSERT_TRUE(WaitForView(run, Learns).is_object());

  const ProgramResult set = RunShoal(run, {"set", "replay.samples_per_insert=16"});
  EXPECT_EQ(ExitCode(set), 0) << set.err;
  EXPECT_THAT(set.out, HasSubstr("replay.samples_per_insert: 32 -> 16"));
  EXPECT_THAT(set.out, HasSubstr("in force: replay-0 16, learner-0 16"));
  EXPECT_EQ(ExitCode(RunShoal(run, {"set", "eval.interval=700"})), 0);
  const ProgramResult fixed = RunShoal(run, {"set", "learner.batch=7"});
  EXPECT_EQ(ExitCode(fixed), 1);
  EXPECT_THAT(fixed.err, HasSubstr("learner.batch is fixed for the run"));

  if (UsableCores() > 1) {  // the learner goes on with another number of threads
    const ProgramResult threads = RunShoal(run, {"set", "learner.threads=2"});
    EXPECT_EQ(ExitCode(threads), 0) << threads.err << training.Output();
    EXPECT_THAT(threads.out, HasSubstr("in force: learner-0 2"));
    const double updates =
        ProcessOf(WaitForView(run, Learns), "learner").at("updates").get<double>();
    EXPECT_TRUE(WaitForView(run, [&](const json& v) {
                  return ProcessOf(v, "learner").value("updates", 0.0) > updates + 50;
                }).is_object());
    const ProgramResult one = RunShoal(run, {"set", "learner.threads=1"});
    EXPECT_THAT(one.out, HasSubstr("in force: learner-0 1"));
  }
  const ProgramResult too_many = RunShoal(run, {"set", "learner.threads=1000"});
  EXPECT_EQ(ExitCode(too_many), 1);
  EXPECT_THAT(too_many.err, HasSubstr("learner.threads = 1000"));

  const ProgramResult more = RunShoal(run, {"scale", "--actors", "3"});
  EXPECT_EQ(ExitCode(more), 0) << more.out << more.err << training.Output();
  const json view = WaitForView(run, [](const json& v) {
    return ProcessOf(v, "actor", 2).is_object() &&
           ProcessOf(v, "actor", 2).value("env_steps", 0.0) > 100;
  });
  ASSERT_TRUE(view.is_object());
  const ProgramResult fewer = RunShoal(run, {"scale", "--actors", "1"});
  EXPECT_EQ(ExitCode(fewer), 0) << fewer.out << fewer.err << training.Output();
  EXPECT_NE(kill(ProcessOf(view, "actor", 2).at("pid").get<int>(), 0), 0) << "it has left";

  const ProgramResult stop = RunShoal(run, {"stop"}, seconds(180));
  EXPECT_EQ(ExitCode(stop), 0) << stop.out << stop.err;
  EXPECT_THAT(stop.out, HasSubstr("ended (interrupted)"));
  EXPECT_EQ(training.End(seconds(30)), 0) << training.Output();

  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0) << "actors flush before they leave";
  ASSERT_EQ(meta.at("changes").size(), UsableCores() > 1 ? 6u : 4u);
  EXPECT_EQ(meta.at("changes")[0].at("key"), "replay.samples_per_insert");
  EXPECT_EQ(meta.at("changes")[0].at("to"), 16);
  EXPECT_GT(meta.at("changes")[0].at("env_steps"), 0);
  EXPECT_EQ(meta.at("changes").back().at("key"), "actors");
  EXPECT_EQ(meta.at("changes").back().at("to"), 1);
  EXPECT_EQ(run.Json("bottleneck.json").at("schema"), "shoal-bottleneck-1");
  EXPECT_THAT(training.Output(),
              HasSubstr(run.Json("bottleneck.json").at("advice").get<std::string>()));
}

TEST(Operate, ADetachedRunIsAttachedToAndStopped) {
  const TrainingRun run;
  const ProgramResult train = RunProgram(run.Command(kLongRun, {"--detach"}), seconds(90));
  ASSERT_EQ(ExitCode(train), 0) << train.out << train.err;
  EXPECT_THAT(train.out, HasSubstr("shoal attach --run"));
  const ProgramResult runs = RunShoal(run, {"runs", "--json"});
  EXPECT_EQ(json::parse(runs.out).at("runs")[0].at("status"), "running");

  // Its Ctrl-C detaches only.
  launch::ProcessSpec attach;
  attach.role = "attach";
  attach.command = {ProgramPath("shoal"), "attach", "--run", run.path().string()};
  attach.output = run.parent() / "attached";
  const auto shows = [&] { return ReadFile(attach.output).find("env steps") != std::string::npos; };
  const auto status = launch::RunToEnd(attach, seconds(60), shows);
  EXPECT_FALSE(status.has_value()) << "stopped by us, not by itself";
  EXPECT_THAT(ReadFile(attach.output), HasSubstr("detached; the run goes on"));
  ASSERT_TRUE(WaitForView(run, Learns).is_object()) << "the run goes on";

  const ProgramResult stop = RunShoal(run, {"stop", "--run", "run"}, seconds(180));
  EXPECT_EQ(ExitCode(stop), 0) << stop.out << stop.err;
  EXPECT_THAT(ReadFile(run.path() / "logs" / "train.log"), HasSubstr("ended (interrupted)"));
  const ProgramResult over = RunShoal(run, {"runs", "--json"});
  EXPECT_EQ(json::parse(over.out).at("runs")[0].at("status"), "interrupted");
  ExpectBalanced(run.Json("meta.json"));
}

using RoleMetric = std::pair<std::string, std::string>;

// The newest line of a role in a run's metrics.jsonl.
json LastReported(const TrainingRun& run, const std::string& role) {
  json last;
  std::ifstream in(run.path() / "metrics.jsonl");
  for (std::string line; std::getline(in, line);) {
    json report = json::parse(line);
    if (report.at("role") == role) last = std::move(report);
  }
  return last;
}

// Metrics that the processes of a run have reported; each must be in the table.
void AddReported(const TrainingRun& run, std::set<RoleMetric>* seen) {
  std::ifstream in(run.path() / "metrics.jsonl");
  for (std::string line; std::getline(in, line);) {
    const json report = json::parse(line);
    const std::string role = report.at("role");
    for (const auto& [name, value] : report.items()) {
      if (std::set<std::string>{"t", "role", "id", "host", "pid", "state"}.contains(name)) continue;
      seen->emplace(role, name);
      EXPECT_NE(FindMetric(launch::RunMetrics(), role, name), nullptr) << role << ' ' << name;
    }
  }
}

// Figures that no run from state has.
const std::set<std::string_view> kOfPixels{learner::kFrameSpread.name, learner::kFrozenCameras.name,
                                           learner::kAuxError.name};
// Only actors of environments of the user's own report these
// (Environments.TimeOfTheUsersCodeIsReportedApart).
const std::set<std::string_view> kOfUserEnvironments{"user_code", "conversion"};
// Only a learner on a GPU reports these (Gpu.*).
const std::set<std::string_view> kOfGpus{"card_memory_mb", "card_memory_size_mb", "card_busy"};

// Adds what a run with a preset reports.
void AddReportedBy(const std::string& preset, const std::vector<std::string>& settings,
                   std::set<RoleMetric>* seen) {
  const TrainingRun run;
  std::vector<std::string> command{
      "shoal",      "train", "--preset", preset,
      "--run-name", "run",   "--set",    "run_dir=" + run.parent().string()};
  for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
  const ProgramResult result = RunProgram(command, seconds(120));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  AddReported(run, seen);
}

TEST(Operate, EveryMetricIsInTheTableOfMetrics) {
  std::set<RoleMetric> seen;
  const TrainingRun run;
  // Long enough for rates, which need updates of several seconds, on a fast machine as well.
  ASSERT_EQ(ExitCode(run.Train({{"observation.goal_mode", "both"},
                                {"env_steps", "16000"},
                                {"replay.priorities", "proportional"}})),
            0);
  EXPECT_GE(LastReported(run, "coordinator").value("last_evaluation_env_steps", 0.0), 16000)
      << "an evaluation that came after the last second's report";
  AddReported(run, &seen);
  AddReportedBy("fetch-reach-ppo",
                {"env_steps=4000", "ppo.rollout_steps=128", "eval.interval=2000", "eval.episodes=4",
                 "eval.final_episodes=0"},
                &seen);
  AddReportedBy("state-mrq",
                {"task=cartpole_swingup", "env_steps=500", "replay.min_size=300",
                 "exploration.random_steps=300", "network.state_hidden=[16]", "network.hidden=[16]",
                 "eval.interval=400", "eval.episodes=1", "eval.final_episodes=0"},
                &seen);
  // And the table names nothing that no process reports.
  for (const Metric& metric : launch::RunMetrics()) {
    const std::string name(metric.name);
    const std::string reported = metric.kind == MetricKind::kStage       ? "share_" + name
                                 : metric.kind == MetricKind::kQuantiles ? name + "_p99"
                                 : metric.kind == MetricKind::kPerTopic  ? name + "_control"
                                                                         : name;
    // In views alone.
    if (name == "exit_code" || name == "recent_cores" || metric.kind == MetricKind::kPerStage) {
      continue;
    }
    if (kOfPixels.contains(name) || kOfUserEnvironments.contains(name) || kOfGpus.contains(name)) {
      continue;
    }
    const std::string role = metric.role == "all" ? "replay" : std::string(metric.role);
    EXPECT_TRUE(seen.contains({role, reported})) << role << ' ' << reported;
  }
}

}  // namespace
}  // namespace shoal
