// SPDX-License-Identifier: Apache-2.0
// Naive layers in double, for comparison with the fast layers. Simple loops implement the formulas
// of the fast layers' headers. Arrays are row-major.
#pragma once

#include <vector>

namespace shoal::nn::reference {

using Values = std::vector<double>;

// Dimensions of a k x k convolution: B batch, C channels, (H, W) input, N filters, (h, w) output.
struct ConvShape {
  int batch, channels, height, width, filters, stride;
  int kernel = 3, padding = 0;
  bool relu = true;
  int out_height() const { return (height + 2 * padding - kernel) / stride + 1; }
  int out_width() const { return (width + 2 * padding - kernel) / stride + 1; }
};

struct Gradient {
  Values source, weight, bias;
};

// x (B, C, H, W), weight (N, C, k, k), bias (N) -> (B, N, h, w). `y` of Backward is the output.
Values ConvForward(const ConvShape& shape, const Values& x, const Values& weight,
                   const Values& bias);
Gradient ConvBackward(const ConvShape& shape, const Values& x, const Values& weight,
                      const Values& y, const Values& dy);

// x (B, C, n), n: numbers in a feature map; weight, bias, mean, variance (C).
struct Moments {
  Values mean, variance;  // variance with n in the denominator
};
Moments BatchMoments(int batch, const Values& x, int channels);
Values BatchNormForward(int batch, const Values& x, const Moments& moments, const Values& weight,
                        const Values& bias);
// Gradient of BatchNormForward with BatchMoments(x).
Gradient BatchNormBackward(int batch, const Values& x, const Values& weight, const Values& dy);

// Pooling of P planes (H, W) to P planes (h, w) with a k x k window.
struct PoolShape {
  int planes, height, width, kernel, stride, padding;
  int out_height() const { return (height + 2 * padding - kernel) / stride + 1; }
  int out_width() const { return (width + 2 * padding - kernel) / stride + 1; }
};
Values MaxPoolForward(const PoolShape& shape, const Values& x);
// Returns dx.
Values MaxPoolBackward(const PoolShape& shape, const Values& x, const Values& dy);

// Pooling of P planes (height, width) to P planes (out_height, out_width).
struct AveragePoolShape {
  int planes, height, width, out_height, out_width;
};
Values AveragePoolForward(const AveragePoolShape& shape, const Values& x);
Values AveragePoolBackward(const AveragePoolShape& shape, const Values& dy);

// P planes (height, width) to (P, 2): mean column and mean row, each in [-1, 1], of a softmax over
// the plane.
struct PointsShape {
  int planes, height, width;
  double sharpness;
};
Values Points(const PointsShape& shape, const Values& x);

// I inputs, O outputs: x (B, I), weight (O, I), bias (O) -> (B, O).
Values LinearForward(int batch, const Values& x, const Values& weight, const Values& bias);
Gradient LinearBackward(int batch, const Values& x, const Values& weight, const Values& dy);

// x (B, N), weight, bias (N).
Values LayerNormForward(int batch, const Values& x, const Values& weight, const Values& bias);
Gradient LayerNormBackward(int batch, const Values& x, const Values& weight, const Values& dy);

Values Plus(Values x, const Values& y);
Values Relu(Values x);
Values Tanh(Values x);

// Columns of `left` (B, n) and `right` (B, m) side by side.
Values Beside(int batch, const Values& left, const Values& right);

}  // namespace shoal::nn::reference
