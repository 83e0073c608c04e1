#include "common/nn/encoder.h"

#include "common/base/check.h"
#include "common/nn/frame_pooling.h"

namespace shoal::nn {

Encoder::Encoder(const LayerContext& context, const NetworkPlan& plan)
    : planes_(context.batch * plan.input().channels),
      height_(plan.input().height),
      width_(plan.input().width) {
  const std::vector<LayerPlan>& layers = plan.layers();
  CHECK(layers.size() > 1 && layers[0].kind == LayerPlan::Kind::kPixels);
  pool_ = layers[0].kernel;
  const MapShape& pixels = layers[0].output;
  input_ = MakeMemory(
      dnnl::memory::desc({context.batch, pixels.channels, pixels.height, pixels.width},
                         ComputeType(context.precision), dnnl::memory::format_tag::nchw));
  dnnl::memory source = input_, source_gradient;
  for (size_t i = 1; i < layers.size(); ++i) {
    CHECK(layers[i].kind == LayerPlan::Kind::kConvolution) << layers[i].name;
    convs_.push_back(std::make_unique<Conv>(context, layers[i], source, source_gradient));
    source = convs_.back()->output();
    source_gradient = convs_.back()->output_gradient();
  }
  BuildFeatures(context);
}

// The heads see rows, whatever layout the last convolution has: one copy here is cheaper than one
// in each of them.
void Encoder::BuildFeatures(const LayerContext& context) {
  const dnnl::memory& map = convs_.back()->output();
  const dnnl::memory::dims dims = map.get_desc().dims();
  const dnnl::memory::data_type type = map.get_desc().data_type();
  const dnnl::memory::desc plain(dims, type, dnnl::memory::format_tag::nchw);
  const dnnl::memory::desc rows({dims[0], dims[1] * dims[2] * dims[3]}, type,
                                dnnl::memory::format_tag::ab);
  flatten_ = Relayout::Before(map, plain, context.scratchpad);
  features_ = dnnl::memory(rows, CpuEngine(), flatten_.memory().get_data_handle());
  if (!context.training) return;
  features_gradient_ = MakeMemory(rows);
  const dnnl::memory gradient_map(plain, CpuEngine(), features_gradient_.get_data_handle());
  unflatten_gradient_ =
      Op::Reorder(gradient_map, convs_.back()->output_gradient(), context.scratchpad);
}

void Encoder::Refresh() {
  for (const auto& conv : convs_) conv->Refresh();
}

void Encoder::Forward(const uint8_t* frames) {
  const FrameShape shape{planes_, height_, width_};
  if (input_.get_desc().data_type() == dnnl::memory::data_type::bf16) {
    PoolFramesToBf16(frames, shape, pool_, static_cast<uint16_t*>(input_.get_data_handle()));
  } else {
    PoolFrames(frames, shape, pool_, static_cast<float*>(input_.get_data_handle()));
  }
  for (const auto& conv : convs_) conv->Forward();
  flatten_.Run();
}

void Encoder::Backward() {
  unflatten_gradient_.Run();
  for (size_t i = convs_.size(); i-- > 0;) convs_[i]->Backward();
}

}  // namespace shoal::nn
