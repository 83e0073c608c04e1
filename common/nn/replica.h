// SPDX-License-Identifier: Apache-2.0
// Learning in replicas: N copies of the same networks, each on a thread of its own with 1/N of the
// batch, which stay equal bit for bit because all take the same steps: each rank's optimiser
// (adam.h) steps a share of the parameters, for all of them.
//
// Nothing else is shared but the policy's average (learner/agent/policy_average.h) and what is
// exchanged here, so code of a replica reads as if it were alone: losses and their gradients are
// means over its own rows; what has to be of the whole batch (figures, whether all is finite)
// passes through one of the functions below. All replicas call the same ones in the same order.
// Sums are made in the order of ranks: results depend on N, not on timing.
//
// Dimensions: B batch, b = B/N rows of a replica.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/nn/team.h"

namespace shoal::nn {

// Where N replicas exchange. They borrow it.
class Exchange {
 public:
  explicit Exchange(int replicas) : barrier_(replicas) {
    for (std::vector<Offer>& turn : offers_) turn.resize(size_t(replicas));
  }

 private:
  friend class Replica;

  // What a replica shows to the others.
  struct Offer {
    void* object = nullptr;
    std::vector<std::vector<float>> arrays;
    std::vector<double> numbers;
  };

  Barrier barrier_;
  // By turn and rank. Two turns: a replica may make its next offer while others still read the
  // last, but not the one after that, for which it would have to pass the next one's barrier.
  std::array<std::vector<Offer>, 2> offers_;
};

// One thread: the one that runs this replica. Alone every function gives back what it was given,
// bit for bit.
class Replica {
 public:
  Replica() = default;  // alone
  Replica(Exchange* exchange, int rank);

  int rank() const { return rank_; }
  int count() const { return count_; }  // N
  // Threads of its networks' passes: one of several replicas has its own thread alone, a single one
  // those of nn::Threads.
  int threads() const;
  // Its rows of a batch of so many. CHECKs that N divides it.
  int Rows(int batch) const;

  // The part of an array of so many floats, a multiple of 16, that this one works on where all
  // divide the work: a multiple of 16, too. Alone: all.
  struct Share {
    int64_t begin, end;
  };
  Share ShareOf(int64_t floats) const;
  // The same object of every replica, by rank.
  template <class T>
  std::vector<T*> Peers(T* own) {
    std::vector<T*> peers;
    for (void* object : Objects(own)) peers.push_back(static_cast<T*>(object));
    return peers;
  }
  // Waits until all are here: what each wrote before, all read after.
  void Meet();
  // Arrays of each replica's rows to those of the whole batch, rank after rank.
  std::vector<std::vector<float>> Whole(std::span<const std::span<const float>> own);
  // The mean over replicas of each number.
  std::vector<double> Means(std::initializer_list<double> own);

  // Standard normals for the b rows of this replica, `per_row` each, of those drawn for all B:
  // the stream ends where it would for one replica, and each row has the numbers that it would
  // have.
  std::vector<double> Normals(int rows, int per_row, Random* random) const;

 private:
  std::vector<void*> Objects(void* own);
  // Shows an offer and waits until all have shown theirs, which come back by rank and stay until
  // the next but one.
  std::span<const Exchange::Offer> Show(Exchange::Offer offer);

  Exchange* exchange_ = nullptr;
  int rank_ = 0, count_ = 1;
  size_t turn_ = 0;
};

}  // namespace shoal::nn
