// SPDX-License-Identifier: Apache-2.0
// Sets and optimisers copy values between host and mirror when the older copy is used, and only
// then.
#include "common/nn/parameter_mirror.h"

#include <gmock/gmock.h>

#include <memory>
#include <vector>

#include "common/nn/adam.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {
namespace {

using testing::ElementsAre;

constexpr size_t kMirrored = 3;

// Values of a mirror, and the copies so far.
struct MirrorStore {
  std::vector<float> values = std::vector<float>(kMirrored), m = values, v = values;
  uint64_t steps = 0;
  int fetches = 0, sends = 0;
};

class FakeParameters final : public ParameterMirror {
 public:
  explicit FakeParameters(MirrorStore* store) : store_(store) {}
  std::function<void(float* values)> BeginFetch() override {
    ++store_->fetches;
    return [copy = store_->values](float* values) { std::copy_n(copy.begin(), kMirrored, values); };
  }
  void Send(const float* values) override {
    ++store_->sends;
    std::copy_n(values, kMirrored, store_->values.begin());
  }

 private:
  MirrorStore* const store_;
};

class FakeAdam final : public AdamMirror {
 public:
  explicit FakeAdam(MirrorStore* store) : store_(store) {}
  uint64_t Fetch(std::span<const Moments> sets) override {
    ++store_->fetches;
    std::copy_n(store_->m.begin(), kMirrored, sets[0].m);
    std::copy_n(store_->v.begin(), kMirrored, sets[0].v);
    return store_->steps;
  }
  void Send(std::span<const Moments> sets, uint64_t steps) override {
    ++store_->sends;
    std::copy_n(sets[0].m, kMirrored, store_->m.begin());
    std::copy_n(sets[0].v, kMirrored, store_->v.begin());
    store_->steps = steps;
  }

 private:
  MirrorStore* const store_;
};

std::vector<ParameterSpec> Specs() { return {{"w", {int64_t(kMirrored)}}}; }

TensorMap Tensors(const ParameterSet& set) {
  TensorMap tensors;
  set.Export(&tensors);
  return tensors;
}

TEST(ParameterMirror, ValuesOfTheHostAreSentOnceBeforeTheirUse) {
  ParameterSet set(Specs(), ParameterSet::Use::kTraining);
  MirrorStore store;
  set.values()[1] = 5;
  set.Attach(std::make_unique<FakeParameters>(&store));
  EXPECT_EQ(store.sends, 0);
  set.UseMirror(/*changes=*/false);
  set.UseMirror(/*changes=*/false);
  EXPECT_EQ(store.sends, 1);
  EXPECT_THAT(store.values, ElementsAre(0, 5, 0));
  const ParameterSet& reader = set;
  EXPECT_EQ(reader.values()[1], 5);
  EXPECT_EQ(store.fetches, 0) << "nothing has changed there";
}

TEST(ParameterMirror, ValuesThatAnEngineHasChangedAreFetchedOnce) {
  ParameterSet set(Specs(), ParameterSet::Use::kTraining);
  MirrorStore store;
  set.Attach(std::make_unique<FakeParameters>(&store));
  set.UseMirror(/*changes=*/true);
  store.values = {1, 2, 3};
  const TensorMap tensors = Tensors(set);
  EXPECT_EQ(Tensors(set).at("w").data, tensors.at("w").data);
  EXPECT_EQ(store.fetches, 1);
  EXPECT_EQ(reinterpret_cast<const float*>(tensors.at("w").data.data())[2], 3);
  // A change of the host begins with the newer values.
  set.UseMirror(/*changes=*/true);
  store.values = {4, 5, 6};
  set.values()[0] = 9;
  set.UseMirror(/*changes=*/false);
  EXPECT_THAT(store.values, ElementsAre(9, 5, 6));
}

TEST(ParameterMirror, AnExportThatDoesNotWaitHasTheValuesOfItsBeginning) {
  ParameterSet set(Specs(), ParameterSet::Use::kTraining);
  MirrorStore store;
  set.values()[2] = 7;
  set.Attach(std::make_unique<FakeParameters>(&store));
  const auto last = [](PendingTensors* tensors) {
    return reinterpret_cast<const float*>(tensors->Take().at("w").data.data())[2];
  };
  PendingTensors of_host;
  set.Export(&of_host);
  EXPECT_EQ(store.fetches, 0) << "the host's values are the newest ones";
  set.UseMirror(/*changes=*/true);
  store.values = {1, 2, 3};
  PendingTensors of_mirror;
  set.Export(&of_mirror);
  EXPECT_TRUE(of_mirror.arrived()->empty());
  store.values = {4, 5, 6};
  EXPECT_EQ(last(&of_mirror), 3);
  EXPECT_EQ(last(&of_host), 7);
  EXPECT_EQ(reinterpret_cast<const float*>(Tensors(set).at("w").data.data())[2], 6)
      << "the mirror still has newer values than the host";
}

TEST(ParameterMirror, MomentsAndStepsAreThoseOfTheNewerCopy) {
  ParameterSet set(Specs(), ParameterSet::Use::kTraining);
  Adam adam({&set}, {.rate = 0.1});
  adam.Step();
  MirrorStore store;
  adam.Attach(std::make_unique<FakeAdam>(&store));
  adam.UseMirror();
  EXPECT_EQ(store.steps, 1u);
  store = {.m = {1, 2, 3}, .v = {4, 5, 6}, .steps = 8, .sends = store.sends};
  EXPECT_EQ(adam.steps(), 8u);
  TensorMap tensors;
  adam.Export("group", &tensors);
  EXPECT_EQ(store.fetches, 1);
  EXPECT_EQ(reinterpret_cast<const float*>(tensors.at("adam.v.w").data.data())[1], 5);
  adam.UseMirror();
  EXPECT_EQ(store.sends, 1) << "the mirror has the newer moments";
  store.m = {0, 0, 0};
  adam.Import(tensors, "group", "test");
  EXPECT_EQ(adam.steps(), 8u);
  adam.UseMirror();
  EXPECT_EQ(store.sends, 2);
  EXPECT_THAT(store.m, ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace shoal::nn
