// SPDX-License-Identifier: Apache-2.0
// JSON description (shoal-environment-1) of an environment that is not one of Shoal's worlds: its
// observation, its action and how its episodes end. The process that runs the environment writes
// the description. ObservationSpec::environment contains the description as text, so the spec's
// hash includes it. Every process of a run derives the goal half of the task from this text. Only
// the actors run code of the environment.
//
//   {"schema": "shoal-environment-1", "id": "Pendulum-v1", "task": "Pendulum-v1",
//    "episode_steps": 200,                                 0 = no time limit
//    "action": {"shape": [1], "dtype": "float32", "low": [-2.0], "high": [2.0]},
//    "observation": [{"name": "observation", "shape": [3], "dtype": "float32", "low": [...], ...}],
//    "success": false,                                     whether steps report is_success
//    "goal": {"reward": "sparse", "threshold": 0.05}}      only if verified (shoal env check)
//
// A bound is a list with one number for each element, or a single number for all of them; null is
// an infinite bound.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/tasks/environment_spaces.h"
#include "common/tasks/task.h"

namespace shoal::tasks {

inline constexpr char kEnvironmentSchema[] = "shoal-environment-1";

// NumPy's name of an element type, such as "float32", and the size of an element in bytes.
const char* NameOf(ElementType type);
size_t BytesOf(ElementType type);

// Layout of an image in an array of uint8.
struct ImageLayout {
  int height = 0, width = 0, channels = 0;
  // True: channels x height x width. False: height x width x channels, or height x width if there
  // is one channel.
  bool channels_first = false;

  bool operator==(const ImageLayout&) const = default;
};

// Returns the layout of an image, or empty if the array is not an image. An image is an array of
// uint8 with two or three dimensions, 1 or 3 channels and at least 8 pixels on each side. Throws
// Error (kUsage) for a uint8 array of three dimensions that resembles an image, such as a stack of
// frames.
std::optional<ImageLayout> ImageLayoutOf(const ArraySpace& space);

// The task name in Shoal for an environment. `id`: value of the key env.id. Examples:
// "Pendulum-v1", "ALE-Pong-v5", "catch_light.CatchLight" for "./catch_light.py:CatchLight". If one
// of Shoal's tasks already has this name, a prefix is added.
std::string TaskNameOf(const std::string& id);

// The library of a C++ environment: "/home/me/catch_light.so" for
// "/home/me/catch_light.so:CatchLight". Empty for a Python environment.
std::string LibraryOf(const std::string& id);

// Throws Error (kUsage) that names a member that is missing or ill-typed, or the reason why the
// environment is not trainable: for example, an action without finite bounds, or two blocks with
// the same name.
EnvironmentDescription EnvironmentFromJson(const nlohmann::json& object);
nlohmann::json ToJson(const EnvironmentDescription& environment);

// The goal half of the environment's task. It does not include images. Throws the errors of
// task_check.h.
Task TaskOf(const EnvironmentDescription& environment);

// Adds the task of an environment to the registry (task_registry.h), unless the task was added
// before. `environment`: text of ObservationSpec::environment; nothing is added if it is empty.
// Call this function at the start of a program, before other threads exist. Throws Error.
void AddEnvironmentTask(const std::string& environment);

}  // namespace shoal::tasks
