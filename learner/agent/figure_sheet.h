// SPDX-License-Identifier: Apache-2.0
// The figures of an update while it is computed: which number of the engine each one is. They are
// read when the update has ended.
#pragma once

#include <span>
#include <vector>

#include "learner/agent/update_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// One thread.
class FigureSheet {
 public:
  // In the order in which the update reports them; each at most once in an update.
  void Set(const Figure& figure, Number number) { entries_.push_back({&figure, number}); }
  // The square root of the number: the norm of a gradient from the sum of its squares.
  void SetRoot(const Figure& figure, Number squares) {
    entries_.push_back({&figure, squares, /*root=*/true});
  }
  // A value that the host gave to the update.
  void SetValue(const Figure& figure, double value) {
    entries_.push_back({&figure, {}, false, value});
  }
  // The figures of a critic's loss: from the loss to the values of its Q functions.
  void SetCritic(const CriticNumbers& numbers, Number gradient_squares);

  // Reads what was set since the last call, after Engine::End; none of a batch that was not finite.
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

// For the loss of so many Q functions.
CriticNumbers NewCriticNumbers(int critics, Engine* engine);

}  // namespace shoal::learner
