// SPDX-License-Identifier: Apache-2.0
// Messages between processes, as plain structs. common/link carries the messages; this file does
// not depend on a transport. docs/wire_format.md gives topics, QoS and byte layout.
//
// Bulk messages borrow their payload; a received payload is valid only during the callback.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shoal {

// Version of the weights. Weights of a newer learner session are newer, even if the update number
// is lower. Session 0: no weights yet.
struct WeightsVersion {
  uint64_t session = 0;  // wall-clock ns at the learner's start: later starts are larger
  uint64_t update = 0;   // number of updates

  bool operator==(const WeightsVersion&) const = default;
  bool NewerThan(const WeightsVersion& other) const {
    return session != other.session ? session > other.session : update > other.update;
  }
};

// Most bytes of a batch or of weights in one message, which stays below 1 MB with its header.
inline constexpr uint64_t kBulkPartBytes = 960 * 1024;

// actor -> the receiver of its records: the replay or, on policy, the learner. The chunk contains
// `count` records of equal size, with sequences first_sequence .. first_sequence+count-1. A chunk
// without records reports that the actor retains no record before first_sequence.
struct TransitionChunk {
  uint64_t spec_hash = 0;
  uint32_t actor = 0;
  uint32_t count = 0;
  uint64_t session = 0;  // wall-clock ns at the actor's start
  uint64_t first_sequence = 0;
  std::span<const uint8_t> payload;
};

// Credit for one actor session, from the receiver of its records: flow control, acknowledgement.
struct Credit {
  // Session of the receiver. If it changes, the actor resends its unacknowledged records.
  uint64_t replay_session = 0;
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t stored = 0;   // every record up to this sequence was handled
  uint64_t allowed = 0;  // highest sequence that may be sent
  // Spec hash of the receiver. An actor with another hash stops with an error naming both.
  uint64_t spec_hash = 0;
  // Newer session of the same actor; the older session must end. 0 = there is no newer session.
  uint64_t superseded_by = 0;
};

// receiver -> all actors: all credits that have changed; every actor receives each message.
struct CreditsMessage {
  std::vector<Credit> credits;
};

// learner -> replay: request for a batch. After a time-out, the learner resends the request
// unchanged. The answer depends only on the request number and on the ring's content.
struct SampleRequest {
  uint64_t spec_hash = 0;
  uint64_t learner_session = 0;
  uint64_t request = 0;  // from 1; selects the sampler's random stream
  uint32_t batch = 0;    // B
  // Lockstep: number of stored step records after which the request is served; 0 = at once.
  uint64_t after_steps = 0;
  uint64_t schema_hash = 0;  // BatchSchema::Hash of the batch (common/wire/batch_schema.h)
  // The learner has released the batches of all requests up to this number, which is < `request`.
  uint64_t released = 0;
  // Whether the answer may be a BatchSlot; else the answer consists of parts.
  bool takes_slots = false;
  // SlotAddress::token[0] of slots that the learner cannot open; 0 = no such slots.
  uint64_t refused_token = 0;
  // Prioritised sampling: samples of an earlier batch and the errors of their values, >= 0, which
  // the replay uses from this request on. The two lists have the same length, at most the number of
  // a batch's samples (docs/decisions/0034-priorities-travel-with-requests.md).
  std::vector<uint64_t> error_ids{};
  std::vector<float> errors{};
};

// replay -> learner: part of one batch in the layout of common/wire/batch_schema.h.
struct BatchPart {
  uint64_t spec_hash = 0;
  uint64_t learner_session = 0;
  uint64_t request = 0;
  uint32_t part = 0, parts = 0;
  uint64_t offset = 0, total_bytes = 0;
  uint64_t stored_records = 0;  // records stored over the whole run when the batch was drawn
  uint64_t stored_steps = 0;    // step records among stored_records: the run's env steps
  // Number of steps stored since this replay's start at which no sample can begin: the n - 1 steps
  // before a time limit, and steps whose later records are not stored yet.
  uint64_t unsampleable_steps = 0;
  std::span<const uint8_t> payload;
};

// Address of slots of batches: shared memory of a process on the same host. A token in the first
// bytes of the memory identifies it (common/wire/batch_slots.h).
struct SlotAddress {
  int32_t pid = 0;
  int32_t descriptor = 0;      // file descriptor in the process `pid`
  uint64_t token[2] = {0, 0};  // random
  uint64_t bytes = 0;          // size of the whole memory
  bool operator==(const SlotAddress&) const = default;
};

// replay -> learner, instead of BatchParts: the whole batch is in a slot. The batch does not change
// until a SampleRequest releases it.
struct BatchSlot {
  uint64_t spec_hash = 0;
  uint64_t learner_session = 0;
  uint64_t request = 0;
  uint64_t stored_records = 0, stored_steps = 0, unsampleable_steps = 0;  // as in BatchPart
  SlotAddress address;
  uint32_t slot = 0;
};

// One version of a policy. The payload is a safetensors file with the parameters.
struct WeightsMessage {
  uint64_t spec_hash = 0;
  WeightsVersion version;
  uint64_t env_steps = 0;  // env steps stored when the version was made
  std::string checkpoint;  // name of the checkpoint folder with the same parameters; may be empty
  std::span<const uint8_t> payload;
};
// The F32 parameters of a checkpoint to evaluate.
struct EvalWeightsMessage : WeightsMessage {};

// learner -> actors: one part of a version's parameters (common/wire/weights_parts.h).
struct WeightsPart {
  uint32_t part = 0;  // from 0
  uint64_t spec_hash = 0;
  WeightsVersion version;
  uint64_t env_steps = 0;
  uint64_t total_bytes = 0;  // size of all parts together
  uint32_t crc = 0;          // CRC-32 of the payload
  std::string checkpoint;
  std::span<const uint8_t> payload;
};
// learner -> evaluation actor. A separate type has a separate topic, so that training weights
// cannot overwrite the evaluation weights.
struct EvalWeightsPart : WeightsPart {};

// every process -> coordinator, 1 Hz. metrics.jsonl uses the same names.
struct MetricsMessage {
  std::string role;  // "actor" | "eval" | "replay" | "learner" | "coordinator"
  uint32_t id = 0;
  std::string host;
  int32_t pid = 0;
  // "starting" | "running" | "blocked" | "idle" | "evaluating" | "draining" | "stopping"
  std::string state;
  double time = 0;  // seconds since 1970
  std::vector<std::string> names;
  std::vector<double> values;
};

// MetricsMessage as one type for each sending role. Each role has its own topic, so that in a
// secured run no other role can send reports of this role.
struct ActorMetrics : MetricsMessage {};
struct EvalMetrics : MetricsMessage {};
struct ReplayMetrics : MetricsMessage {};
struct LearnerMetrics : MetricsMessage {};

// replay -> coordinator, after records were stored. The decisions of the coordinator depend on the
// numbers in progress messages; metrics are only displayed. The newest message of the newest
// session is valid.
struct ReplayProgress {
  uint32_t replay = 0;   // number of the replay server
  uint64_t session = 0;  // session of the replay server
  // Totals of the whole run; stored_steps are the run's env steps.
  uint64_t stored_steps = 0, stored_records = 0;
};

// Parameters that the learner has sent to the evaluation actor.
struct EvaluationRequest {
  uint64_t update = 0, env_steps = 0;
  std::string checkpoint;  // name of the checkpoint's folder
};

// learner -> coordinator. The newest message of the newest session is valid.
struct LearnerProgress {
  static constexpr size_t kMostEvaluations = 32;

  uint64_t session = 0;
  uint64_t updates = 0, env_steps = 0;
  bool drained = false;  // whether the learner has made all updates that the stored steps allow
  std::vector<EvaluationRequest> evaluations{};  // latest requests of this session, oldest first
};

// coordinator -> all other processes. The message with the highest `epoch` is valid.
enum class RunState : uint32_t {
  kRunning = 1,
  kDraining = 2,  // actors stop stepping, send their records, wait until these are stored, exit
  kStopping = 3,  // each process finishes its work, writes its files, exits
};
struct ControlMessage {
  uint64_t epoch = 0;
  RunState state = RunState::kRunning;
  double time = 0;  // heartbeat: published at least once a second
  // Configuration keys that were changed during the run, and their present values. The two lists
  // have the same length. All other keys have the values of config.json.
  std::vector<std::string> setting_names{};
  std::vector<double> setting_values{};
};

// eval actor -> coordinator: one finished evaluation, the JSON of eval/*.json (docs/monitoring.md).
struct EvalMessage {
  uint64_t env_steps = 0;
  WeightsVersion version;
  std::string checkpoint;
  std::string json;
};

// Event of a run, as one line of text for people. Numbers start at 1 and increase by 1.
struct RunEvent {
  uint64_t number = 0;
  double time = 0;  // seconds since 1970
  std::string text;
};

// coordinator -> `shoal top` and other clients, 1 Hz: the state of the whole run.
struct RunViewMessage {
  std::string schema = "shoal-top-1";
  std::string run{};    // name
  double time = 0;      // seconds since 1970
  std::string state{};  // "running" | "draining" | "stopping" | "evaluating" | "ended"
  uint64_t env_steps = 0, updates = 0;
  std::vector<MetricsMessage> processes{};  // ordered by role and id
  std::vector<RunEvent> events{};           // the last events, oldest first
  std::string trouble{};  // one line: which actors do not work, and why; empty if all work
};

// client -> coordinator: a command. The client resends the command unchanged until the reply
// arrives; the coordinator executes it once.
struct CommandMessage {
  uint64_t client = 0;   // identifies the sender
  uint64_t request = 0;  // from 1, per client
  std::string verb;      // "scale" | "set" | "stop"
  std::vector<std::string> arguments{};
};

// coordinator -> the client that sent the command.
struct ReplyMessage {
  uint64_t client = 0, request = 0;
  bool accepted = false;
  std::string text{};  // one line: the result, or the reason of a refusal
  // The configuration key that was changed, if any, with its old and new value.
  std::string key{};
  double from = 0, to = 0;
};

}  // namespace shoal
