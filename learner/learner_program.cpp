// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_program.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/base/usable_cores.h"
#include "common/base/write_faults.h"
#include "common/config/learner_threads.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/config/session_number.h"
#include "common/dds/subscriber.h"
#include "common/nn/encoder_weights.h"
#include "common/policy/checkpoint_writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/encoder_start.h"
#include "learner/agent/network_start.h"
#include "learner/batch_feed.h"
#include "learner/checkpoint_store.h"
#include "learner/dds_outlet.h"
#include "learner/openmp_environment.h"
#include "learner/training_loop.h"

namespace shoal::learner {
namespace {

// Members are in construction order: subscribers, which end first, write to what is above them.
class Learner {
 public:
  Learner(const std::filesystem::path& folder, const RunConfig& run, const dds::Reach& reach,
          int threads)
      : folder_(folder),
        member_(folder),
        run_(run),
        session_(NextSession(folder, ProcessName::Learner().Text(), WallTimeNs())),
        precision_(nn::ChoosePrecision(run.config.learner.precision, run.spec.HasPixels())),
        agent_(MakeAgent(run.config, run.spec, precision_)),
        checkpoints_(folder, run),
        restored_(Restore()),
        update_page_(folder, agent_->updates()),
        control_(Now()),
        bus_(dds::FindPlace(folder, run.config.transport, reach), dds::Role::kLearner),
        outlet_(bus_),
        batches_(MakeFeed(folder, run, session_, agent_->updates(), bus_)),
        evaluation_subscriber_(
            bus_,
            [this](const EvalMessage& m) { pending_evaluations_.OnEvaluated(m.version.update); }),
        control_subscriber_(bus_,
                            [this](const ControlMessage& m) { control_.OnMessage(m, Now()); }) {
    log::Info("session {}: {}, {} ({}), {}, batches of {}, {}", session_,
              run.config.learner.algorithm, nn::ToString(precision_), nn::CpuIsa(),
              DescribeThreads(run.config, run.spec, threads, UsableCores()),
              run.config.learner.batch, run.spec.Summary());
  }

  int Run() {
    TrainingLoop loop({.run = run_,
                       .precision = precision_,
                       .session = session_,
                       .agent = *agent_,
                       .batches = batches_->stream(),
                       .outlet = outlet_,
                       .checkpoints = checkpoints_,
                       .pending_evaluations = pending_evaluations_,
                       .control = control_,
                       .update_page = update_page_},
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
    batches_->SayFarewell();
    return 1;
  }

 private:
  std::optional<CheckpointState> Restore() {
    const std::optional<Checkpoint> checkpoint = checkpoints_.RestoreNewest();
    if (!checkpoint) {
      StartFresh();
      return std::nullopt;
    }
    policy::CheckWriter(checkpoint->folder, checkpoint->state, checkpoint->description,
                        run_.config);
    const std::string warning =
        CheckPrecision(*checkpoint, run_.config.learner.precision, precision_);
    if (!warning.empty()) log::Warning("{}", warning);
    agent_->Restore(checkpoint->tensors, (checkpoint->folder / kLearnerFile).string());
    if (agent_->updates() != checkpoint->state.updates) {
      throw RuntimeError("'{}': parameters of update {}, but {} says {}",
                         checkpoint->folder.string(), agent_->updates(), kStateFile,
                         checkpoint->state.updates);
    }
    log::Info("restored {}: {} updates, {} env steps", checkpoint->folder.filename().string(),
              checkpoint->state.updates, checkpoint->state.env_steps);
    return checkpoint->state;
  }

  void StartFresh() {
    const std::filesystem::path initial = folder_ / kInitialWeightsFile;
    if (std::filesystem::exists(initial)) {
      const std::string source = initial.string();
      agent_->Restore(StartTensors(nn::ReadSafetensors(ReadFile(initial), source), source, *agent_),
                      source);
      log::Info("the networks start from {}", source);
      return;
    }
    const nn::TensorMap weights = nn::ReadEncoderWeights(run_.config.network, run_.spec);
    if (weights.empty()) return;
    StartEncoder(weights, agent_.get());
    log::Info("the encoder starts from {}", run_.config.network.encoder_weights);
  }

  const std::filesystem::path folder_;
  const RunMembership member_;
  const RunConfig run_;
  const uint64_t session_;
  const nn::Precision precision_;
  const std::unique_ptr<Agent> agent_;
  CheckpointStore checkpoints_;
  const std::optional<CheckpointState> restored_;
  UpdatePage update_page_;
  PendingEvaluations pending_evaluations_;
  ControlState control_;
  dds::Bus bus_;
  DdsOutlet outlet_;
  const std::unique_ptr<BatchFeed> batches_;
  dds::Subscriber<EvalMessage> evaluation_subscriber_;
  dds::Subscriber<ControlMessage> control_subscriber_;
};

}  // namespace

int RunLearner(const std::filesystem::path& folder, const dds::Reach& reach, char** argv) {
  KeepSecuredRunPrivate(folder);
  const RunConfig run = ReadRunConfig(folder);
  const int threads = LearnerThreads(run.config, UsableCores());
  EnsurePassiveOpenMp(threads, argv);
  nn::SetThreads(threads);
  return Learner(folder, run, reach, threads).Run();
}

}  // namespace shoal::learner
