// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/samples.h"

#include "common/nn/safetensors.h"
#include "launch/tools/export/onnx_policy.h"
#include "launch/tools/export/policy_actions.h"

namespace shoal::launch {
namespace {

template <class T>
nn::NamedTensor Tensor(const char* dtype, std::vector<int64_t> shape,
                       const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
  return {dtype, std::move(shape), {bytes, bytes + values.size() * sizeof(T)}};
}

}  // namespace

std::string WriteSamples(const policy::CheckpointPolicy& policy,
                         const std::vector<ObservationSet>& sets) {
  const ObservationSpec& spec = policy.description.spec;
  ObservationSet all;
  for (const ObservationSet& set : sets) {
    all.count += set.count;
    all.frames.insert(all.frames.end(), set.frames.begin(), set.frames.end());
    all.vectors.insert(all.vectors.end(), set.vectors.begin(), set.vectors.end());
  }
  nn::TensorMap tensors;
  if (spec.HasPixels()) {
    tensors[kPixelsInput] =
        Tensor("U8", {all.count, spec.InputChannels(), spec.height, spec.width}, all.frames);
  }
  for (const auto& [name, values] : BlocksOf(spec, all)) {
    tensors[name] = Tensor("F32", {all.count, std::ssize(values) / all.count}, values);
  }
  tensors[kActionOutput] = Tensor("F32", {all.count, spec.action_size}, OwnActions(policy, all));
  return nn::WriteSafetensors(tensors, {{"task", spec.task}});
}

}  // namespace shoal::launch
