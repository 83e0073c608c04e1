// The table of topics: for each message its name, generated type and quality of service. Internal.
// docs/wire_format.md gives the reasons.
#pragma once

#include "common/dds/qos.h"
#include "common/dds/wire_types.h"

namespace shoal::dds {

using std::chrono_literals::operator""ms;

template <class M>
struct Topic;

template <>
struct Topic<TransitionChunk> {
  using Wire = shoal_idl_TransitionChunk;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_TransitionChunk_desc;
  static constexpr TopicSettings kSettings{"transitions_v1", Plane::kMain, 0, false, true, 200ms};
};

template <>
struct Topic<CreditsMessage> {
  using Wire = shoal_idl_Credits;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Credits_desc;
  static constexpr TopicSettings kSettings{"credits", Plane::kMain, 16, true, false, 100ms};
};

template <>
struct Topic<SampleRequest> {
  using Wire = shoal_idl_SampleRequest;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_SampleRequest_desc;
  static constexpr TopicSettings kSettings{
      "sample_request", Plane::kBatch, 0, false, false, 2000ms};
};

template <>
struct Topic<BatchShard> {
  using Wire = shoal_idl_BatchShard;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_BatchShard_desc;
  static constexpr TopicSettings kSettings{"batch_shard_v1", Plane::kBatch, 0, false, true, 2000ms};
};

template <>
struct Topic<WeightsMessage> {
  using Wire = shoal_idl_Weights;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Weights_desc;
  static constexpr TopicSettings kSettings{"weights_v1", Plane::kMain, 1, true, true, 100ms};
};

template <>
struct Topic<EvalWeightsMessage> {
  using Wire = shoal_idl_Weights;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Weights_desc;
  static constexpr TopicSettings kSettings{"eval_weights_v1", Plane::kMain, 1, true, true, 100ms};
};

template <>
struct Topic<MetricsMessage> {
  using Wire = shoal_idl_Metrics;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Metrics_desc;
  static constexpr TopicSettings kSettings{"metrics", Plane::kMain, 8, false, false, 100ms};
};

template <>
struct Topic<ControlMessage> {
  using Wire = shoal_idl_Control;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Control_desc;
  static constexpr TopicSettings kSettings{"control", Plane::kMain, 1, true, false, 100ms};
};

template <>
struct Topic<EvalMessage> {
  using Wire = shoal_idl_Eval;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Eval_desc;
  static constexpr TopicSettings kSettings{"eval", Plane::kMain, 32, true, false, 100ms};
};

template <>
struct Topic<RunViewMessage> {
  using Wire = shoal_idl_RunView;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_RunView_desc;
  static constexpr TopicSettings kSettings{"run_view", Plane::kOperate, 1, true, false, 100ms};
};

template <>
struct Topic<CommandMessage> {
  using Wire = shoal_idl_Command;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Command_desc;
  static constexpr TopicSettings kSettings{"command", Plane::kOperate, 1, false, false, 100ms};
};

template <>
struct Topic<ReplyMessage> {
  using Wire = shoal_idl_Reply;
  static constexpr const dds_topic_descriptor_t* kType = &shoal_idl_Reply_desc;
  static constexpr TopicSettings kSettings{"reply", Plane::kOperate, 1, false, false, 100ms};
};

}  // namespace shoal::dds
