// SPDX-License-Identifier: Apache-2.0
// The roles of a run's processes, and the planes that separate their traffic.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace shoal::link {

// kActor: a training actor. kEval: the evaluation actor. kClient: a program that watches or steers
// a run from outside.
enum class Role { kCoordinator, kLearner, kReplay, kActor, kEval, kClient };

inline constexpr Role kRoles[] = {Role::kCoordinator, Role::kLearner, Role::kReplay,
                                  Role::kActor,       Role::kEval,    Role::kClient};

// Groups of topics. A slow reader in one plane does not delay the other planes. kMain: records,
// weights, metrics and control. kBatch: requests and batches between learner and replay. kOperate:
// messages between coordinator and clients.
enum class Plane { kMain, kBatch, kOperate };

// "coordinator", "learner", "replay", "actor", "eval", "client".
constexpr const char* RoleName(Role role) {
  switch (role) {
    case Role::kCoordinator:
      return "coordinator";
    case Role::kLearner:
      return "learner";
    case Role::kReplay:
      return "replay";
    case Role::kActor:
      return "actor";
    case Role::kEval:
      return "eval";
    case Role::kClient:
      return "client";
  }
  return "?";
}

// The role with this name; empty if there is no such role.
constexpr std::optional<Role> FindRole(std::string_view name) {
  for (const Role role : kRoles) {
    if (name == RoleName(role)) return role;
  }
  return std::nullopt;
}

// Limit for the unread bytes of a writer of the role; beyond this limit a write waits (hub.h,
// "History"). Servers have few bulk writers, so their limit is large. Many actors share the buffers
// of one receiver, so the limit of an actor is small.
constexpr uint64_t UnreadBytesBound(Role role) {
  switch (role) {
    case Role::kCoordinator:
    case Role::kLearner:
    case Role::kReplay:
      return 8 << 20;
    case Role::kActor:
    case Role::kEval:
    case Role::kClient:
      break;
  }
  return 2 << 20;
}

// Whether a process of the role takes part in the plane.
constexpr bool Joins(Role role, Plane plane) {
  switch (plane) {
    case Plane::kMain:
      return role != Role::kClient;
    case Plane::kBatch:
      return role == Role::kLearner || role == Role::kReplay;
    case Plane::kOperate:
      return role == Role::kCoordinator || role == Role::kClient;
  }
  return false;
}

}  // namespace shoal::link
