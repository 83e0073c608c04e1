// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/eval_actor.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/sleep.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPoll{100};
constexpr std::chrono::seconds kReportDeadline{10};  // for the transport to accept an evaluation
constexpr milliseconds kRetry{20};

}  // namespace

EvalActor::EvalActor(const std::filesystem::path& folder, link::Hub& hub,
                     const EnvironmentFactory& make)
    : run_(ReadRunConfig(folder)),
      evaluator_(run_, /*noop=*/false, make),
      report_(ProcessName::Evaluation()),
      weights_(run_.spec.Hash()),
      control_(Now()),
      eval_publisher_(hub),
      metrics_publisher_(hub),
      weights_subscriber_(hub, [this](const EvalWeightsPart& m) { weights_.OnMessage(m); }),
      control_subscriber_(hub, [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }) {}

int EvalActor::Run() {
  while (control_.state() != RunState::kStopping && !StopRequested()) {
    if (control_.CoordinatorLost(Now())) {
      log::Failure("the coordinator is gone: no heartbeat; leaving");
      return 1;
    }
    if (const auto weights = weights_.Take(Now() + kPoll)) Evaluate(*weights);
    WarnOfOvertaken();
    Report("idle");
  }
  eval_publisher_.WaitForAcks(milliseconds(1000));
  return 0;
}

void EvalActor::Evaluate(const ReceivedWeights& weights) {
  evaluator_.selector().Load(weights);
  const EpisodeStream stream =
      EvaluationStream(run_.config.seed, weights.env_steps, weights.version.update);
  const SteadyTime start = Now();
  SteadyTime counted = start;
  const auto episodes = evaluator_.Play(run_.config.eval.episodes, stream, [&] {
    const SteadyTime now = Now();
    evaluating_seconds_ += std::chrono::duration<double>(now - std::exchange(counted, now)).count();
    Report("evaluating");
    return StopRequested() || control_.state() == RunState::kStopping;
  });
  if (std::cmp_less(episodes.size(), run_.config.eval.episodes)) return;  // stopped early
  const EvaluationLabel label{.policy = "checkpoint",
                              .checkpoint = weights.checkpoint,
                              .version = weights.version,
                              .env_steps = weights.env_steps};
  EvalMessage message;
  message.env_steps = weights.env_steps;
  message.version = weights.version;
  message.checkpoint = weights.checkpoint;
  const auto json = EvaluationJson(run_, label, stream, episodes);
  message.json = json.dump();
  Send(message);
  ++evaluations_;
  for (const EpisodeResult& episode : episodes)
    env_steps_ += static_cast<uint64_t>(episode.figures.length);
  log::Info("evaluation at {} env steps, update {}: {} in {:.1f} s", weights.env_steps,
            weights.version.update, json.at("aggregate").dump(), SecondsSince(start));
}

void EvalActor::Send(const EvalMessage& message) {
  const SteadyTime deadline = Now() + kReportDeadline;
  while (!eval_publisher_.Write(message)) {
    if (Now() > deadline) {
      throw RuntimeError("evaluation at {} env steps could not be reported within {} s",
                         message.env_steps, kReportDeadline.count());
    }
    Report("blocked");
    SleepFor(kRetry);
  }
}

void EvalActor::WarnOfOvertaken() {
  const uint64_t overtaken = weights_.overtaken();
  if (overtaken == overtaken_said_) return;
  log::Warning(
      "{} evaluation(s) skipped, {} in all: newer weights arrived first, because an evaluation "
      "takes longer than eval.interval",
      overtaken - overtaken_said_, overtaken);
  overtaken_said_ = overtaken;
}

void EvalActor::Report(const char* state) {
  if (!report_.Due(Now())) return;
  report_.Begin(state);
  report_.Add("evaluations", static_cast<double>(evaluations_));
  report_.Add("eval_env_steps", static_cast<double>(env_steps_));
  report_.Add("evaluations_overtaken", static_cast<double>(weights_.overtaken()));
  report_.Add("weights_refused", static_cast<double>(weights_.refused()));
  report_.AddSeconds("evaluating", evaluating_seconds_);
  report_.AddResources();
  metrics_publisher_.Write(report_.message());
}

}  // namespace shoal::actor
