#include "common/nn/critic_heads.h"

#include <algorithm>

namespace shoal::nn {

CriticHeads::CriticHeads(const LayerContext& context, const std::string& head,
                         const NetworkConfig& network, const ObservationSpec& spec,
                         const dnnl::memory& features, const dnnl::memory& features_gradient)
    : trunk_(context, head, spec, spec.action_size, features, features_gradient),
      mlps_{Mlp(context, head + ".q1", int(network.hidden.size()), trunk_.input()),
            Mlp(context, head + ".q2", int(network.hidden.size()), trunk_.input())},
      action_size_(spec.action_size),
      input_gradient_(size_t(trunk_.input().size())) {}

void CriticHeads::Refresh() {
  trunk_.Refresh();
  for (Mlp& mlp : mlps_) mlp.Refresh();
}

void CriticHeads::ForwardObservation(const float* vector) { trunk_.Forward(vector); }

void CriticHeads::ForwardAction(const float* action) {
  trunk_.input().SetColumns(trunk_.extra_column(), action_size_, action);
  trunk_.input().Commit();
  for (Mlp& mlp : mlps_) mlp.Forward();
}

void CriticHeads::Backward(const float* q0_gradient, const float* q1_gradient) {
  mlps_[0].Backward(q0_gradient, {.parameters = true, .source = true});
  mlps_[1].Backward(q1_gradient, {.parameters = true, .source = true});
  for (size_t i = 0; i < input_gradient_.size(); ++i) {
    input_gradient_[i] = mlps_[0].input_gradient()[i] + mlps_[1].input_gradient()[i];
  }
  trunk_.Backward(input_gradient_.data());
}

void CriticHeads::BackwardAction(const float* q0_gradient, const float* q1_gradient,
                                 float* action_gradient) {
  mlps_[0].Backward(q0_gradient, {.parameters = false, .source = true});
  mlps_[1].Backward(q1_gradient, {.parameters = false, .source = true});
  const int columns = trunk_.input().columns();
  for (int b = 0; b < trunk_.input().batch(); ++b) {
    const int64_t first = int64_t(b) * columns + trunk_.extra_column();
    for (int j = 0; j < action_size_; ++j) {
      action_gradient[b * action_size_ + j] =
          mlps_[0].input_gradient()[first + j] + mlps_[1].input_gradient()[first + j];
    }
  }
}

}  // namespace shoal::nn
