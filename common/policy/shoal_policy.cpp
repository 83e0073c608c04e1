// SPDX-License-Identifier: Apache-2.0
#include "common/policy/shoal_policy.h"

#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "common/policy/trained_policy.h"

struct shoal_policy {
  explicit shoal_policy(const char* checkpoint) : trained(checkpoint) {
    for (const shoal::BlockSpec& block : trained.spec().blocks) {
      if (block.observed) blocks.push_back(block);
    }
  }

  shoal::policy::TrainedPolicy trained;
  std::vector<shoal::BlockSpec> blocks;                // the observed ones
  std::vector<shoal::policy::ObservedBlock> observed;  // of the latest call; memory is reused
};

namespace shoal::policy {
namespace {

std::string& LatestError() {
  thread_local std::string error;
  return error;
}

// Drops the message if there is no memory for it.
shoal_policy_status Fail(shoal_policy_status status, const char* message) noexcept {
  try {
    LatestError() = OneLine(message);
  } catch (...) {
    LatestError().clear();
  }
  return status;
}

// Calls `act` and turns every exception into a status; `refused` is the status of an Error.
template <class Act>
shoal_policy_status Guard(shoal_policy_status refused, Act act) noexcept {
  try {
    act();
    return SHOAL_POLICY_OK;
  } catch (const Error& e) {
    const bool non_finite = e.exit_code() == int(ErrorKind::kNonFinite);
    return Fail(non_finite ? SHOAL_POLICY_NOT_FINITE : refused, e.what());
  } catch (const std::exception& e) {
    return Fail(SHOAL_POLICY_FAILED, e.what());
  } catch (...) {
    return Fail(SHOAL_POLICY_FAILED, "unknown failure");
  }
}

void CheckPointer(const void* pointer, const char* name) {
  if (pointer == nullptr) throw UsageError("{} is NULL", name);
}

void TakeBlocks(const shoal_policy_observations& observations, std::vector<ObservedBlock>* blocks) {
  blocks->clear();
  if (observations.block_count > 0) CheckPointer(observations.blocks, "observations->blocks");
  for (size_t i = 0; i < observations.block_count; ++i) {
    const auto& [name, values, count] = observations.blocks[i];
    if (name == nullptr) throw UsageError("the name of block {} is NULL", i);
    if (values == nullptr) throw UsageError("block '{}': its values are NULL", name);
    blocks->push_back({name, {values, count}});
  }
}

void Act(shoal_policy* policy, const shoal_policy_observations* observations, float* actions,
         size_t action_count) {
  CheckPointer(policy, "policy");
  CheckPointer(observations, "observations");
  CheckPointer(actions, "actions");
  const auto& [count, pixels, pixel_count, blocks, block_count] = *observations;
  if (count > size_t(std::numeric_limits<int>::max())) {
    throw UsageError("{} observations, expected at most {}", count,
                     std::numeric_limits<int>::max());
  }
  if (pixel_count > 0) CheckPointer(pixels, "observations->pixels");
  TakeBlocks(*observations, &policy->observed);
  policy->trained.Act(
      {.count = int(count), .pixels = {pixels, pixel_count}, .blocks = policy->observed},
      {actions, action_count});
}

}  // namespace
}  // namespace shoal::policy

using shoal::policy::CheckPointer;
using shoal::policy::Guard;

const char* shoal_policy_error(void) { return shoal::policy::LatestError().c_str(); }

const char* shoal_policy_version(void) { return shoal::BuildVersion(); }

shoal_policy_status shoal_policy_load(const char* checkpoint, shoal_policy** policy) {
  if (policy != nullptr) *policy = nullptr;
  const bool given = checkpoint != nullptr && policy != nullptr;
  return Guard(given ? SHOAL_POLICY_BAD_CHECKPOINT : SHOAL_POLICY_BAD_ARGUMENT, [&] {
    CheckPointer(checkpoint, "checkpoint");
    CheckPointer(policy, "policy");
    *policy = std::make_unique<shoal_policy>(checkpoint).release();
  });
}

void shoal_policy_free(shoal_policy* policy) { delete policy; }

const char* shoal_policy_task(const shoal_policy* policy) {
  return policy->trained.spec().task.c_str();
}

const char* shoal_policy_algorithm(const shoal_policy* policy) {
  return policy->trained.description().algorithm.c_str();
}

size_t shoal_policy_action_size(const shoal_policy* policy) {
  return size_t(policy->trained.spec().action_size);
}

shoal_policy_shape shoal_policy_pixels(const shoal_policy* policy) {
  const shoal::ObservationSpec& spec = policy->trained.spec();
  if (!spec.HasPixels()) return {};
  return {size_t(spec.stack), size_t(spec.channels), size_t(spec.height), size_t(spec.width)};
}

size_t shoal_policy_goal_pictures(const shoal_policy* policy) {
  return policy->trained.spec().goal_picture ? 1 : 0;
}

size_t shoal_policy_camera_count(const shoal_policy* policy) {
  return policy->trained.spec().cameras.size();
}

const char* shoal_policy_camera_name(const shoal_policy* policy, size_t index) {
  const auto& cameras = policy->trained.spec().cameras;
  return index < cameras.size() ? cameras[index].c_str() : nullptr;
}

size_t shoal_policy_block_count(const shoal_policy* policy) { return policy->blocks.size(); }

const char* shoal_policy_block_name(const shoal_policy* policy, size_t index) {
  return index < policy->blocks.size() ? policy->blocks[index].name.c_str() : nullptr;
}

size_t shoal_policy_block_size(const shoal_policy* policy, size_t index) {
  return index < policy->blocks.size() ? size_t(policy->blocks[index].size) : 0;
}

shoal_policy_status shoal_policy_act(shoal_policy* policy,
                                     const shoal_policy_observations* observations, float* actions,
                                     size_t action_count) {
  return Guard(SHOAL_POLICY_BAD_ARGUMENT,
               [&] { shoal::policy::Act(policy, observations, actions, action_count); });
}
