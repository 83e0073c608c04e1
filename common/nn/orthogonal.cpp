// SPDX-License-Identifier: Apache-2.0
#include "common/nn/orthogonal.h"

#include <Eigen/Dense>
#include <algorithm>

namespace shoal::nn {

void FillOrthogonal(int64_t rows, int64_t cols, double gain, Random* random, float* weights) {
  const int64_t tall = std::max(rows, cols), narrow = std::min(rows, cols);
  Eigen::MatrixXd gaussian(tall, narrow);
  for (int64_t j = 0; j < narrow; ++j) {
    for (int64_t i = 0; i < tall; ++i) gaussian(i, j) = random->Normal();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(gaussian);
  Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(tall, narrow);
  for (int64_t j = 0; j < narrow; ++j) {
    if (qr.matrixQR()(j, j) < 0) q.col(j) = -q.col(j);
  }
  for (int64_t i = 0; i < rows; ++i) {
    for (int64_t j = 0; j < cols; ++j) {
      weights[i * cols + j] = float(gain * (rows >= cols ? q(i, j) : q(j, i)));
    }
  }
}

}  // namespace shoal::nn
