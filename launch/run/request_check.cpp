// SPDX-License-Identifier: Apache-2.0
#include "launch/run/request_check.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/on_policy.h"
#include "common/config/sending_window.h"
#include "common/config/thread_limit.h"
#include "common/credentials/credentials.h"
#include "common/dds/role_rights.h"
#include "common/nn/encoder_weights.h"
#include "common/nn/named_weights.h"
#include "common/nn/network_check.h"
#include "common/policy/checkpoint_writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/spec/record.h"
#include "common/wire/weights_parts.h"
#include "launch/processes/run_hosts.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/network_start.h"
#include "learner/agent/value_bounds.h"
#include "learner/learner_device.h"
#include "replay_server/core/hindsight.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/core/storage_limits.h"
#include "replay_server/core/storage_needs.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// Checks that the network fits into a message of weights, that the learner's threads can divide the
// batch, and that this host, which runs the learner, has enough cores.
void CheckNetwork(const RunConfig& run) {
  nn::CheckNetwork(run.config.network, run.spec, run.config.learner.batch,
                   int64_t{kMaxWeightsBytes});
  learner::ReplicasOf(run.config, run.spec, run.config.learner.threads);
  CheckCores("learner.threads", run.config.learner.threads, ReadCoreLimits());
}

// Runs `read`, which takes weights from a file. If they do not fit and the file belongs to a
// checkpoint, the refusal also names the difference between the networks.
template <class Read>
void NamingBothNetworks(const std::string& file, const NetworkConfig& network, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string difference = policy::DifferenceFromWriter(file, network);
    if (difference.empty()) throw;
    throw UsageError("{}; the networks differ: {}", error.what(), difference);
  }
}

// Reads network.encoder_weights and --init-from like the learner, to report errors before the
// start.
void ReadStartWeights(const TrainOptions& options, RunRequest* request) {
  const RunConfig& run = request->config;
  const NetworkConfig& network = run.config.network;
  NamingBothNetworks(network.encoder_weights, network,
                     [&] { nn::ReadEncoderWeights(network, run.spec); });
  if (options.init_from.empty()) return;
  if (!network.encoder_weights.empty()) {
    throw UsageError(
        "--init-from: network.encoder_weights is also set: expected only one of the two");
  }
  request->initial_weights = nn::ReadNamedWeights(options.init_from, options.name_map);
  const auto agent = learner::MakeAgent(run.config, run.spec, nn::Precision::kF32);
  NamingBothNetworks(options.init_from, network, [&] {
    learner::StartTensors(request->initial_weights, options.init_from, *agent);
  });
}

// Returns the nearest existing parent folder of a fresh run. Throws Error if it is not writable.
fs::path CheckFolder(const Config& config) {
  std::error_code error;
  fs::path folder = fs::absolute(config.run_dir);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (access(folder.c_str(), W_OK) != 0) {
    throw RuntimeError("cannot create folder '{}': {}",
                       (fs::path(config.run_dir) / config.run_name).string(), std::strerror(errno));
  }
  return folder;
}

// `folder`: the folder of an existing run; empty for a fresh one.
void CheckReplay(const RunConfig& run, const fs::path& folder) {
  const Config& config = run.config;
  CheckSendingWindow(config, RecordLayout(run.spec).record_bytes());
  if (LearnsOnPolicy(config)) {  // such runs have no replay
    if (folder.empty()) CheckFolder(config);
    return;
  }
  replay::CheckHindsight(run);
  replay::CheckSampling(run);
  CheckCores("replay.threads", config.replay.threads, ReadCoreLimits());
  learner::CheckValueBounds(run);
  const replay::StorageNeeds needs = replay::StorageNeedsOf(run);
  if (config.replay.storage == "memory") {
    replay::CheckMemoryRoom(needs.memory_bytes + needs.ring_bytes);
    return;
  }
  replay::CheckMemoryRoom(needs.memory_bytes, "stop other programs");  // without the ring
  if (folder.empty()) {
    replay::CheckDiskRoom(CheckFolder(config), needs.ring_bytes);
  } else if (!fs::exists(folder / kRingFile)) {
    replay::CheckDiskRoom(folder, needs.ring_bytes);
  }
}

}  // namespace

void CheckOpenFiles() {
  constexpr rlim_t kLeast = 32;
  struct rlimit limit {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kLeast) return;
  throw RuntimeError("a process may open {} files (ulimit -n): expected at least {}",
                     limit.rlim_cur, kLeast);
}

void CheckRequest(const TrainOptions& options, RunRequest* request) {
  CheckNetwork(request->config);
  learner::CheckLearnerDevice(request->config);
  if (!request->resumed()) ReadStartWeights(options, request);
  CheckReplay(request->config, request->resumed() ? request->folder->path() : fs::path());
  CheckHosts(request->hosts, StopRequested);
}

void CheckRunCredentials(const std::string& secure) {
  if (secure.empty()) return;
  for (const RoleRights& rights : dds::AllRoleRights()) {
    if (rights.role == "client") continue;
    CheckCredentials(secure, rights.role, std::time(nullptr));
    CheckRights(secure, rights);
  }
}

}  // namespace shoal::launch
