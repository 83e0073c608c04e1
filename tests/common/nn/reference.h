// Naive layers in double, for comparison with the fast ones. Written from the formulas in the
// layers' headers, loop by loop; speed is no concern. Arrays are row-major.
#pragma once

#include <vector>

namespace shoal::nn::reference {

using Values = std::vector<double>;

// Dimensions: B batch, C channels, (H, W) in, N filters, (h, w) out of a 3x3 convolution without
// padding.
struct ConvShape {
  int batch, channels, height, width, filters, stride;
  int out_height() const { return (height - 3) / stride + 1; }
  int out_width() const { return (width - 3) / stride + 1; }
};

struct Gradient {
  Values source, weight, bias;
};

// With ReLU. x (B, C, H, W), weight (N, C, 3, 3), bias (N) -> (B, N, h, w).
Values ConvForward(const ConvShape& shape, const Values& x, const Values& weight,
                   const Values& bias);
Gradient ConvBackward(const ConvShape& shape, const Values& x, const Values& weight,
                      const Values& y, const Values& dy);

// x (B, I), weight (O, I), bias (O) -> (B, O).
Values LinearForward(int batch, const Values& x, const Values& weight, const Values& bias);
Gradient LinearBackward(int batch, const Values& x, const Values& weight, const Values& dy);

// x (B, N), weight, bias (N).
Values LayerNormForward(int batch, const Values& x, const Values& weight, const Values& bias);
Gradient LayerNormBackward(int batch, const Values& x, const Values& weight, const Values& dy);

Values Relu(Values x);
Values Tanh(Values x);

// Columns of `left` (B, n) and `right` (B, m) side by side.
Values Beside(int batch, const Values& left, const Values& right);

}  // namespace shoal::nn::reference
