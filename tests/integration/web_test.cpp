// SPDX-License-Identifier: Apache-2.0
// `shoal web` with a real run: the page shows the figures of `shoal top`, and clients with the
// token can steer the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "launch/tools/web/web_server.h"
#include "tests/support/page_client.h"
#include "tests/support/run_views.h"
#include "tests/support/running_training.h"
#include "tests/support/terminal_program.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;

const TrainingRun::Keys kLong{
    {"env_steps", "10000000"}, {"actors", "1"}, {"eval.interval", "1000"}};

// Polls the page about the test's run until `done` holds for an answer. Fails the test and returns
// null at the deadline.
template <class Done>
json WaitForAnswer(const PageClient& page, const std::string& path, Done done) {
  const SteadyTime end = Now() + seconds(180);
  PageAnswer answer;
  while (Now() < end) {
    answer = page.Get(path);
    json content = json::parse(answer.content, nullptr, /*allow_exceptions=*/false);
    if (answer.status == 200 && done(content)) return content;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ADD_FAILURE() << path << ": " << answer.status << ' ' << answer.content;
  return {};
}

// The views of the page and of `shoal top` must be identical for the same time. Polls both until
// they have the same time.
void ExpectTheViewOfTop(const PageClient& page, const TrainingRun& run) {
  std::map<double, json> seen;
  json equal, top;
  for (int i = 0; i < 50 && equal.is_null(); ++i) {
    const json view = WaitForAnswer(page, "/api/runs/run/top", [](const json&) { return true; });
    ASSERT_TRUE(view.is_object());
    seen[view.at("view").at("time")] = view.at("view");
    const ProgramResult asked = RunShoal(run, {"top", "--once", "--json"});
    ASSERT_EQ(ExitCode(asked), 0) << asked.err;
    top = json::parse(asked.out);
    const auto after = WaitForAnswer(page, "/api/runs/run/top", [](const json&) { return true; });
    seen[after.at("view").at("time")] = after.at("view");
    if (seen.contains(top.at("time"))) equal = seen[top.at("time")];
  }
  ASSERT_FALSE(equal.is_null()) << "no moment that both showed";
  EXPECT_EQ(equal, top);
  EXPECT_TRUE(ProcessOf(equal, "actor").is_object());
}

TEST(Web, ThePageShowsWhatTopShowsAndSteers) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(kLong));
  ASSERT_TRUE(WaitForView(run, [](const json& view) {
                const json learner = ProcessOf(view, "learner");
                return learner.is_object() && learner.value("updates", 0.0) > 50;
              }).is_object());
  launch::WebServer server({.run = "",
                            .run_dir = run.parent().string(),
                            .secure = "",
                            .listen = {.address = "127.0.0.1", .port = 0}});
  const PageClient page(server.port(), server.token());

  ExpectTheViewOfTop(page, run);

  const json curves = WaitForAnswer(page, "/api/runs/run/curves", [](const json& answer) {
    return answer.dump().find("evaluations") != std::string::npos;
  });
  EXPECT_THAT(curves.dump(), HasSubstr("critic_loss"));

  // Without the token nothing is done; with it what `shoal set`, `scale` and `stop` do.
  const std::string order = "/api/runs/run/order";
  EXPECT_EQ(PageClient(server.port(), "").Post(order, R"({"verb":"stop","arguments":[]})").status,
            401);
  const PageAnswer set = page.Post(order, R"({"verb":"set","arguments":["eval.interval=5000"]})");
  EXPECT_EQ(set.status, 200);
  EXPECT_THAT(set.content, HasSubstr("eval.interval: 1000 -> 5000"));
  const PageAnswer refused = page.Post(order, R"({"verb":"set","arguments":["learner.batch=7"]})");
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.content, HasSubstr("learner.batch is fixed for the run"));
  EXPECT_EQ(run.Json("meta.json").at("changes")[0].at("to"), 5000);

  // An episode with the newest checkpoint, as a film.
  const PageAnswer play = page.Post("/api/runs/run/episode", "{}");
  EXPECT_EQ(play.status, 200) << play.content;
  const json played = WaitForAnswer(page, "/api/runs/run", [](const json& answer) {
    return answer.at("episode").at("state") != "playing";
  });
  EXPECT_EQ(played.at("episode").at("state"), "ready") << played.dump();
  EXPECT_GT(played.at("episode").at("env_steps"), 0);
  const PageAnswer film = page.Get("/episode/run");
  EXPECT_EQ(film.status, 200);
  EXPECT_EQ(film.content.substr(4, 4), "ftyp") << "an MP4 file";

  EXPECT_EQ(page.Post(order, R"({"verb":"stop","arguments":[]})").status, 200);
  EXPECT_EQ(training.End(seconds(120)), 0) << training.Output();
  const PageAnswer over = page.Get("/api/runs/run/top");
  EXPECT_EQ(over.status, 409);
  const json runs = WaitForAnswer(page, "/api/runs", [](const json& answer) {
    return answer.at("runs").at("runs")[0].at("status") == "interrupted";
  });
  EXPECT_TRUE(runs.is_object());
}

TEST(Web, TheCommandPrintsTheAddressAndEndsWithASignal) {
  const TrainingRun run;
  TerminalProgram web({"shoal", "web", "--run-dir", run.parent().string(), "--port", "0"});
  EXPECT_TRUE(web.WaitFor("at http://127.0.0.1:", seconds(30)));
  EXPECT_TRUE(web.WaitFor("/?token=", seconds(30)));
  EXPECT_TRUE(web.WaitFor("Ctrl-C ends the server", seconds(30)));
  web.Signal(SIGINT);
  EXPECT_EQ(web.End(seconds(30)), kInterruptedExit);
}

TEST(Web, BadUsageIsOneLine) {
  const TrainingRun run;
  for (const auto& [words, said] : std::map<std::vector<std::string>, std::string>{
           {{"web", "--address", "here"}, "--address here: expected an IPv4 address"},
           {{"web", "--address", "192.0.2.1"}, "192.0.2.1:8470: Cannot assign requested address"},
           {{"web", "--port", "70000"}, "70000"},
           {{"web", "--run", "none"}, "none"}}) {
    const ProgramResult result = RunShoal(run, words, seconds(30));
    EXPECT_GT(ExitCode(result), 0) << words[1];
    EXPECT_THAT(result.err, HasSubstr(said));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace shoal
