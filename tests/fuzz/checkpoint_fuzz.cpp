// SPDX-License-Identifier: Apache-2.0
// Checkpoints: any bytes are refused with Error or are whole. First byte:
//   0  the rest is state.json; two other files are those of a real checkpoint
//   1  the rest is learner.safetensors; state.json gets matching checksums, so that the input is
//      read
//   2  the rest is a policy as sent to an actor
//   3  the rest is policy.json
#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/check.h"
#include "common/base/crc32.h"
#include "common/base/files.h"
#include "common/nn/policy.h"
#include "common/policy/policy_description.h"
#include "learner/checkpoint.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

constexpr uint64_t kSpec = 0xfeedfacecafebeef;

std::filesystem::path RealCheckpoint() {
  const nn::NamedTensor tensor{"F32", {2, 3}, std::vector<uint8_t>(24, 1)};
  WriteCheckpoint(fuzz::Scratch(), {.updates = 3, .spec_hash = kSpec, .precision = "f32"},
                  {{"a", tensor}}, {{"b", tensor}}, {SmallConfig(), SmallSpec()},
                  {{"schema", "x"}});
  return fuzz::Scratch() / CheckpointName(3);
}

uint32_t Crc(std::string_view bytes) {
  return Crc32({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

void ReadWithState(const std::filesystem::path& folder, const std::string& state) {
  static const std::string learner = ReadFile(folder / "learner.safetensors");
  fuzz::WriteScratch(folder / "learner.safetensors", learner);
  fuzz::WriteScratch(folder / "state.json", state);
  ReadCheckpoint(folder, kSpec);
}

void ReadWithLearner(const std::filesystem::path& folder, const std::string& learner) {
  static const std::string state = ReadFile(folder / "state.json");
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(state);
  json.erase("crc32");
  json["files"]["learner.safetensors"] = {{"bytes", learner.size()}, {"crc32", Crc(learner)}};
  json["crc32"] = Crc(json.dump());
  fuzz::WriteScratch(folder / "learner.safetensors", learner);
  fuzz::WriteScratch(folder / "state.json", json.dump(2) + "\n");
  const Checkpoint checkpoint = ReadCheckpoint(folder, kSpec);
  // Accepted input is unchanged after writing and reading.
  const std::string written = nn::WriteSafetensors(checkpoint.tensors, {});
  const nn::TensorMap again = nn::ReadSafetensors(written, "again");
  CHECK(again.size() == checkpoint.tensors.size());
  for (const auto& [name, tensor] : again) CHECK(tensor.data == checkpoint.tensors.at(name).data);
}

// Views are what copies are, within the bytes; layers that were built read them.
void LoadPolicy(const std::string& bytes) {
  const nn::TensorViews views = nn::ReadSafetensorsViews(bytes, "weights");
  const nn::TensorMap copies = nn::ReadSafetensors(bytes, "weights");
  CHECK(views.all().size() == copies.size());
  for (const auto& [name, view] : views.all())
    CHECK(std::ranges::equal(view.data, copies.at(name).data));
  static nn::Policy policy(SmallConfig().network, SmallSpec(), nn::Precision::kF32, 1);
  static const std::vector<uint8_t> frames(size_t(SmallSpec().InputBytes()));
  static const std::vector<float> vector(size_t(SmallSpec().VectorSize()));
  policy.Load(SharedBytes(bytes), "weights");
  policy.Forward(1, frames.data(), vector.data());
}

void Read(uint8_t mode, const std::string& bytes) {
  static const std::filesystem::path folder = RealCheckpoint();
  if (mode == 0) return ReadWithState(folder, bytes);
  if (mode == 1) return ReadWithLearner(folder, bytes);
  if (mode == 2) return LoadPolicy(bytes);
  // Accepted input is unchanged after writing and reading.
  const std::string written = policy::WriteDescription(policy::ReadDescription(bytes, "described"));
  CHECK(policy::WriteDescription(policy::ReadDescription(written, "again")) == written);
}

}  // namespace
}  // namespace shoal::learner

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return shoal::fuzz::Try(data, size, shoal::learner::Read);
}
