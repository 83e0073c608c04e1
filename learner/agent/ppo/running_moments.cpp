#include "learner/agent/ppo/running_moments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::learner {
namespace {

constexpr double kEpsilon = 1e-8, kLimit = 10;

nn::NamedTensor Words(const std::vector<uint64_t>& words) {
  nn::NamedTensor tensor{.dtype = "U64", .shape = {int64_t(words.size())}, .data = {}};
  tensor.data.resize(words.size() * sizeof(uint64_t));
  if (!words.empty()) std::memcpy(tensor.data.data(), words.data(), tensor.data.size());
  return tensor;
}

// `count`: how many there must be.
std::vector<uint64_t> ReadWords(const nn::TensorMap& tensors, const std::string& name,
                                std::optional<size_t> count, const std::string& source) {
  const auto at = tensors.find(name);
  if (at == tensors.end()) throw RuntimeError("{}: no tensor '{}'", source, name);
  const nn::NamedTensor& tensor = at->second;
  if (tensor.dtype != "U64" || tensor.shape.size() != 1 ||
      (count && tensor.shape[0] != int64_t(*count))) {
    throw RuntimeError("{}: '{}' is not of the shape expected", source, name);
  }
  std::vector<uint64_t> words(size_t(tensor.shape[0]));
  if (!words.empty()) std::memcpy(words.data(), tensor.data.data(), tensor.data.size());
  return words;
}

}  // namespace

RunningMoments::RunningMoments(int size) : mean_(size_t(size)), squares_(size_t(size)) {}

void RunningMoments::Add(std::span<const float> rows) {
  const size_t width = mean_.size();
  if (width == 0) return;
  CHECK(rows.size() % width == 0) << rows.size();
  const size_t n = rows.size() / width;
  if (n == 0) return;
  const auto added = static_cast<double>(n);
  for (size_t j = 0; j < width; ++j) {
    double mean = 0, squares = 0;
    for (size_t i = 0; i < n; ++i) mean += double{rows[i * width + j]} / added;
    for (size_t i = 0; i < n; ++i) {
      const double distance = double{rows[i * width + j]} - mean;
      squares += distance * distance;
    }
    const double apart = mean - mean_[j], total = count_ + added;
    squares_[j] += squares + apart * apart * count_ * added / total;
    mean_[j] += apart * added / total;
  }
  count_ += added;
}

std::vector<float> RunningMoments::Mean() const { return {mean_.begin(), mean_.end()}; }

std::vector<float> RunningMoments::Variance() const {
  std::vector<float> variance(squares_.size(), 1.f);
  if (count_ == 0) return variance;
  std::ranges::transform(squares_, variance.begin(), [&](double s) { return float(s / count_); });
  return variance;
}

void RunningMoments::Export(const std::string& name, nn::TensorMap* tensors) const {
  std::vector<uint64_t> words{std::bit_cast<uint64_t>(count_)};
  for (const double x : mean_) words.push_back(std::bit_cast<uint64_t>(x));
  for (const double x : squares_) words.push_back(std::bit_cast<uint64_t>(x));
  (*tensors)[name] = Words(words);
}

void RunningMoments::Import(const nn::TensorMap& tensors, const std::string& name,
                            const std::string& source) {
  const std::vector<uint64_t> words = ReadWords(tensors, name, 1 + 2 * mean_.size(), source);
  count_ = std::bit_cast<double>(words[0]);
  for (size_t j = 0; j < mean_.size(); ++j) {
    mean_[j] = std::bit_cast<double>(words[1 + j]);
    squares_[j] = std::bit_cast<double>(words[1 + mean_.size() + j]);
  }
}

std::vector<float> RewardScale::Scale(std::span<const float> reward, std::span<const float> ends,
                                      std::span<const uint64_t> env) {
  std::vector<float> returns(reward.size());
  for (size_t t = 0; t < reward.size(); ++t) {
    double& running = running_[env[t]];
    running = discount_ * running + double{reward[t]};
    returns[t] = static_cast<float>(running);
    if (ends[t] != 0) running = 0;
  }
  returns_.Add(returns);
  const double factor = 1 / std::sqrt(double{returns_.Variance()[0]} + kEpsilon);
  std::ranges::transform(reward, returns.begin(), [&](float r) {
    return static_cast<float>(std::clamp(double{r} * factor, -kLimit, kLimit));
  });
  return returns;
}

void RewardScale::Export(nn::TensorMap* tensors) const {
  returns_.Export("reward.moments", tensors);
  std::vector<uint64_t> envs, running;
  for (const auto& [env, value] : running_) {
    envs.push_back(env);
    running.push_back(std::bit_cast<uint64_t>(value));
  }
  (*tensors)["reward.envs"] = Words(envs);
  (*tensors)["reward.returns"] = Words(running);
}

void RewardScale::Import(const nn::TensorMap& tensors, const std::string& source) {
  const auto envs = ReadWords(tensors, "reward.envs", std::nullopt, source);
  const auto running = ReadWords(tensors, "reward.returns", envs.size(), source);
  returns_.Import(tensors, "reward.moments", source);
  running_.clear();
  for (size_t i = 0; i < envs.size(); ++i) running_[envs[i]] = std::bit_cast<double>(running[i]);
}

}  // namespace shoal::learner
