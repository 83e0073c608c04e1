// SPDX-License-Identifier: Apache-2.0
#include "common/policy/policy_description.h"

#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/error_message.h"

namespace shoal::policy {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class PolicyDescriptionTest : public testing::Test {
 protected:
  std::string Refusal(const std::function<void(json*)>& change) const {
    json object = json::parse(text_);
    change(&object);
    // A spec of another making, with the hash that belongs to it.
    try {
      const ObservationSpec spec = ObservationSpecFromJson(object.at("spec"));
      if (object.contains("spec_hash")) object["spec_hash"] = fmt::format("{:016x}", spec.Hash());
    } catch (const std::exception&) {  // has none
    }
    return ErrorMessage([&] { ReadDescription(object.dump(), "file"); });
  }

  const RunConfig run_ = SmallRun("td3", /*pixels=*/true);
  const std::string text_ =
      WriteDescription(Describe(run_.config, run_.spec, nn::ActorOutput::kDeterministic));
};

TEST_F(PolicyDescriptionTest, SaysTheSameWhenReadAndWritten) {
  EXPECT_EQ(WriteDescription(ReadDescription(text_, "file")), text_);
}

TEST_F(PolicyDescriptionTest, EveryKeyIsNeeded) {
  const json whole = json::parse(text_);
  for (const auto& item : whole.items()) {
    const std::string key = item.key();
    EXPECT_THAT(Refusal([&](json* object) { object->erase(key); }), HasSubstr("'" + key + "'"));
  }
}

TEST_F(PolicyDescriptionTest, ASpecThatMakesNoSenseIsRefusedNamingIt) {
  const auto spec = [&](const char* key, const json& value) {
    return Refusal([&](json* object) { (*object)["spec"][key] = value; });
  };
  EXPECT_THAT(spec("height", -3), HasSubstr("spec.height = -3"));
  EXPECT_THAT(spec("channels", 100000), HasSubstr("spec.channels = 100000"));
  EXPECT_THAT(spec("stack", 0), HasSubstr("spec.stack = 0"));
  EXPECT_THAT(spec("action_size", 0), HasSubstr("spec.action_size = 0"));
  EXPECT_THAT(spec("width", "wide"), HasSubstr("observation spec"));
  const json block = {{"name", "grip"}, {"size", 3}, {"observed", true}};
  EXPECT_THAT(spec("blocks", {block, block}), HasSubstr("'grip' twice"));
  EXPECT_THAT(Refusal([](json* object) {
                (*object)["spec"]["channels"] = 0;
                (*object)["spec"]["blocks"] = json::array();
              }),
              HasSubstr("neither pixels nor"));
}

TEST_F(PolicyDescriptionTest, AHashThatIsNotTheSpecsIsRefused) {
  json object = json::parse(text_);
  object["spec_hash"] = "0000000000000001";
  EXPECT_THAT(ErrorMessage([&] { ReadDescription(object.dump(), "file"); }),
              HasSubstr("spec_hash is \"0000000000000001\""));
}

TEST_F(PolicyDescriptionTest, LayersAreThoseOfTheNetwork) {
  const auto lines = json::parse(text_).at("layers").get<std::vector<std::string>>();
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0],
            "pixels: pixels, 2x18x16 to 2x9x8, kernel 2, stride 2, padding 0, in [-0.5, 0.5]");
  EXPECT_EQ(lines[1],
            "encoder.conv0: convolution of layer 0, 2x9x8 to 4x7x6, kernel 3, stride 1, padding 0, "
            "bias, relu");
  EXPECT_EQ(lines[4], "input of the MLP: 9 features, vector of 5");
  EXPECT_EQ(lines[5], "actor.mlp.layer0: linear, 14x1x1 to 12x1x1, bias, layer norm, relu");
  EXPECT_EQ(lines[8], "action of 2: deterministic");
}

}  // namespace
}  // namespace shoal::policy
