// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world_environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/world_registry.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/on_policy.h"
#include "common/tasks/task_registry.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::worlds {
namespace {

constexpr char kGoalImage[] = "image";

// Frames are comparable if their fingerprints are equal: model, quality and views are then equal.
std::string RenderFingerprint(const std::string& model, const std::string& quality,
                              const std::vector<CameraView>& cameras, bool goal_hidden) {
  uint64_t hash =
      HashWords({HashBytes(model.data(), model.size()), HashBytes(quality.data(), quality.size())});
  for (const CameraView& camera : cameras) {
    for (const double number : {camera.lookat[0], camera.lookat[1], camera.lookat[2],
                                camera.distance, camera.azimuth_degrees, camera.elevation_degrees,
                                static_cast<double>(camera.model_camera)}) {
      hash = HashWords({hash, std::bit_cast<uint64_t>(number)});
    }
  }
  if (goal_hidden) hash = HashWords({hash, 1});
  return fmt::format("{:016x}", hash);
}

// Calls the physics half. A non-finite number that the call reports becomes a fault of the episode.
template <class Act>
auto FaultsOf(const tasks::Task& task, const Act& act) {
  try {
    return act();
  } catch (const EpisodeFault& fault) {
    throw EpisodeFault(fault.cause(), fmt::format("task {}: {}", task.name(), fault.what()));
  } catch (const Error& error) {
    if (error.exit_code() != static_cast<int>(ErrorKind::kNonFinite)) throw;
    throw EpisodeFault(FaultCause::kDiverged,
                       fmt::format("task {}: {}", task.name(), error.what()));
  }
}

}  // namespace

WorldEnvironment::WorldEnvironment(const tasks::Task& task, std::unique_ptr<World> world,
                                   const Config& config, std::shared_ptr<RenderContext> render)
    : task_(task),
      action_repeat_(task.ActionRepeat(config.action_repeat)),
      end_on_success_(config.end_on_success),
      world_(std::move(world)),
      masses_(*world_, config.randomization.body_mass),
      render_(std::move(render)),
      observed_(task_),
      state_(observed_.state().size()),
      achieved_goal_(observed_.achieved_goal().size()),
      desired_goal_(observed_.desired_goal().size()) {
  if (end_on_success_ && task.goal_size() == 0) {
    throw UsageError("end_on_success is true, but task {} has no goals; expected false",
                     task.name());
  }
  action_.resize(static_cast<size_t>(task.action_size()));
  if (render_ != nullptr) {
    spec_.cameras = ChooseCameras(*world_, config.observation);
    for (const std::string& name : spec_.cameras) {
      cameras_.push_back(ChooseCamera(*world_, config.observation, name));
    }
    if (config.replay.hindsight != "none") HideGoal("replay.hindsight from pixels");
    if (config.observation.goal_mode == kGoalImage) PrepareGoalPicture();
    render_->Attach(world_.get());
  }
  world_->ReleaseTextures();
  BuildSpec(config.observation);
  if (spec_.goal_picture) goal_picture_.resize(static_cast<size_t>(spec_.FrameBytes()));
  spec_.drawn_actions = LearnsOnPolicy(config);
}

void WorldEnvironment::PrepareGoalPicture() {
  if (task_.goal_size() > 0 && !world_->CanMoveToGoal()) {
    throw UsageError(
        "observation.goal_mode is 'image', but task {} cannot show its goal reached "
        "(World::MoveToGoal); expected none, desired or both",
        task_.name());
  }
  HideGoal("observation.goal_mode = image");
}

void WorldEnvironment::HideGoal(const char* why) {
  if (task_.goal_size() > 0 && !world_->HideGoal()) {
    throw UsageError(
        "{}: the pictures of task {} show the goal that was meant, and it cannot be hidden", why,
        task_.name());
  }
  goal_hidden_ = true;
}

void WorldEnvironment::BuildSpec(const ObservationConfig& observation) {
  const std::string& mode = observation.goal_mode;
  if (mode != "none" && mode != "desired" && mode != "both" && mode != kGoalImage) {
    throw UsageError("observation.goal_mode is '{}'; expected none, desired, both or image", mode);
  }
  if (mode != "none" && task_.goal_size() == 0) {
    throw UsageError("observation.goal_mode is '{}', but task {} has no goals; expected none", mode,
                     task_.name());
  }
  spec_.task = task_.name();
  spec_.stack = observation.stack;
  spec_.action_size = task_.action_size();
  spec_.model_fingerprint = world_->fingerprint();
  if (render_ != nullptr) {
    spec_.channels = render_->channels_per_camera() * static_cast<int>(cameras_.size());
    spec_.height = render_->height();
    spec_.width = render_->width();
    spec_.goal_picture = mode == kGoalImage;
    spec_.model_fingerprint =
        RenderFingerprint(world_->fingerprint(), observation.quality, cameras_, goal_hidden_);
  }
  // All numbers are recorded: they are small beside a frame, and a policy without pixels observes
  // them.
  AddStateBlocks(observation);
  AddGoal(task_.achieved_goal(), mode == "both");
  AddGoal(task_.desired_goal(), mode == "desired" || mode == "both");
}

void WorldEnvironment::AddStateBlocks(const ObservationConfig& observation) {
  const StateBlocks& seen = observation.proprioception;
  // Without pixels the policy observes the whole state, unless the key names blocks.
  const bool all = seen.all || (!seen && render_ == nullptr);
  std::set<std::string> names(seen.names.begin(), seen.names.end());
  std::string known;
  for (const tasks::Block& block : task_.state_blocks()) {
    spec_.blocks.push_back({block.name, block.size(), all || names.erase(block.name) > 0});
    known += (known.empty() ? "" : ", ") + block.name;
  }
  if (names.empty()) return;
  throw UsageError("observation.proprioception names a block '{}'; the state blocks of {} are: {}",
                   *names.begin(), task_.name(), known);
}

void WorldEnvironment::AddGoal(const tasks::Block& block, bool observed) {
  if (block.size() > 0) spec_.blocks.push_back({block.name, block.size(), observed});
}

// Reads the world's numbers and rounds them once, to the float32 of records.
void WorldEnvironment::ReadWorld() {
  FaultsOf(task_, [&] { observed_.Read(*world_); });
  Round(task_.state_blocks(), observed_.state(), &state_);
  Round({&task_.achieved_goal(), 1}, observed_.achieved_goal(), &achieved_goal_);
  Round({&task_.desired_goal(), 1}, observed_.desired_goal(), &desired_goal_);
}

void WorldEnvironment::Round(std::span<const tasks::Block> blocks, std::span<const double> exact,
                             std::vector<float>* rounded) const {
  size_t at = 0;
  for (const tasks::Block& block : blocks) {
    for (const tasks::Component& component : block.components) {
      (*rounded)[at] = static_cast<float>(exact[at]);
      if (!std::isfinite((*rounded)[at])) {
        throw EpisodeFault(
            FaultCause::kObservation,
            fmt::format("task {}: {} of block '{}' is {} after {} control steps: not a finite "
                        "float32",
                        task_.name(), component.name, block.name, exact[at], control_step_));
      }
      ++at;
    }
  }
}

void WorldEnvironment::Observe(ObservationOut out) {
  CHECK(out.vector.size() == static_cast<size_t>(spec_.RecordedVectorSize())) << out.vector.size();
  CHECK(out.frame.size() == static_cast<size_t>(spec_.FrameBytes())) << out.frame.size();
  auto to = out.vector.begin();
  for (const std::vector<float>* numbers : {&state_, &achieved_goal_, &desired_goal_}) {
    to = std::ranges::copy(*numbers, to).out;
  }
  if (render_ != nullptr) Draw(out.frame);
}

void WorldEnvironment::Draw(std::span<uint8_t> frame) {
  const ScopedSeconds timed(render_seconds_);
  render_->Render(world_.get(), cameras_, frame);
}

double WorldEnvironment::Distance() const {
  if (task_.goal_size() == 0) return std::numeric_limits<double>::quiet_NaN();
  return task_.Distance(achieved_goal_, desired_goal_);
}

float WorldEnvironment::Reset(uint64_t stream_key, ObservationOut out) {
  Random random(stream_key);
  masses_.Draw(&random, world_.get());
  world_->ForgetDivergence();
  control_step_ = 0;
  FaultsOf(task_, [&] {
    world_->Reset(&random);
    if (!goal_picture_.empty()) world_->LookAtGoal([this] { Draw(goal_picture_); });
  });
  ReadWorld();
  Observe(out);
  return static_cast<float>(Distance());
}

void WorldEnvironment::CheckAction(std::span<const float> action) {
  CHECK(action.size() == action_.size()) << action.size();
  for (size_t i = 0; i < action.size(); ++i) {
    if (!std::isfinite(action[i])) {
      throw NonFiniteError(
          "action component {} ({}) is {}: not finite; the policy's weights are bad", i,
          task_.action()[i].name, action[i]);
    }
    if (std::fabs(action[i]) > 1) {
      throw RuntimeError("action component {} ({}) is {}; expected a number in [-1, 1]", i,
                         task_.action()[i].name, action[i]);
    }
    action_[i] = action[i];
  }
}

// Runs one control step. Adds its reward to the result and replaces the other members.
void WorldEnvironment::StepWorld(StepResult* result) {
  const World::Outcome outcome = FaultsOf(task_, [&] { return world_->Step(action_); });
  ++control_step_;
  ReadWorld();
  const double distance = Distance();
  result->distance = static_cast<float>(distance);
  if (task_.goal_size() == 0) {
    result->reward += static_cast<float>(outcome.reward);
  } else {
    result->reward += task_.Reward(distance);
    result->success = task_.Success(distance);
  }
  result->terminated = outcome.terminated || (end_on_success_ && result->success);
  result->truncated = !result->terminated && control_step_ == task_.episode_length();
  if (!std::isfinite(result->reward)) {
    throw EpisodeFault(
        FaultCause::kReward,
        fmt::format("task {}: the reward is {} after {} control steps: not a finite float32",
                    task_.name(), result->reward, control_step_));
  }
}

StepResult WorldEnvironment::Step(std::span<const float> action, ObservationOut out) {
  CHECK(control_step_ >= 0 && control_step_ < task_.episode_length())
      << "step " << control_step_ << " of an episode of " << task_.episode_length();
  CheckAction(action);
  StepResult result;
  for (int i = 0; i < action_repeat_ && !result.terminated && !result.truncated; ++i) {
    StepWorld(&result);
  }
  Observe(out);
  return result;
}

std::unique_ptr<Environment> MakeEnvironment(const Config& config,
                                             std::shared_ptr<RenderContext> render) {
  const tasks::Task task = tasks::FindTask(config.task, config.distance_threshold);
  CHECK(!config.observation.pixels || render != nullptr) << "pixels without a render context";
  if (!config.observation.pixels) render = nullptr;
  return std::make_unique<WorldEnvironment>(
      task, MakeWorld(task.world(), {config.model, config.physics}), config, std::move(render));
}

}  // namespace shoal::worlds
