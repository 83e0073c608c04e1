// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted_parts.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "actor/evaluation/hosted_view.h"
#include "actor/hosted/hosted_environment.h"
#include "actor/hosted/trial.h"
#include "common/base/bounded_json.h"
#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/config/spec_mismatch.h"

namespace shoal::actor {
namespace {

// The environments of this process.
class Hosting {
 public:
  Hosting(EnvironmentOpener open, bool shows) : open_(std::move(open)), shows_(shows) {}

  std::vector<std::unique_ptr<worlds::Environment>> Make(const RunConfig& run, int count) {
    std::vector<std::unique_ptr<worlds::Environment>> environments;
    for (int i = 0; i < count; ++i) {
      auto one = MakeOne(run);
      newest_ = one.get();
      environments.push_back(std::move(one));
    }
    InstallStopSignals();  // the user's code may have replaced them
    return environments;
  }

  std::unique_ptr<EpisodeView> View(const FrameRecorder::Options& options) const {
    return std::make_unique<HostedView>(newest_->raw(), options.height, options.width);
  }

  nlohmann::ordered_json Describe(const Config& config) const {
    OpenedEnvironment opened = open_(config, Purpose::kDescribe);
    const hosted::Trial trial =
        TryEnvironment(*opened.raw, opened.description, static_cast<uint64_t>(config.seed));
    opened.description.success = trial.success;
    if (!trial.other_reward.empty()) {
      opened.description.goal.reset();
      opened.description.no_goal = trial.other_reward;
    }
    nlohmann::ordered_json json{{"steps", trial.steps},
                                {"step_microseconds", trial.step_microseconds},
                                {"repeated_steps", trial.repeated_steps}};
    if (trial.differs_at) json["differs_at"] = *trial.differs_at;
    return {
        {"environment", ToJson(opened.description)}, {"trial", json}, {"version", BuildVersion()}};
  }

 private:
  std::unique_ptr<hosted::HostedEnvironment> MakeOne(const RunConfig& run) const {
    OpenedEnvironment opened = open_(run.config, shows_ ? Purpose::kShow : Purpose::kPlay);
    opened.description.TakeFindings(
        tasks::EnvironmentFromJson(ParseBoundedJson<nlohmann::json>(run.spec.environment)));
    auto environment = std::make_unique<hosted::HostedEnvironment>(
        std::move(opened.description), run.config, std::move(opened.raw));
    if (environment->spec().Hash() != run.spec.Hash()) {
      throw RuntimeError("{}", SpecMismatch(run, environment->spec()));
    }
    return environment;
  }

  const EnvironmentOpener open_;
  const bool shows_;
  hosted::HostedEnvironment* newest_ = nullptr;  // borrowed
};

RunConfig RefuseOtherTask(const RunConfig& run, const std::string& task) {
  throw UsageError("--task {}: a policy of environment {} plays that environment alone", task,
                   run.config.env.id);
}

}  // namespace

ActorParts HostedParts(EnvironmentOpener open, bool shows) {
  const auto hosting = std::make_shared<Hosting>(std::move(open), shows);
  return {
      .add_tasks = [](const RunConfig& run) { tasks::AddEnvironmentTask(run.spec.environment); },
      .environments = {.make = [hosting](const RunConfig& run,
                                         int count) { return hosting->Make(run, count); },
                       .with_task = RefuseOtherTask,
                       .view = [hosting](const RunConfig&,
                                         const auto& options) { return hosting->View(options); }},
      .describe = [hosting](const Config& config) { return hosting->Describe(config); }};
}

}  // namespace shoal::actor
