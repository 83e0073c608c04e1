// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/batch_part.h"

#include <gtest/gtest.h>

#include <map>
#include <span>
#include <string>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

const BatchOptions kOptions{
    .batch = 6, .rollout = true, .probabilities = true, .privileged = {"hidden"}};

ObservationSpec PrivilegedSpec() {
  ObservationSpec spec = SmallSpec();
  spec.blocks.push_back({"hidden", 3, /*observed=*/false});
  return spec;
}

template <class T>
void ExpectRowsByName(const BatchView& whole, const std::string& name) {
  const std::span<T> all = whole.Array<T>(name);
  for (int i = 0; i < 3; ++i) {
    const std::span<T> part = PartOf(whole, {2 * i, 2}).Array<T>(name);
    EXPECT_EQ(part.size(), all.size() / 3) << name;
    EXPECT_EQ(part.data(), all.data() + part.size() * size_t(i)) << name;
  }
}

TEST(PartOf, HasItsRowsOfEachMember) {
  const RandomBatch random(PrivilegedSpec(), kOptions, 3);
  BatchView whole = random.View();
  whole.stored_steps = 70;
  for (const nn::Replica::Rows& rows : {nn::Replica::Rows{0, 6}, {0, 2}, {2, 1}, {3, 3}}) {
    BatchView part = PartOf(whole, rows);
    EXPECT_EQ(part.stored_steps, 70u);
    EXPECT_EQ(part.rows(), size_t(rows.count));
    std::map<std::string, const void*> own;
    VisitArrays(part, [&](const char* name, const auto& array) { own[name] = array.data(); });
    VisitArrays(whole, [&](const char* name, const auto& all) {
      ASSERT_FALSE(all.empty()) << name;
      EXPECT_EQ(own.at(name), all.data() + all.size() / 6 * size_t(rows.begin)) << name;
    });
    VisitArrays(part, [&](const char* name, const auto& array) {
      EXPECT_EQ(array.size() % part.rows(), 0u) << name;
    });
  }
}

TEST(PartOf, RefusesRowsThatTheBatchDoesNotHave) {
  const RandomBatch random(PrivilegedSpec(), kOptions, 3);
  EXPECT_DEATH(PartOf(random.View(), {4, 3}), "rows 4 to 7 of 6");
}

// Also one that has no member.
TEST(PartOf, HasItsRowsOfAnyArrayByName) {
  const RandomBatch random(PrivilegedSpec(), kOptions, 3);
  const BatchView whole = random.View();
  ASSERT_GT(whole.schema->arrays().size(), 10u);
  for (const BatchArray& array : whole.schema->arrays()) {
    if (array.type == ArrayType::kF32) ExpectRowsByName<float>(whole, array.name);
    if (array.type == ArrayType::kU8) ExpectRowsByName<uint8_t>(whole, array.name);
    if (array.type == ArrayType::kU64) ExpectRowsByName<uint64_t>(whole, array.name);
  }
}

TEST(PartOf, OfAPartIsAPart) {
  const RandomBatch random(PrivilegedSpec(), kOptions, 3);
  const BatchView whole = random.View(), part = PartOf(PartOf(whole, {3, 3}), {2, 1});
  EXPECT_EQ(part.Array<uint64_t>("id").data(), &whole.id[5]);
  EXPECT_EQ(part.Array<uint64_t>("id").size(), 1u);
  EXPECT_EQ(part.id.data(), &whole.id[5]);
}

}  // namespace
}  // namespace shoal::learner
