// SPDX-License-Identifier: Apache-2.0
// An environment that is not one of Shoal's worlds, as data: its observation, its action and how
// its episodes end. The process that runs the environment writes it (shoal-environment-1). It
// travels as text in ObservationSpec::environment, so the specification's hash covers it, and every
// process of a run derives the goal half of the task from it. No process but the actors runs code
// of the environment.
//
//   {"schema": "shoal-environment-1", "id": "Pendulum-v1", "task": "Pendulum-v1",
//    "episode_steps": 200,                                 0 = no time limit
//    "action": {"shape": [1], "dtype": "float32", "low": [-2.0], "high": [2.0]},
//    "observation": [{"name": "observation", "shape": [3], "dtype": "float32", "low": [...], ...}],
//    "success": false,                                     steps report is_success
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

// NumPy's name of the type, "float32", and its size.
const char* NameOf(ElementType type);
size_t BytesOf(ElementType type);

// How an image is laid out in an array of uint8.
struct ImageLayout {
  int height = 0, width = 0, channels = 0;
  bool channels_first = false;  // C x H x W; else H x W x C, or H x W with one channel

  bool operator==(const ImageLayout&) const = default;
};

// Empty if the array is no image: images are uint8 with two or three dimensions, 1 or 3 channels
// and at least 8 pixels a side. Throws Error (kUsage) for a uint8 array of three dimensions that is
// nearly one, such as a stack of frames.
std::optional<ImageLayout> ImageLayoutOf(const ArraySpace& space);

// The name within Shoal of the environment that env.id names: "Pendulum-v1", "ALE-Pong-v5",
// "catch_light.CatchLight" of "./catch_light.py:CatchLight". A name that one of Shoal's tasks has
// gets a prefix.
std::string TaskNameOf(const std::string& id);

// The library of an environment in C++: "/home/me/catch_light.so" of
// "/home/me/catch_light.so:CatchLight"; empty for an environment of Python.
std::string LibraryOf(const std::string& id);

// Throws Error (kUsage) naming what is missing, ill-typed or cannot be trained on: an action
// without finite bounds, two blocks of one name.
EnvironmentDescription EnvironmentFromJson(const nlohmann::json& object);
nlohmann::json ToJson(const EnvironmentDescription& environment);

// The goal half of its task. Images are no part of it. Throws Error (kUsage): task_check.h.
Task TaskOf(const EnvironmentDescription& environment);

// Adds the task of a specification's `environment` text to the registry (task_registry.h), once;
// an empty text has none. At the start of a program, before threads. Throws Error.
void AddEnvironmentTask(const std::string& environment);

}  // namespace shoal::tasks
