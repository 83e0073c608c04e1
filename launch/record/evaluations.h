// SPDX-License-Identifier: Apache-2.0
// eval/*.json of a run: written as evaluations arrive, read back when a run goes on.
#pragma once

#include <filesystem>
#include <vector>

#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

// Reads the figures of a shoal-eval-1 object; `source` names the text. Throws Error on anything
// else, and where the figures cannot be: a success rate outside of 0..1, a return that is not
// finite, no episodes.
EvaluationPoint ParseEvaluation(const std::string& json, const std::string& source);

// The figures of a message, whose own fields must say what its JSON says. Throws Error.
EvaluationPoint ParseEvaluation(const EvalMessage& message);

// Stores the message's JSON, with `wall_seconds` added, as eval/STEPS_UPDATES.json and returns its
// figures. Throws Error when it is not an evaluation or cannot be written.
EvaluationPoint StoreEvaluation(const std::filesystem::path& run, const EvalMessage& message,
                                double wall_seconds);

// What StoreEvaluation wrote, by env steps. Throws Error naming a broken file.
std::vector<EvaluationPoint> ReadEvaluations(const std::filesystem::path& run);

}  // namespace shoal::launch
