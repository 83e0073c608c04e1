// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_program.h"

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/base/usable_cores.h"
#include "common/base/write_faults.h"
#include "common/config/session_number.h"
#include "common/config/thread_limit.h"
#include "common/nn/encoder_weights.h"
#include "common/policy/checkpoint_writer.h"
#include "common/run_folder/run_file_names.h"
#include "learner/agent/encoder_start.h"
#include "learner/agent/network_start.h"
#include "learner/training_loop.h"

namespace shoal::learner {
namespace {

ResizableAgent::Make MakeAgentOf(const RunConfig& run, LearnerDevice& device,
                                 const AgentFactory& make, NodeAffinity* affinity) {
  return [&run, &device, make, affinity](int threads) {
    if (affinity != nullptr) affinity->FitTo(threads);
    nn::SetThreads(threads);
    return device.on_gpu() ? device.MakeAgent(run) : make(run.config, run.spec, device.precision());
  };
}

// The learner's processor as text for its log.
std::string ProcessorText(const RunConfig& run, const LearnerDevice& device, int threads,
                          int cores) {
  if (device.on_gpu()) return device.Description();
  return fmt::format("{}, {}", nn::CpuIsa(), DescribeThreads(run.config, run.spec, threads, cores));
}

}  // namespace

LearnerProgram::LearnerProgram(const std::filesystem::path& folder, const ProcessName& name,
                               const RunConfig& run, int threads, link::Hub& hub,
                               const AgentFactory& make, NodeAffinity* affinity)
    : folder_(folder),
      name_(name),
      run_(run),
      session_(NextSession(folder, name.Text(), WallTimeNs())),
      affinity_(affinity),
      device_(folder, run_),
      agent_(MakeAgentOf(run_, device_, make, affinity_), device_.on_gpu() ? 1 : threads),
      checkpoints_(folder, run),
      restored_(device_.CountingLosses([this] { return Restore(); })),
      update_page_(folder, agent_.updates()),
      control_(Now()),
      sink_(hub),
      batches_(MakeFeed(folder, run, session_, agent_.updates(), hub, device_.Pin())),
      evaluation_subscriber_(
          hub,
          [this](const EvalMessage& m) { pending_evaluations_.OnEvaluated(m.version.update); }),
      control_subscriber_(hub, [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }) {
  log::Info("session {}: {}, {} ({}), batches of {}, {}", session_, run.config.learner.algorithm,
            nn::ToString(device_.precision()),
            ProcessorText(run_, device_, threads, UsableCores(Limits())), run.config.learner.batch,
            run.spec.Summary());
}

int LearnerProgram::Run() {
  return device_.CountingLosses([this] { return Train(); });
}

int LearnerProgram::Train() {
  TrainingLoop loop({.run = run_,
                     .name = name_,
                     .precision = device_.precision(),
                     .session = session_,
                     .agent = agent_,
                     .batches = batches_->stream(),
                     .sink = sink_,
                     .checkpoints = checkpoints_,
                     .pending_evaluations = pending_evaluations_,
                     .control = control_,
                     .update_page = update_page_,
                     .threads = agent_.threads(),
                     .resize = [this](int threads) { return Resize(threads); },
                     .look = [this] { return device_.Look(); }},
                    restored_);
  const TrainingLoop::End end = loop.Run();
  const auto unwritten = checkpoints_.UnwrittenUpdates();
  if (unwritten) {
    const auto written = checkpoints_.WrittenUpdates();
    log::Failure("{} could not be written and is lost; the newest one on the disk: {}",
                 CheckpointName(*unwritten), written ? CheckpointName(*written) : "none");
  }
  if (end == TrainingLoop::End::kStopped) return unwritten ? kUnwrittenExit : 0;
  log::Failure("the coordinator is gone: no heartbeat; {}; leaving",
               unwritten ? "no checkpoint" : "a checkpoint was written");
  batches_->DrainAfterCoordinatorLoss();
  return 1;
}

std::optional<CheckpointState> LearnerProgram::Restore() {
  const std::optional<Checkpoint> checkpoint = checkpoints_.RestoreNewest();
  if (!checkpoint) {
    StartFresh();
    return std::nullopt;
  }
  policy::CheckWriter(checkpoint->folder, checkpoint->state, checkpoint->description, run_.config);
  const std::string warning =
      CheckPrecision(*checkpoint, run_.config.learner.precision, device_.precision());
  if (!warning.empty()) log::Warning("{}", warning);
  agent_.Restore(checkpoint->tensors, (checkpoint->folder / kLearnerFile).string());
  if (agent_.updates() != checkpoint->state.updates) {
    throw RuntimeError("'{}': parameters of update {}, but {} says {}", checkpoint->folder.string(),
                       agent_.updates(), kStateFile, checkpoint->state.updates);
  }
  log::Info("restored {}: {} updates, {} env steps", checkpoint->folder.filename().string(),
            checkpoint->state.updates, checkpoint->state.env_steps);
  return checkpoint->state;
}

int LearnerProgram::Resize(int threads) {
  try {
    // The count comes from a command to the running learner, so a bad one is reported and ignored.
    if (device_.on_gpu()) throw UsageError("learner.threads: the learner computes on a GPU");
    if (threads < 1) throw UsageError("learner.threads = {}: expected at least 1", threads);
    CheckCores("learner.threads", threads, Limits());
    agent_.Resize(threads);
    log::Info("{} from update {} on",
              DescribeThreads(run_.config, run_.spec, threads, UsableCores(Limits())),
              agent_.updates() + 1);
  } catch (const Error& error) {
    if (affinity_ != nullptr) affinity_->FitTo(agent_.threads());
    log::Warning("{}; it stays {}", error.what(), agent_.threads());
  }
  return agent_.threads();
}

CoreLimits LearnerProgram::Limits() const {
  return affinity_ == nullptr ? ReadCoreLimits() : affinity_->Limits();
}

void LearnerProgram::StartFresh() {
  const std::filesystem::path initial = folder_ / kInitialWeightsFile;
  if (std::filesystem::exists(initial)) {
    const std::string source = initial.string();
    agent_.Restore(StartTensors(nn::ReadSafetensors(ReadFile(initial), source), source, agent_),
                   source);
    log::Info("the networks start from {}", source);
    return;
  }
  const nn::TensorMap weights = nn::ReadEncoderWeights(run_.config.network, run_.spec);
  if (weights.empty()) return;
  StartEncoder(weights, &agent_);
  log::Info("the encoder starts from {}", run_.config.network.encoder_weights);
}

}  // namespace shoal::learner
