// SPDX-License-Identifier: Apache-2.0
// Sums over the rows of a matrix, for each column: gradients of biases and of norms.
#pragma once

#include "learner/device/kernels/frame.h"
#include "learner/device/kernels/numbers.h"
#include "learner/device/kernels/reduce.h"

namespace shoal::learner::kernels {

// Sums over rows for each column, in two steps: parts of kRowsOfPart or more rows, then the parts.
// The block that finishes last in its group of columns adds the parts.
struct ColumnSums {
  static constexpr int kColumns = 32, kLanes = 32;  // of a block
  static constexpr int kThreads = kColumns * kLanes;
  static constexpr int kRowsOfPart = 128, kMostParts = 128;

  int functions = 1;
  int64_t rows = 0;  // of one function
  int columns = 0;
  float* partials = nullptr;    // (PartialsSize) for each sum; not needed if there is one part
  int32_t* finished = nullptr;  // (groups) counters, 0; not needed if there is one part

  bool operator==(const ColumnSums&) const = default;
  // Groups of columns of all functions.
  SHOAL_EVERYWHERE int groups_of_function() const { return int(CeilDivide(columns, kColumns)); }
  SHOAL_EVERYWHERE int groups() const { return functions * groups_of_function(); }
  SHOAL_EVERYWHERE int64_t rows_of_part() const {
    return Most(int64_t(kRowsOfPart), CeilDivide(rows, kMostParts));
  }
  SHOAL_EVERYWHERE int parts() const { return int(CeilDivide(rows, rows_of_part())); }
  SHOAL_EVERYWHERE int64_t PartialsSize() const {
    return parts() > 1 ? int64_t(functions) * parts() * columns : 0;
  }
  SHOAL_EVERYWHERE int blocks() const { return groups() * parts(); }

  template <int kSums>
  struct Shared {
    Sums<kSums, float> sums[kLanes][kColumns];
  };

  // Adds row(r, column) over all rows r of each function, where r counts the rows of all functions,
  // and calls result(function, column, sums) once. Every row of a column is visited exactly once,
  // so `row` may write arrays.
  template <int kSums, class Block, class Row, class Result>
  SHOAL_KERNEL void Run(Block& block, Shared<kSums>& shared, const Row& row,
                        const Result& result) const {
    const int group = block.index() % groups(), part = block.index() / groups();
    const int64_t begin = part * rows_of_part(), end = Least(rows, begin + rows_of_part());
    const int64_t first = function(group) * rows;
    AddLanes<kSums>(
        block, shared, group, begin, end,
        [&](int64_t r, int column) { return row(first + r, column); },
        [&](int of, int column, const auto& sums) {
          if (parts() == 1) return result(of, column, sums);
          for (int i = 0; i < kSums; ++i) Partial(i, of, part, column) = sums[i];
        });
    if (parts() == 1 || !block.FinishesLast(finished + group, parts())) return;
    const auto partial = [&](int64_t from, int column) {
      Sums<kSums, float> sums;
      for (int i = 0; i < kSums; ++i) sums[i] = Partial(i, function(group), int(from), column);
      return sums;
    };
    AddLanes<kSums>(block, shared, group, 0, parts(), partial, result);
  }

 private:
  SHOAL_EVERYWHERE int function(int group) const { return group / groups_of_function(); }
  SHOAL_KERNEL float& Partial(int sum, int of, int part, int column) const {
    return partials[((int64_t(sum) * functions + of) * parts() + part) * columns + column];
  }

  template <int kSums, class Block, class Row, class Result>
  SHOAL_KERNEL void AddLanes(Block& block, Shared<kSums>& shared, int group, int64_t begin,
                             int64_t end, const Row& row, const Result& result) const {
    block.Threads([&](int thread) {
      const int lane = thread / kColumns;
      const int column = group % groups_of_function() * kColumns + thread % kColumns;
      auto sums = Sums<kSums, float>::Zero();
      if (column < columns) {
        for (int64_t r = begin + lane; r < end; r += kLanes) sums.Add(row(r, column));
      }
      shared.sums[lane][thread % kColumns] = sums;
    });
    block.Threads([&](int thread) {
      const int column = group % groups_of_function() * kColumns + thread;
      if (thread >= kColumns || column >= columns) return;
      auto sums = shared.sums[0][thread];
      for (int lane = 1; lane < kLanes; ++lane) sums.Add(shared.sums[lane][thread]);
      result(function(group), column, sums);
    });
  }
};

}  // namespace shoal::learner::kernels
