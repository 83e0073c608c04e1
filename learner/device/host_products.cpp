// SPDX-License-Identifier: Apache-2.0
#include "learner/device/host_products.h"

#include <algorithm>
#include <vector>

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

using Floats = std::vector<float>;

float ReadNumber(Type type, const void* values, int64_t at) {
  return type == Type::kF32 ? static_cast<const float*>(values)[at]
                            : kernels::FromBf16(static_cast<const uint16_t*>(values)[at]);
}

void WriteNumber(Type type, float value, int64_t at, void* values) {
  if (type == Type::kF32) {
    static_cast<float*>(values)[at] = value;
  } else {
    static_cast<uint16_t*>(values)[at] = kernels::ToBf16(value);
  }
}

Floats ReadNumbers(Type type, const void* values, int64_t first, int64_t count) {
  Floats numbers(static_cast<size_t>(count));
  for (int64_t i = 0; i < count; ++i) {
    numbers[static_cast<size_t>(i)] = ReadNumber(type, values, first + i);
  }
  return numbers;
}

// A row-major matrix in f32.
struct Matrix {
  int64_t rows, columns;
  Floats values;

  Matrix(int64_t of_rows, int64_t of_columns)
      : rows(of_rows), columns(of_columns), values(static_cast<size_t>(of_rows * of_columns)) {}
  float* row(int64_t i) { return values.data() + i * columns; }
  const float* row(int64_t i) const { return values.data() + i * columns; }
};

Matrix Transposed(const Matrix& a) {
  Matrix result(a.columns, a.rows);
  for (int64_t i = 0; i < a.rows; ++i) {
    for (int64_t j = 0; j < a.columns; ++j) result.row(j)[i] = a.row(i)[j];
  }
  return result;
}

// Without checks of each number, which would take most of the time of the address sanitizer's
// tests. AddProduct has checked the shapes.
__attribute__((no_sanitize("address", "undefined"))) void AddScaledRow(float factor,
                                                                       const float* __restrict row,
                                                                       int64_t n,
                                                                       float* __restrict sum) {
  for (int64_t i = 0; i < n; ++i) sum[i] += factor * row[i];
}

// sum += a b
void AddProduct(const Matrix& a, const Matrix& b, Matrix* sum) {
  CHECK(a.columns == b.rows && sum->rows == a.rows && sum->columns == b.columns);
  for (int64_t i = 0; i < a.rows; ++i) {
    for (int64_t k = 0; k < a.columns; ++k) {
      AddScaledRow(a.row(i)[k], b.row(k), b.columns, sum->row(i));
    }
  }
}

// op(M) of a product: (rows, columns), from `first`.
Matrix Operand(Type type, const void* values, int64_t first, int64_t stride, bool transposed,
               int64_t rows, int64_t columns) {
  Matrix operand(rows, columns);
  for (int64_t i = 0; i < rows; ++i) {
    for (int64_t j = 0; j < columns; ++j) {
      const int64_t at = transposed ? j * stride + i : i * stride + j;
      operand.row(i)[j] = ReadNumber(type, values, first + at);
    }
  }
  return operand;
}

// Adds the bias and applies the ReLU.
float Finish(float sum, const float* bias, bool relu) {
  if (bias != nullptr) sum += *bias;
  return relu && sum < 0 ? 0.f : sum;
}

int64_t PixelsOf(const ConvolutionShape& shape) {
  return int64_t{shape.output_height} * shape.output_width;
}
int64_t PatchOf(const ConvolutionShape& shape) {
  return int64_t{shape.kernel} * shape.kernel * shape.channels;
}
int64_t InputOf(const ConvolutionShape& shape) {
  return int64_t{shape.height} * shape.width * shape.channels;
}

// Calls body(patch row, first column, first number of x) for each kernel position within the map.
template <class Body>
void ForPositions(const ConvolutionShape& shape, const Body& body) {
  for (int i = 0; i < shape.output_height; ++i) {
    for (int j = 0; j < shape.output_width; ++j) {
      for (int u = 0; u < shape.kernel; ++u) {
        for (int v = 0; v < shape.kernel; ++v) {
          const int y = i * shape.stride + u - shape.padding;
          const int x = j * shape.stride + v - shape.padding;
          if (y < 0 || y >= shape.height || x < 0 || x >= shape.width) continue;
          body(int64_t{i} * shape.output_width + j,
               (int64_t{u} * shape.kernel + v) * shape.channels,
               (int64_t{y} * shape.width + x) * shape.channels);
        }
      }
    }
  }
}

// The pixels of image b that each pixel of the output reads: (pixels, patch).
Matrix Patches(const ConvolutionShape& shape, const void* x, int64_t b) {
  const Floats image = ReadNumbers(shape.type, x, b * InputOf(shape), InputOf(shape));
  Matrix patches(PixelsOf(shape), PatchOf(shape));
  ForPositions(shape, [&](int64_t row, int64_t column, int64_t at) {
    std::copy_n(image.data() + at, shape.channels, patches.row(row) + column);
  });
  return patches;
}

Matrix WeightsOf(const ConvolutionShape& shape, const void* weight) {
  Matrix weights(shape.filters, PatchOf(shape));
  weights.values = ReadNumbers(shape.type, weight, 0, weights.rows * weights.columns);
  return weights;
}

Matrix OutputGradientOf(const ConvolutionShape& shape, const void* dy, int64_t b) {
  Matrix gradient(PixelsOf(shape), shape.filters);
  const int64_t count = gradient.rows * gradient.columns;
  gradient.values = ReadNumbers(shape.type, dy, b * count, count);
  return gradient;
}

}  // namespace

void ComputeProduct(const Product& product) {
  for (int64_t p = 0; p < product.count; ++p) {
    const Matrix a = Operand(product.input, product.a, p * product.a_step, product.a_stride,
                             product.a_transposed, product.rows, product.depth);
    const Matrix b = Operand(product.input, product.b, p * product.b_step, product.b_stride,
                             product.b_transposed, product.depth, product.columns);
    Matrix d(product.rows, product.columns);
    AddProduct(a, b, &d);
    const float* bias = product.bias == nullptr ? nullptr : product.bias + p * product.bias_step;
    for (int64_t i = 0; i < d.rows; ++i) {
      for (int64_t j = 0; j < d.columns; ++j) {
        const float value = Finish(d.row(i)[j], bias == nullptr ? nullptr : bias + j, product.relu);
        WriteNumber(product.output, value, p * product.d_step + i * product.d_stride + j,
                    product.d);
      }
    }
  }
}

void ComputeForward(const ConvolutionForward& convolution) {
  const ConvolutionShape& shape = convolution.shape;
  const Matrix weights = Transposed(WeightsOf(shape, convolution.weight));
  for (int64_t b = 0; b < shape.batch; ++b) {
    Matrix y(PixelsOf(shape), shape.filters);
    AddProduct(Patches(shape, convolution.x, b), weights, &y);
    for (int64_t i = 0; i < y.rows * y.columns; ++i) {
      const float* bias =
          convolution.bias == nullptr ? nullptr : convolution.bias + i % shape.filters;
      WriteNumber(shape.type, Finish(y.values[static_cast<size_t>(i)], bias, convolution.relu),
                  b * y.rows * y.columns + i, convolution.y);
    }
  }
}

void ComputeData(const ConvolutionData& convolution) {
  const ConvolutionShape& shape = convolution.shape;
  const Matrix weights = WeightsOf(shape, convolution.weight);
  for (int64_t b = 0; b < shape.batch; ++b) {
    Matrix patches(PixelsOf(shape), PatchOf(shape));
    AddProduct(OutputGradientOf(shape, convolution.dy, b), weights, &patches);
    Floats image(static_cast<size_t>(InputOf(shape)));
    ForPositions(shape, [&](int64_t row, int64_t column, int64_t at) {
      const float* const patch = patches.row(row) + column;
      for (int64_t c = 0; c < shape.channels; ++c) image[static_cast<size_t>(at + c)] += patch[c];
    });
    const int64_t first = b * InputOf(shape);
    for (int64_t i = 0; i < InputOf(shape); ++i) {
      WriteNumber(shape.type, image[static_cast<size_t>(i)], first + i, convolution.dx);
    }
  }
}

void ComputeWeights(const ConvolutionWeights& convolution) {
  const ConvolutionShape& shape = convolution.shape;
  Matrix weights(shape.filters, PatchOf(shape)), bias(1, shape.filters);
  for (int64_t b = 0; b < shape.batch; ++b) {
    const Matrix dy = OutputGradientOf(shape, convolution.dy, b);
    AddProduct(Transposed(dy), Patches(shape, convolution.x, b), &weights);
    for (int64_t i = 0; i < dy.rows; ++i) AddScaledRow(1, dy.row(i), dy.columns, bias.row(0));
  }
  std::ranges::copy(weights.values, convolution.weight_gradient);
  if (convolution.bias_gradient != nullptr) {
    std::ranges::copy(bias.values, convolution.bias_gradient);
  }
}

}  // namespace shoal::learner::device
