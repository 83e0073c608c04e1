// SPDX-License-Identifier: Apache-2.0
// Learning in replicas: N threads, each with networks of its own for a share of the batch. The
// values of the parameters, and the layouts of the weights that the primitives read, exist once for
// all replicas (parameter_set.h, laid_out_weight.h); gradients and activations belong to a replica.
// Work over parameters (optimiser steps, moving averages, layouts) is divided among the replicas.
//
// Code of a replica reads as if it were alone: losses and their gradients are means over its own
// rows. Values of the whole batch (figures, whether all is finite) pass through one of the
// functions below. All replicas call the same functions in the same order. Sums are made in the
// order of ranks: results depend on N, not on timing.
//
// Dimensions: B batch; b_r rows of replica r, about B/N.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/nn/team.h"

namespace shoal::nn {

// Barrier, exchange buffers and shared objects of N replicas, which borrow it.
class Exchange {
 public:
  // Divides a batch of `rows` rows into N shares that differ by at most `copies` rows. The rows
  // come in groups of `copies`, which stay together. CHECKs that there is a group for each replica.
  Exchange(int replicas, int rows, int copies = 1);

  int replicas() const { return int(first_rows_.size()) - 1; }
  // Whether replicas may assume free cores when they wait. While none of them works.
  void SetPatient(bool patient) { barrier_.SetPatient(patient); }
  // If false, replicas do not wait for each other, and each reads its own arrays and numbers in
  // place of the others'. This measures the cost of one replica by itself; its results are useless.
  // Call it while no replica works.
  void SetMeets(bool meets) { meets_ = meets; }

 private:
  friend class Replica;

  // The arrays and numbers that a replica shows to the others.
  struct Offer {
    double number = 0;                       // of Sum
    std::vector<std::vector<float>> arrays;  // of Post
    std::vector<double> means;
  };

  const std::vector<int> first_rows_;  // by rank, and B behind them
  Barrier barrier_;
  bool meets_ = true;
  // By turn and rank. Two turns are enough: a replica may make its next offer while others still
  // read the last one, but the offer after that has to pass the barrier of the next one first.
  std::array<std::vector<Offer>, 2> offers_;
  std::vector<std::shared_ptr<void>> shared_;  // in the order of Replica::Shared
};

// Used by one thread: the one that runs this replica. Alone, every function returns its argument
// bit for bit.
class Replica {
 public:
  Replica() = default;  // alone
  Replica(Exchange* exchange, int rank);

  int rank() const { return rank_; }
  int count() const { return count_; }  // N
  // Threads of its networks' passes: one if there are several replicas, else those of nn::Threads.
  int threads() const;

  // The rows [begin, begin + count) of a batch that this replica learns from. CHECKs that the batch
  // has the size that the exchange was made for.
  struct Rows {
    int begin, count;
  };
  Rows RowsOf(int batch) const;
  // b_r / B: the weight of the replica's means in those of the batch.
  double WeightOf(int rank) const;

  // The part of an array of so many floats, a multiple of 16, that this replica works on if all
  // divide the work: a multiple of 16, too. Alone: all.
  struct Share {
    int64_t begin, end;
  };
  Share ShareOf(int64_t floats) const;

  // One object for all replicas: the k-th call of each returns the same one. The first caller makes
  // it; replicas are built one after another.
  template <class T, class Make>
  std::shared_ptr<T> Shared(const Make& make) {
    if (exchange_ == nullptr) return make();
    if (shared_ == exchange_->shared_.size()) exchange_->shared_.push_back(make());
    return std::static_pointer_cast<T>(exchange_->shared_[shared_++]);
  }

  int objects_shared() const { return int(shared_); }  // so far

  // Waits until all replicas have called it. Afterwards each reads what the others wrote before.
  void Meet();
  // The mean over the batch of each number, from means over the replicas' rows.
  std::vector<double> Means(std::initializer_list<double> own);
  // The sum over replicas.
  double Sum(double own);

  // Shows arrays of the replica's rows, and means over them, along with the next Sum or Means, so
  // that they need no meeting of their own. Read them by Posted after it and before the one after.
  void Post(std::span<const std::span<const float>> arrays, std::vector<double> means);
  struct Whole {
    std::vector<std::vector<float>> arrays;  // of the whole batch
    std::vector<double> means;               // over it
  };
  Whole Posted() const;

  // Standard normals for the rows of this replica, `per_row` each, of those drawn for all B: each
  // row has the numbers that it would have with one replica, and the stream ends where it would.
  std::vector<double> Normals(int batch, int per_row, Random* random) const;

 private:
  // Shows `next_` and waits until all have shown theirs, which are returned by rank and stay until
  // the next call but one.
  std::span<const Exchange::Offer> Show();
  std::span<const Exchange::Offer> Shown() const;  // latest

  Exchange* exchange_ = nullptr;
  int rank_ = 0, count_ = 1;
  size_t turn_ = 0, shared_ = 0;
  Exchange::Offer next_;   // to be shown
  Exchange::Offer alone_;  // shown last, without an exchange
};

}  // namespace shoal::nn
