// SPDX-License-Identifier: Apache-2.0
// The figures of an update while it is computed. The sheet maps each figure to a number of the
// engine, and reads the numbers when the update has ended.
#pragma once

#include <span>
#include <vector>

#include "learner/agent/update_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// One thread.
class FigureSheet {
 public:
  // Sets a figure. Call it in the order in which the update reports its figures, and at most once
  // per figure and update.
  void Set(const Figure& figure, Number number) { entries_.push_back({&figure, number}); }
  // Sets a figure to the square root of a number: the norm of a gradient from the sum of its
  // squares.
  void SetRoot(const Figure& figure, Number squares) {
    entries_.push_back({&figure, squares, /*root=*/true});
  }
  // Sets a figure to a value of the host.
  void SetValue(const Figure& figure, double value) {
    entries_.push_back({&figure, {}, false, value});
  }
  // Sets the figures of a critic's loss, from the loss to the values of its Q functions.
  void SetCritic(const CriticNumbers& numbers, Number gradient_squares);

  // Reads the figures that were set since the last call. Call it after Engine::End. Returns no
  // figures if the batch was not finite.
  UpdateFigures Take(const Engine& engine, const Engine::Outcome& outcome);

 private:
  struct Entry {
    const Figure* figure;
    Number number;  // none: `value`
    bool root = false;
    double value = 0;
  };

  std::vector<Entry> entries_;
};

// Makes the numbers for the loss of `critics` Q functions.
CriticNumbers NewCriticNumbers(int critics, Engine* engine);

}  // namespace shoal::learner
