// SPDX-License-Identifier: Apache-2.0
// Names and schemas of the files in a run's folder, with their writers and readers. Users and their
// programs may read all of these files. The files of a checkpoint are in
// common/checkpoint/checkpoint_files.h. The table of docs/monitoring.md ("The files of a run") has
// the same names. A test (tests/layering) compares the table with this header, and fails if another
// source file contains one of the names as a literal.
#pragma once

namespace shoal {

// The resolved configuration of the run: every key, observation spec, hashes. Written when the run
// is created, read by each process of the run. A folder with this file is a run.
inline constexpr char kConfigFile[] = "config.json";
inline constexpr char kConfigSchema[] = "shoal-config-1";

// Address at which the processes of a run find each other. Written by the coordinator before it
// starts the other processes; read by these processes and by `shoal top`, `attach`, `set`, ...
inline constexpr char kClusterFile[] = "cluster.json";
inline constexpr char kClusterSchema[] = "shoal-cluster-1";

// The hosts of a run with actors on several hosts. Written and read by the coordinator.
inline constexpr char kHostsFile[] = "hosts.json";
inline constexpr char kHostsSchema[] = "shoal-hosts-1";

// Initial parameters of the networks. Written by the coordinator, read by the learner.
inline constexpr char kInitialWeightsFile[] = "initial.safetensors";

// Machine, builds, progress and end of the run. Written by the coordinator during the run, read by
// `shoal runs`, experiments and reports.
inline constexpr char kMetaFile[] = "meta.json";
inline constexpr char kMetaSchema[] = "shoal-run-1";

// Metrics: the reports of all processes, one line for each report. Written by the coordinator, read
// by `shoal web`.
inline constexpr char kMetricsFile[] = "metrics.jsonl";

// How each role spent its time. Written at the end of a run.
inline constexpr char kBottleneckFile[] = "bottleneck.json";
inline constexpr char kBottleneckSchema[] = "shoal-bottleneck-1";

// Outcomes of all records. Written by the receiver of the records (replay or learner), read by a
// restarted receiver and by the coordinator.
inline constexpr char kAccountingFile[] = "accounting.json";
inline constexpr char kAccountingSchema[] = "shoal-accounting-1";

// The replay's ring (replay_server/core/ring_format.h). Written and read by the replay; read by
// `shoal replay`.
inline constexpr char kRingFile[] = "replay.ring";

// Counts of updates, and of lost updates (update_page.h). Written by the learner, read by a
// restarted learner and by the coordinator.
inline constexpr char kUpdatePageFile[] = "learner.page";

// Processor that computes the updates (learner_device_file.h), if learner.device is not "cpu".
// Written by the learner; read by a restarted learner and by the coordinator, which removes the
// file when the run starts or resumes.
inline constexpr char kLearnerDeviceFile[] = "learner_device.json";
inline constexpr char kLearnerDeviceSchema[] = "shoal-learner-device-1";

// Lock files: the coordinator locks .lock during the run, and each process of the run on this host
// locks .members.
inline constexpr char kRunLockFile[] = ".lock";
inline constexpr char kMembersFile[] = ".members";

// Checkpoints: the newest checkpoints, the checkpoints that are kept, the best checkpoint, and the
// candidates for the best checkpoint.
inline constexpr char kCheckpointFolder[] = "checkpoints";
inline constexpr char kBestCheckpoint[] = "best";
inline constexpr char kCandidateFolder[] = "candidates";

// Evaluations: steps_N_updates_N.json on the task of the run, on-TASK.json on other tasks, and the
// final evaluation. Written by the coordinator and by `shoal eval`, read by reports and
// experiments.
inline constexpr char kEvaluationFolder[] = "eval";
inline constexpr char kEvaluationSchema[] = "shoal-eval-1";
inline constexpr char kFinalEvaluationFile[] = "final.json";
inline constexpr char kEvaluationPrefix[] = "steps_";
inline constexpr char kTransferPrefix[] = "on-";

// State of each actor: counters of the records that it made, locks, states of rollouts, and the
// process that receives the weights for all actors of a host. Written by the actors; read by
// restarted actors, by the other actors of the host and by the coordinator.
inline constexpr char kMadeFolder[] = "made";
inline constexpr char kRolloutSchema[] = "shoal-rollout-3";

// The number of each process's newest session. Written and read when a process starts.
inline constexpr char kSessionFolder[] = "sessions";

// Logs, one file for each process. The folder of an experiment has one log file for each run.
inline constexpr char kLogFolder[] = "logs";

// Event files for TensorBoard. Written by the coordinator.
inline constexpr char kTensorBoardFolder[] = "tensorboard";

// Films. Written by `shoal film`, read by reports and `shoal web`.
inline constexpr char kVideoFolder[] = "videos";

}  // namespace shoal
