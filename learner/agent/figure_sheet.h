// SPDX-License-Identifier: Apache-2.0
// The figures of an update until its outcome is known. The sheet maps each figure to a number of
// the engine, and then reads the numbers.
#pragma once

#include <span>
#include <vector>

#include "learner/agent/update_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// Only one thread may use an object.
class FigureSheet {
 public:
  // Sets a metric. Set metrics in the order in which the update reports them, each metric at most
  // once in an update.
  void Set(const Figure& figure, Number number) { entries_.push_back({&figure, number}); }
  // Sets a metric to the square root of a number. The norm of a gradient is the square root of the
  // sum of its squares.
  void SetRoot(const Figure& figure, Number squares) {
    entries_.push_back({&figure, squares, /*root=*/true});
  }
  // Sets a metric to a value on the host.
  void SetValue(const Figure& figure, double value) {
    entries_.push_back({&figure, {}, false, value});
  }
  // Sets all metrics of a critic: loss, targets, gradient and values of the Q functions.
  void SetCritic(const CriticNumbers& numbers, Number gradient_squares);

  // Reads the figures. `outcome`: the update's, which the engine returned last. Returns no figures
  // if the batch was not finite.
  UpdateFigures Read(const Engine& engine, const Engine::Outcome& outcome) const;

 private:
  struct Entry {
    const Figure* figure;
    Number number;  // empty: `value` is used
    bool root = false;
    double value = 0;
  };

  std::vector<Entry> entries_;
};

// Makes the numbers for the loss of `critics` Q functions.
CriticNumbers NewCriticNumbers(int critics, Engine* engine);

}  // namespace shoal::learner
