// SPDX-License-Identifier: Apache-2.0
// The list of messages between processes, one line each. Topics, writers, readers and the rights of
// roles are derived from this list. A new message needs:
//
// - its struct (common/wire/messages.h) and the list of its fields (common/wire/message_fields.h);
// - a line in this list, and a key if the topic keeps the last n samples per key (topic.h);
// - for the network, its type (common/dds/shoal.idl) and its parser (message_cdr.h or bulk_cdr.h).
//
// docs/wire_format.md gives the reasons for the values. The columns are:
//
//   message           struct, in namespace shoal
//   type              type on the network, generated from shoal.idl
//   topic             name of the topic; each message has one topic
//   plane             role.h
//   kept              n: the last n samples per key are kept, and a write never waits;
//                     0: all samples are kept until every reader has them, and a write may wait
//   late, now         whether a late joiner receives the kept samples
//   bulk, small       bulk: a @final type in plain CDR; small: an @appendable type
//   ms                longest wait of a write, in milliseconds
//   writers, readers  roles
#pragma once

#define SHOAL_MESSAGES(X)                                                                          \
  X(TransitionChunk, TransitionChunk, "transitions_v1", Main, 0, now, bulk, 200, (kActor),         \
    (kReplay, kLearner))                                                                           \
  X(CreditsMessage, Credits, "credits", Main, 16, late, small, 100, (kReplay, kLearner), (kActor)) \
  X(SampleRequest, SampleRequest, "sample_request", Batch, 0, now, small, 2000, (kLearner),        \
    (kReplay))                                                                                     \
  X(BatchPart, BatchPart, "batch_part_v2", Batch, 0, now, bulk, 2000, (kReplay), (kLearner))       \
  X(BatchSlot, BatchSlot, "batch_slot", Batch, 0, now, small, 2000, (kReplay), (kLearner))         \
  X(WeightsPart, WeightsPart, "weights_v2", Main, 1, late, bulk, 100, (kLearner), (kActor))        \
  X(EvalWeightsPart, WeightsPart, "eval_weights_v2", Main, 1, late, bulk, 100, (kLearner),         \
    (kEval))                                                                                       \
  X(ActorMetrics, Metrics, "metrics_actor", Main, 8, now, small, 100, (kActor), (kCoordinator))    \
  X(EvalMetrics, Metrics, "metrics_eval", Main, 8, now, small, 100, (kEval), (kCoordinator))       \
  X(ReplayMetrics, Metrics, "metrics_replay", Main, 8, now, small, 100, (kReplay), (kCoordinator)) \
  X(LearnerMetrics, Metrics, "metrics_learner", Main, 8, now, small, 100, (kLearner),              \
    (kCoordinator))                                                                                \
  X(ReplayProgress, ReplayProgress, "replay_progress", Main, 1, late, small, 100, (kReplay),       \
    (kCoordinator))                                                                                \
  X(LearnerProgress, LearnerProgress, "learner_progress", Main, 1, late, small, 100, (kLearner),   \
    (kCoordinator))                                                                                \
  X(ControlMessage, Control, "control", Main, 1, late, small, 100, (kCoordinator),                 \
    (kLearner, kReplay, kActor, kEval))                                                            \
  X(EvalMessage, Eval, "eval", Main, 32, late, small, 100, (kEval), (kCoordinator, kLearner))      \
  X(RunViewMessage, RunView, "run_view", Operate, 1, late, small, 100, (kCoordinator), (kClient))  \
  X(CommandMessage, Command, "command", Operate, 1, now, small, 100, (kClient), (kCoordinator))    \
  X(ReplyMessage, Reply, "reply", Operate, 1, now, small, 100, (kCoordinator), (kClient))
