// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_model.h"

#include <cstring>
#include <limits>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "launch/tools/export/onnx.pb.h"

namespace shoal::launch {
namespace {

constexpr int kFloatAttribute = 1, kIntAttribute = 2, kIntsAttribute = 7;
constexpr char kBatch[] = "N";

void Write(const OnnxAttribute& value, onnx::proto::Attribute* out) {
  if (const auto* number = std::get_if<float>(&value)) {
    out->set_type(kFloatAttribute);
    out->set_f(*number);
  } else if (const auto* integer = std::get_if<int64_t>(&value)) {
    out->set_type(kIntAttribute);
    out->set_i(*integer);
  } else {
    out->set_type(kIntsAttribute);
    for (const int64_t i : std::get<std::vector<int64_t>>(value)) out->add_ints(i);
  }
}

void Write(const OnnxNode& node, onnx::proto::Node* out) {
  out->set_name(node.output);
  out->set_op_type(node.op);
  for (const std::string& input : node.inputs) out->add_input(input);
  out->add_output(node.output);
  for (const auto& [name, value] : node.attributes) {
    onnx::proto::Attribute* attribute = out->add_attribute();
    attribute->set_name(name);
    Write(value, attribute);
  }
}

void Write(const OnnxPort& port, onnx::proto::ValueInfo* out) {
  out->set_name(port.name);
  auto* type = out->mutable_type()->mutable_tensor_type();
  type->set_elem_type(int(port.type));
  type->mutable_shape()->add_dim()->set_dim_param(kBatch);
  for (const int64_t size : port.shape) type->mutable_shape()->add_dim()->set_dim_value(size);
}

void Write(const std::string& name, const OnnxTensor& tensor, onnx::proto::Tensor* out) {
  out->set_name(name);
  out->set_data_type(int(OnnxPort::Type::kF32));
  for (const int64_t size : tensor.shape) out->add_dims(size);
  out->set_raw_data(tensor.values.data(), tensor.values.size() * sizeof(float));
}

// Reads one file. Every error names the file.
class Reader {
 public:
  explicit Reader(std::string source) : source_(std::move(source)) {}

  OnnxModel Read(std::string_view bytes) const {
    onnx::proto::Model model;
    if (bytes.size() > size_t(std::numeric_limits<int>::max()) ||
        !model.ParseFromArray(bytes.data(), int(bytes.size()))) {
      throw RuntimeError("{}: not an ONNX file", source_);
    }
    Expect(model.opset_import_size() == 1 && model.opset_import(0).domain().empty() &&
               model.opset_import(0).version() == kOnnxOperatorSet,
           "the operator set", fmt::format("version {} alone", kOnnxOperatorSet));
    const onnx::proto::Graph& graph = model.graph();
    Expect(graph.output_size() == 1, "the graph", "one output");
    OnnxModel result;
    for (const auto& input : graph.input()) result.inputs.push_back(ReadPort(input));
    result.output = ReadPort(graph.output(0));
    for (const auto& node : graph.node()) result.nodes.push_back(ReadNode(node));
    for (const auto& tensor : graph.initializer()) {
      result.constants[tensor.name()] = ReadTensor(tensor);
    }
    for (const auto& entry : model.metadata_props()) result.metadata[entry.key()] = entry.value();
    return result;
  }

 private:
  void Expect(bool good, const std::string& what, const std::string& expected) const {
    if (!good) throw RuntimeError("{}: {}: expected {}", source_, what, expected);
  }

  OnnxPort ReadPort(const onnx::proto::ValueInfo& in) const {
    const auto& type = in.type().tensor_type();
    OnnxPort port{.name = in.name(), .type = OnnxPort::Type(type.elem_type()), .shape = {}};
    Expect(port.type == OnnxPort::Type::kF32 || port.type == OnnxPort::Type::kU8, in.name(),
           "f32 or u8");
    Expect(type.shape().dim_size() > 0 && type.shape().dim(0).dim_param() == kBatch, in.name(),
           "the batch as its first dimension");
    for (int i = 1; i < type.shape().dim_size(); ++i) {
      port.shape.push_back(type.shape().dim(i).dim_value());
    }
    return port;
  }

  OnnxAttribute ReadAttribute(const onnx::proto::Attribute& in) const {
    if (in.type() == kFloatAttribute) return in.f();
    if (in.type() == kIntAttribute) return int64_t{in.i()};
    Expect(in.type() == kIntsAttribute, "attribute " + in.name(), "a number or integers");
    return std::vector<int64_t>(in.ints().begin(), in.ints().end());
  }

  OnnxNode ReadNode(const onnx::proto::Node& in) const {
    Expect(in.output_size() == 1, in.op_type() + " " + in.name(), "one output");
    OnnxNode node{.op = in.op_type(),
                  .inputs = {in.input().begin(), in.input().end()},
                  .output = in.output(0)};
    for (const auto& a : in.attribute()) node.attributes.emplace(a.name(), ReadAttribute(a));
    return node;
  }

  OnnxTensor ReadTensor(const onnx::proto::Tensor& in) const {
    OnnxTensor tensor{.shape = {in.dims().begin(), in.dims().end()}};
    uint64_t count = 1;
    const uint64_t most = in.raw_data().size();
    for (const int64_t size : tensor.shape) {
      Expect(size > 0 && uint64_t(size) <= most / count, in.name(), "as many bytes as its shape");
      count *= uint64_t(size);
    }
    Expect(in.data_type() == int(OnnxPort::Type::kF32), in.name(), "f32");
    Expect(count * sizeof(float) == most, in.name(), "as many bytes as its shape");
    tensor.values.resize(count);
    std::memcpy(tensor.values.data(), in.raw_data().data(), most);
    return tensor;
  }

  const std::string source_;
};

}  // namespace

size_t Count(const std::vector<int64_t>& shape) {
  size_t count = 1;
  for (const int64_t size : shape) count *= size_t(size);
  return count;
}

std::string WriteOnnx(const OnnxModel& model) {
  onnx::proto::Model out;
  out.set_ir_version(kOnnxIrVersion);
  out.set_producer_name("shoal");
  out.set_producer_version(BuildVersion());
  out.add_opset_import()->set_version(kOnnxOperatorSet);
  onnx::proto::Graph* graph = out.mutable_graph();
  graph->set_name("policy");
  for (const OnnxPort& input : model.inputs) Write(input, graph->add_input());
  Write(model.output, graph->add_output());
  for (const OnnxNode& node : model.nodes) Write(node, graph->add_node());
  for (const auto& [name, tensor] : model.constants) Write(name, tensor, graph->add_initializer());
  for (const auto& [key, value] : model.metadata) {
    onnx::proto::Property* entry = out.add_metadata_props();
    entry->set_key(key);
    entry->set_value(value);
  }
  const size_t bytes = out.ByteSizeLong();
  if (bytes > size_t(std::numeric_limits<int>::max())) {
    throw RuntimeError(
        "the network has {} bytes: expected less than 2 GB, the most of an ONNX file", bytes);
  }
  std::string result;
  out.SerializeToString(&result);
  return result;
}

OnnxModel ReadOnnx(std::string_view bytes, const std::string& source) {
  return Reader(source).Read(bytes);
}

}  // namespace shoal::launch
