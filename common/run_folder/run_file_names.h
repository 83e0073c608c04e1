// SPDX-License-Identifier: Apache-2.0
// Names and schemas of the files in a run's folder, each once, with their writers and readers.
// Users and their programs may read all of them. common/checkpoint/checkpoint_files.h has the files
// of a checkpoint. The table of docs/monitoring.md ("The files of a run") has the same names;
// tests/layering compares the two and refuses any other source that spells one.
#pragma once

namespace shoal {

// The resolved configuration of the run: every key, observation spec, hashes. Written when the run
// is created, read by each of its processes. A folder with this file is a run.
inline constexpr char kConfigFile[] = "config.json";
inline constexpr char kConfigSchema[] = "shoal-config-1";

// Address at which the processes of a run find each other. The coordinator writes it before it
// starts them; they read it, and so do `shoal top`, `attach`, `set`, ...
inline constexpr char kClusterFile[] = "cluster.json";
inline constexpr char kClusterSchema[] = "shoal-cluster-1";

// The hosts of a run with actors elsewhere. Written and read by the coordinator.
inline constexpr char kHostsFile[] = "hosts.json";
inline constexpr char kHostsSchema[] = "shoal-hosts-1";

// Initial parameters of the networks. Written by the coordinator, read by the learner.
inline constexpr char kInitialWeightsFile[] = "initial.safetensors";

// Machine, builds, progress and end of the run. Written by the coordinator as the run goes on, read
// by `shoal runs`, experiments, reports.
inline constexpr char kMetaFile[] = "meta.json";
inline constexpr char kMetaSchema[] = "shoal-run-1";

// Figures: the reports of each process, a line each. Written by the coordinator, read by `shoal
// web`.
inline constexpr char kMetricsFile[] = "metrics.jsonl";

// How each role spent its time. Written at the end of a run.
inline constexpr char kBottleneckFile[] = "bottleneck.json";
inline constexpr char kBottleneckSchema[] = "shoal-bottleneck-1";

// Outcomes of all records. Written by their receiver, replay or learner; read by its successor and
// by the coordinator.
inline constexpr char kAccountingFile[] = "accounting.json";
inline constexpr char kAccountingSchema[] = "shoal-accounting-1";

// The replay's ring (replay_server/core/ring_format.h). Written and read by the replay; read by
// `shoal replay`.
inline constexpr char kRingFile[] = "replay.ring";

// Updates done and lost (update_page.h). Written by the learner, read by its successor and by the
// coordinator.
inline constexpr char kUpdatePageFile[] = "learner.page";

// Lock files: the coordinator locks .lock during the run, and each process of the run on this host
// locks .members.
inline constexpr char kRunLockFile[] = ".lock";
inline constexpr char kMembersFile[] = ".members";

// Checkpoints: the newest ones and those that are kept, the best one, and the candidates for the
// best one.
inline constexpr char kCheckpointFolder[] = "checkpoints";
inline constexpr char kBestCheckpoint[] = "best";
inline constexpr char kCandidateFolder[] = "candidates";

// Evaluations: steps_N_updates_N.json of the run itself, on-TASK.json on other tasks, and the
// final one. Written by the coordinator and by `shoal eval`; read by reports and experiments.
inline constexpr char kEvaluationFolder[] = "eval";
inline constexpr char kEvaluationSchema[] = "shoal-eval-1";
inline constexpr char kFinalEvaluationFile[] = "final.json";
inline constexpr char kEvaluationPrefix[] = "steps_";
inline constexpr char kTransferPrefix[] = "on-";

// State of each actor: counters of the records it made, locks, states of rollouts, and the process
// of a host that receives the weights. Written by the actors, read by their successors, their
// neighbours and the coordinator.
inline constexpr char kMadeFolder[] = "made";
inline constexpr char kRolloutSchema[] = "shoal-rollout-3";

// The number of each process's newest session. Written and read when a process starts.
inline constexpr char kSessionFolder[] = "sessions";

// Logs, one file per process; an experiment's folder has one for its runs.
inline constexpr char kLogFolder[] = "logs";

// Event files for TensorBoard. Written by the coordinator.
inline constexpr char kTensorBoardFolder[] = "tensorboard";

// Films. Written by `shoal film`, read by reports and `shoal web`.
inline constexpr char kVideoFolder[] = "videos";

}  // namespace shoal
