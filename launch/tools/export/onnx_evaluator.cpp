// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_evaluator.h"

#include <set>
#include <utility>

#include "common/base/error.h"
#include "launch/tools/export/onnx_operators.h"

namespace shoal::launch {

OnnxEvaluator::OnnxEvaluator(OnnxModel model) : model_(std::move(model)) {
  std::set<std::string> values;
  const auto define = [&](const std::string& name) {
    if (!values.insert(name).second) throw RuntimeError("value '{}' is there twice", name);
  };
  for (const auto& [name, constant] : model_.constants) define(name);
  for (const OnnxPort& input : model_.inputs) define(input.name);
  for (const OnnxNode& node : model_.nodes) {
    if (FindOnnxOperator(node.op) == nullptr) {
      throw RuntimeError("{} {}: an operator that is not known here", node.op, node.output);
    }
    if (node.inputs.empty()) throw RuntimeError("{} {}: no inputs", node.op, node.output);
    for (const std::string& input : node.inputs) {
      if (values.contains(input)) continue;
      throw RuntimeError("{} {}: reads '{}', which there is not", node.op, node.output, input);
    }
    define(node.output);
  }
  if (!values.contains(model_.output.name)) {
    throw RuntimeError("nothing gives the output '{}'", model_.output.name);
  }
}

OnnxTensor OnnxEvaluator::Run(const std::map<std::string, OnnxTensor>& inputs) const {
  std::map<std::string, OnnxTensor> values;
  for (const OnnxPort& port : model_.inputs) {
    const auto at = inputs.find(port.name);
    if (at == inputs.end()) throw RuntimeError("no input '{}'", port.name);
    const OnnxTensor& value = at->second;
    const bool fits = value.shape.size() == port.shape.size() + 1 &&
                      std::equal(port.shape.begin(), port.shape.end(), value.shape.begin() + 1) &&
                      value.values.size() == Count(value.shape);
    if (!fits) throw RuntimeError("input '{}' has another shape than the model's", port.name);
    values[port.name] = value;
  }
  const auto find = [&](const std::string& name) {
    const auto constant = model_.constants.find(name);
    return constant == model_.constants.end() ? &values.at(name) : &constant->second;
  };
  for (const OnnxNode& node : model_.nodes) {
    std::vector<const OnnxTensor*> arguments;
    for (const std::string& input : node.inputs) arguments.push_back(find(input));
    values[node.output] = FindOnnxOperator(node.op)(node, arguments);
  }
  return *find(model_.output.name);
}

}  // namespace shoal::launch
