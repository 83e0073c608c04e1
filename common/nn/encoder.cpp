// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoder.h"

#include "common/base/check.h"
#include "common/nn/average_pool.h"
#include "common/nn/conv.h"
#include "common/nn/frame_pooling.h"
#include "common/nn/map_arithmetic.h"
#include "common/nn/max_pool.h"
#include "common/nn/primitive_descs.h"
#include "common/nn/spatial_softmax.h"

namespace shoal::nn {

Encoder::Encoder(const LayerContext& context, const NetworkPlan& plan)
    : planes_(context.batch * plan.input().channels),
      height_(plan.input().height),
      width_(plan.input().width) {
  const std::vector<LayerPlan>& layers = plan.layers();
  CHECK(layers.size() > 1 && layers[0].kind == LayerPlan::Kind::kPixels);
  pool_ = layers[0].kernel;
  shift_ = layers[0].range == PixelRange::kUnit ? 0.f : -0.5f;
  const MapShape& pixels = layers[0].output;
  input_ = MakeMemory(
      dnnl::memory::desc({context.batch, pixels.channels, pixels.height, pixels.width},
                         ComputeType(context.precision), dnnl::memory::format_tag::nchw));
  outputs_.push_back({input_, {}});
  Build(context, plan);
  BuildFeatures(context);
}

// Backward passes run from the last layer to the first. If several layers read one map, the last of
// them overwrites the map's gradient and the others add to it.
MapSource Encoder::SourceOf(const NetworkPlan& plan, int reader, int read, MapSource* shared) {
  MapSource source = outputs_[size_t(read)];
  if (!source.gradient) return source;
  const std::vector<LayerPlan>& layers = plan.layers();
  int last = reader;
  for (int i = reader; i < int(layers.size()); ++i) {
    if (layers[size_t(i)].source == read || layers[size_t(i)].skip == read) last = i;
  }
  if (last == reader) return source;
  CHECK(!shared->values) << layers[size_t(reader)].name << " shares two sources";
  *shared = {MakeMemory(source.gradient.get_desc()), source.gradient};
  return {source.values, shared->values};
}

void Encoder::Build(const LayerContext& context, const NetworkPlan& plan) {
  for (int i = 1; i < int(plan.layers().size()); ++i) {
    const LayerPlan& layer = plan.layers()[size_t(i)];
    MapSource shared;
    const MapSource source = SourceOf(plan, i, layer.source, &shared);
    std::unique_ptr<MapLayer> built;
    switch (layer.kind) {
      case LayerPlan::Kind::kConvolution:
        built = std::make_unique<Conv>(context, layer, source.values, source.gradient);
        break;
      case LayerPlan::Kind::kMaxPool:
        built = std::make_unique<MaxPool>(context, layer, source.values, source.gradient);
        break;
      case LayerPlan::Kind::kAveragePool:
        built = std::make_unique<AveragePool>(context, layer, source.values, source.gradient);
        break;
      case LayerPlan::Kind::kSpatialSoftmax:
        built = std::make_unique<SpatialSoftmax>(context, layer, source.values, source.gradient);
        break;
      default:
        CHECK(false) << layer.name << " is no layer of maps";
    }
    stages_.push_back({std::move(built), shared});
    MapSource output{stages_.back().layer->output(), stages_.back().layer->output_gradient()};
    if (!layer.batch_norm.empty()) {
      MapSource shared_skip;
      const MapSource skip =
          layer.skip == kNoLayer ? MapSource() : SourceOf(plan, i, layer.skip, &shared_skip);
      stages_.push_back({std::make_unique<BatchNorm>(context, layer, output, skip), shared_skip});
      output = {stages_.back().layer->output(), stages_.back().layer->output_gradient()};
    }
    outputs_.push_back(output);
  }
}

// The heads read rows, whatever layout the last layer has. One copy here is cheaper than one in
// each head.
void Encoder::BuildFeatures(const LayerContext& context) {
  const dnnl::memory& map = outputs_.back().values;
  const dnnl::memory::dims dims = DimsOf(map);
  const dnnl::memory::data_type type = TypeOf(map);
  const dnnl::memory::desc plain(dims, type, dnnl::memory::format_tag::nchw);
  const dnnl::memory::desc rows({dims[0], dims[1] * dims[2] * dims[3]}, type,
                                dnnl::memory::format_tag::ab);
  flatten_ = Relayout::Before(map, plain, context.scratchpad);
  features_ = dnnl::memory(rows, CpuEngine(), flatten_.memory().get_data_handle());
  if (!context.training) return;
  features_gradient_ = MakeMemory(rows);
  const dnnl::memory gradient_map(plain, CpuEngine(), features_gradient_.get_data_handle());
  unflatten_gradient_ = Op::Reorder(gradient_map, outputs_.back().gradient, context.scratchpad);
}

void Encoder::Refresh() {
  for (const Stage& stage : stages_) stage.layer->Refresh();
}

void Encoder::Forward(const uint8_t* frames, Statistics statistics) {
  const FrameShape shape{planes_, height_, width_};
  if (TypeOf(input_) == dnnl::memory::data_type::bf16) {
    PoolFramesToBf16(frames, shape, pool_, shift_,
                     static_cast<uint16_t*>(input_.get_data_handle()));
  } else {
    PoolFrames(frames, shape, pool_, shift_, static_cast<float*>(input_.get_data_handle()));
  }
  for (const Stage& stage : stages_) stage.layer->Forward(statistics);
  flatten_.Run();
}

void Encoder::Backward() {
  unflatten_gradient_.Run();
  for (size_t i = stages_.size(); i-- > 0;) {
    stages_[i].layer->Backward();
    const MapSource& shared = stages_[i].shared;
    if (shared.values) Add(shared.values, shared.gradient);
  }
}

}  // namespace shoal::nn
