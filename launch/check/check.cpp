// SPDX-License-Identifier: Apache-2.0
#include "launch/check/check.h"

#include "actor/worlds/environment.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/config_io.h"
#include "common/nn/precision.h"
#include "launch/check/loopback.h"
#include "launch/check/machine_lines.h"
#include "launch/check/training_probe.h"
#include "launch/check/world_lines.h"
#include "launch/processes/scratch_folder.h"
#include "replay_server/core/storage_limits.h"
#include "replay_server/core/storage_needs.h"

namespace shoal::launch {
namespace {

constexpr char kPreset[] = "fetch-reach-drq";
constexpr int kUpdates = 20;
constexpr std::chrono::milliseconds kLoopbackTime{1500};
constexpr double kUpdatesPerSecond = 30;            // loopback must carry the records for these
constexpr uint64_t kBytesPerProcess = 150'000'000;  // in a run from pixels (metrics.jsonl)

Needs NeedsOf(const Config& config) {
  const ObservationSpec spec =
      worlds::MakeEnvironment(config, worlds::MakeRenderContext(config.observation))->spec();
  const replay::StorageNeeds replay = replay::StorageNeedsOf({config, spec});
  Needs needs;
  needs.ring_bytes = replay.ring_bytes;
  // Batches are passed in shared memory; each record crosses loopback once.
  const Schedule& samples = config.replay.samples_per_insert;
  const double records_per_update =
      config.learner.batch / samples.Mean(0, static_cast<uint64_t>(config.env_steps));
  needs.loopback_rate = kUpdatesPerSecond * records_per_update *
                        static_cast<double>(replay.ring_bytes) /
                        static_cast<double>(config.replay.capacity);
  // One actor per core, evaluation actor, learner, replay server, coordinator.
  needs.process_bytes = kBytesPerProcess * static_cast<uint64_t>(UsableCores() + 4);
  return needs;
}

}  // namespace

std::vector<CheckLine> CheckMachine(const CheckRequest& request,
                                    const std::function<void(const CheckLine&)>& show) {
  std::vector<CheckLine> lines;
  const auto look = [&](const std::string& name, const std::string& advice,
                        const std::function<CheckLine()>& at) {
    if (StopRequested()) return false;
    lines.push_back(Guarded(name, advice, at));
    show(lines.back());
    return lines.back().verdict != Verdict::kFail;
  };
  nn::SetThreads(1);
  look("system", "", [] { return JudgeSystem({"/etc/os-release", "/usr/lib/os-release"}); });
  look("cpu", "use an x86-64 CPU that oneDNN supports", [] {
    return JudgeCpu(nn::CpuIsa(), nn::ToString(nn::ChoosePrecision("auto", /*pixels=*/true)));
  });
  look("cores", "", [] { return JudgeCores(ReadCoreLimits()); });
  look("gpu", "", LookAtGpu);

  Config config;
  Needs needs;
  const bool preset = look("preset", "presets lie beside the program or in share/shoal", [&] {
    config = LoadPreset(kPreset);
    config.observation.quality = "native";  // the only quality that needs no OpenGL
    needs = NeedsOf(config);
    return CheckLine{"preset", Verdict::kOk, fmt::format("{}: task {}", kPreset, config.task), ""};
  });
  if (!preset) return lines;
  look("rendering", "run the renderer's tests: ./run test -R Pictures",
       [&] { return LookAtPictures(config); });
  look("opengl", "", [&] { return LookAtOpenGl(config); });
  look("physics", "use Debian's libmujoco2.2.2: another engine has other physics", LookAtPhysics);
  look("dds loopback", "see that UDP passes on the loopback interface and no firewall drops it",
       [&] {
         return JudgeLoopback(MeasureLoopback(config.transport, kLoopbackTime),
                              needs.loopback_rate / 1e6);
       });
  look("disk", "free some space, lower replay.capacity or move run_dir",
       [&] { return LookAtDisk(request.run_dir, needs); });
  look("memory", "", [&] {
    const replay::MemoryRoom room = replay::AvailableMemory();
    return JudgeMemory(room.bytes, room.source, needs);
  });
  look("shared memory", "", [&] { return LookAtSharedMemory("/dev/shm"); });
  look("training", "run the tests (./run test) to see which part fails", [&] {
    const ScratchFolder folder(ExistingFolder(request.run_dir));
    return JudgeTraining(ProbeTraining(config, folder.path(), kUpdates));
  });
  return lines;
}

}  // namespace shoal::launch
