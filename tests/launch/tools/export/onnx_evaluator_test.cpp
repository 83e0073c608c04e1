// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_evaluator.h"

#include <gmock/gmock.h>

#include "common/base/error.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using testing::HasSubstr;

// action = relu(x - mean) + y
OnnxModel SmallModel() {
  return {.inputs = {{.name = "x", .shape = {2}}, {.name = "y", .shape = {2}}},
          .output = {.name = "action", .shape = {2}},
          .nodes = {{"Sub", {"x", "mean"}, "centred"},
                    {"Relu", {"centred"}, "cut"},
                    {"Add", {"cut", "y"}, "action"}},
          .constants = {{"mean", {{2}, {1, 2}}}}};
}

std::string Refusal(const OnnxModel& model) {
  return ErrorMessage(1, [&] { OnnxEvaluator evaluator(model); });
}

TEST(OnnxEvaluator, RunsNodesInTheirOrder) {
  const OnnxEvaluator evaluator(SmallModel());
  const OnnxTensor x{{2, 2}, {0, 5, 3, 0}}, y{{2, 2}, {10, 20, 30, 40}};
  EXPECT_EQ(evaluator.Run({{"x", x}, {"y", y}}), (OnnxTensor{{2, 2}, {10, 23, 32, 40}}));
}

TEST(OnnxEvaluator, InputsThatDoNotFitAreRefusedByName) {
  const OnnxEvaluator evaluator(SmallModel());
  const OnnxTensor two{{1, 2}, {0, 0}}, three{{1, 3}, {0, 0, 0}};
  EXPECT_THAT(ErrorMessage(1, [&] { evaluator.Run({{"x", two}}); }), HasSubstr("no input 'y'"));
  EXPECT_THAT(ErrorMessage(1,
                           [&] {
                             evaluator.Run({{"x", two}, {"y", three}});
                           }),
              HasSubstr("input 'y' has another shape"));
  EXPECT_THAT(ErrorMessage(1,
                           [&] {
                             evaluator.Run({{"x", two}, {"y", {{2, 2}, {0, 0, 0, 0}}}});
                           }),
              HasSubstr("Add action: expected"));
}

TEST(OnnxEvaluator, AModelThatCannotRunIsRefused) {
  OnnxModel model = SmallModel();
  model.nodes[1].op = "Softmax";
  EXPECT_THAT(Refusal(model), HasSubstr("Softmax cut"));
  model = SmallModel();
  std::swap(model.nodes[0], model.nodes[1]);
  EXPECT_THAT(Refusal(model), HasSubstr("Relu cut: reads 'centred'"));
  model = SmallModel();
  model.nodes[1].output = "x";
  EXPECT_THAT(Refusal(model), HasSubstr("value 'x' is there twice"));
  model = SmallModel();
  model.output.name = "deviation";
  EXPECT_THAT(Refusal(model), HasSubstr("nothing gives the output 'deviation'"));
}

}  // namespace
}  // namespace shoal::launch
