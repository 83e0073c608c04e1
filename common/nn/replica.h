// SPDX-License-Identifier: Apache-2.0
// Learning in replicas: N threads, each of which has its own networks for a share of the batch. The
// values of the parameters, and the layouts of the weights that the primitives read, exist once for
// all replicas (parameter_set.h, laid_out_weight.h); gradients and activations belong to a replica.
// Work over parameters (optimiser steps, moving averages, layouts) is divided among the replicas.
//
// The code of a replica is written as if there were one replica: losses and their gradients are
// means over the replica's own rows. Values of the whole batch (statistics, or whether all numbers
// are finite) are computed by the functions below. All replicas call the same functions in the same
// order. Sums are computed in the order of ranks, so results depend on N, not on timing.
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

// Barrier, exchange buffers and shared objects of N replicas. The replicas borrow the exchange.
class Exchange {
 public:
  // Divides a batch of `rows` rows into N shares that differ by at most `copies` rows. The rows
  // come in groups of `copies`, which stay together. CHECKs that there is a group for each replica.
  Exchange(int replicas, int rows, int copies = 1);

  int replicas() const { return int(first_rows_.size()) - 1; }
  // Sets whether waiting replicas may assume free cores (team.h). Call it while no replica works.
  void SetPatient(bool patient) { barrier_.SetPatient(patient); }
  // If false, replicas do not wait for each other, and each replica reads its own arrays and
  // numbers in place of those of the others. Use this only to measure the cost of one replica by
  // itself; the results are useless. Call it while no replica works.
  void SetMeets(bool meets) { meets_ = meets; }

 private:
  friend class Replica;

  // The arrays and numbers that a replica publishes to the others.
  struct Offer {
    double number = 0;                       // argument of Sum
    std::vector<std::vector<float>> arrays;  // arguments of Post
    std::vector<double> means;
  };

  const std::vector<int> first_rows_;  // first row of each rank, then B
  Barrier barrier_;
  bool meets_ = true;
  // Offers by turn and rank. Two turns are enough: a replica may make its next offer while other
  // replicas still read its last offer, but then all replicas must pass the next barrier before it
  // can make another offer.
  std::array<std::vector<Offer>, 2> offers_;
  std::vector<std::shared_ptr<void>> shared_;  // in the order of Replica::Shared
};

// One of N replicas; only its own thread uses it. With a single replica, every function returns its
// argument bit for bit.
class Replica {
 public:
  Replica() = default;  // a single replica, without an exchange
  Replica(Exchange* exchange, int rank);

  int rank() const { return rank_; }
  int count() const { return count_; }  // N
  // Threads of its networks' passes: 1 if there are several replicas, else nn::Threads().
  int threads() const;

  // The rows [begin, begin + count) of a batch that this replica learns from. CHECKs that the batch
  // has the size that the exchange was made for.
  struct Rows {
    int begin, count;
  };
  Rows RowsOf(int batch) const;
  // b_r / B, the weight of the means of replica `rank` in the means of the batch.
  double WeightOf(int rank) const;

  // This replica's part of an array of `floats` floats, if replicas divide the work. `floats` and
  // the bounds of the part are multiples of 16. A single replica has the whole array.
  struct Share {
    int64_t begin, end;
  };
  Share ShareOf(int64_t floats) const;

  // Returns one object for all replicas: the k-th call of each replica returns the same object,
  // which the first caller makes. Replicas are built one after another.
  template <class T, class Make>
  std::shared_ptr<T> Shared(const Make& make) {
    if (exchange_ == nullptr) return make();
    if (shared_ == exchange_->shared_.size()) exchange_->shared_.push_back(make());
    return std::static_pointer_cast<T>(exchange_->shared_[shared_++]);
  }

  int objects_shared() const { return int(shared_); }  // number of calls of Shared so far

  // Barrier: waits until all replicas have called Meet. Afterwards each replica sees everything
  // that the others wrote before.
  void Meet();
  // Returns the mean of each number over the batch. `own`: means over this replica's rows.
  std::vector<double> Means(std::initializer_list<double> own);
  // Returns the sum of `own` over all replicas.
  double Sum(double own);

  // Publishes arrays of the replica's rows, and means over these rows, together with the next Sum
  // or Means, which saves one barrier. After that Sum or Means, and until the following one, Posted
  // returns the arrays and means of the whole batch.
  void Post(std::span<const std::span<const float>> arrays, std::vector<double> means);
  struct Whole {
    std::vector<std::vector<float>> arrays;  // rows of the whole batch
    std::vector<double> means;               // means over the whole batch
  };
  Whole Posted() const;

  // Draws `per_row` standard normals for each of the B rows and returns the numbers of this
  // replica's rows. Each row gets the same numbers as with one replica, and `random` ends in the
  // same state.
  std::vector<double> Normals(int batch, int per_row, Random* random) const;

 private:
  // Publishes `next_`, waits for the offers of all replicas and returns the offers by rank. The
  // offers stay valid until the second call after this one.
  std::span<const Exchange::Offer> Show();
  std::span<const Exchange::Offer> Shown() const;  // latest

  Exchange* exchange_ = nullptr;
  int rank_ = 0, count_ = 1;
  size_t turn_ = 0, shared_ = 0;
  Exchange::Offer next_;   // offer that the next Show publishes
  Exchange::Offer alone_;  // latest offer, if there is no exchange
};

}  // namespace shoal::nn
