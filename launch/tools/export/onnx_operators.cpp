// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_operators.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using Shape = std::vector<int64_t>;

void Expect(bool good, const OnnxNode& node, const char* what) {
  if (!good) throw RuntimeError("{} {}: expected {}", node.op, node.output, what);
}

template <class T>
T Get(const OnnxNode& node, const char* name) {
  const auto at = node.attributes.find(name);
  const T* value = at == node.attributes.end() ? nullptr : std::get_if<T>(&at->second);
  if (value == nullptr) throw RuntimeError("{} {}: no {}", node.op, node.output, name);
  return *value;
}

// ---- one number at a time ----

template <class Function>
OnnxTensor MapValues(const OnnxTensor& x, const Function& function) {
  OnnxTensor y = x;
  std::ranges::transform(x.values, y.values.begin(), function);
  return y;
}

// The evaluator stores all inputs as f32, whatever type the file declares.
OnnxTensor Cast(const OnnxNode& node, OnnxArguments in) {
  Expect(Get<int64_t>(node, "to") == int64_t(OnnxPort::Type::kF32), node, "f32");
  return *in[0];
}

OnnxTensor Relu(const OnnxNode&, OnnxArguments in) {
  return MapValues(*in[0], [](float x) { return x > 0 || std::isnan(x) ? x : 0.f; });
}

OnnxTensor Tanh(const OnnxNode&, OnnxArguments in) {
  return MapValues(*in[0], [](float x) { return std::tanh(x); });
}

OnnxTensor Elu(const OnnxNode&, OnnxArguments in) {
  return MapValues(*in[0], [](float x) { return x > 0 || std::isnan(x) ? x : std::expm1(x); });
}

OnnxTensor Exp(const OnnxNode&, OnnxArguments in) {
  return MapValues(*in[0], [](float x) { return std::exp(x); });
}

OnnxTensor Clip(const OnnxNode& node, OnnxArguments in) {
  Expect(in.size() == 3 && in[1]->values.size() == 1 && in[2]->values.size() == 1, node,
         "a lower and an upper bound");
  const float low = in[1]->values[0], high = in[2]->values[0];
  return MapValues(*in[0], [&](float x) { return std::min(std::max(x, low), high); });
}

// The shape of the second input is the end of the first one's shape, so its numbers repeat.
template <class Function>
OnnxTensor Combine(const OnnxNode& node, OnnxArguments in, const Function& function) {
  Expect(in.size() == 2, node, "two inputs");
  const Shape& a = in[0]->shape;
  const Shape& b = in[1]->shape;
  Expect(b.size() <= a.size() && std::equal(b.rbegin(), b.rend(), a.rbegin()), node,
         "a second shape that ends the first");
  OnnxTensor y = *in[0];
  const size_t period = in[1]->values.size();
  for (size_t i = 0; i < y.values.size(); ++i) {
    y.values[i] = function(y.values[i], in[1]->values[i % period]);
  }
  return y;
}

OnnxTensor Add(const OnnxNode& node, OnnxArguments in) {
  return Combine(node, in, [](float a, float b) { return a + b; });
}
OnnxTensor Sub(const OnnxNode& node, OnnxArguments in) {
  return Combine(node, in, [](float a, float b) { return a - b; });
}
OnnxTensor Mul(const OnnxNode& node, OnnxArguments in) {
  return Combine(node, in, [](float a, float b) { return a * b; });
}
OnnxTensor Div(const OnnxNode& node, OnnxArguments in) {
  return Combine(node, in, [](float a, float b) { return a / b; });
}

// ---- shapes ----

OnnxTensor Flatten(const OnnxNode& node, OnnxArguments in) {
  Expect(Get<int64_t>(node, "axis") == 1 && !in[0]->shape.empty(), node, "axis 1");
  const int64_t rows = in[0]->shape[0];
  return {{rows, int64_t(in[0]->values.size()) / std::max<int64_t>(rows, 1)}, in[0]->values};
}

OnnxTensor Concat(const OnnxNode& node, OnnxArguments in) {
  Expect(Get<int64_t>(node, "axis") == 1, node, "axis 1");
  OnnxTensor y{.shape = {in[0]->shape.at(0), 0}};
  for (const OnnxTensor* x : in) {
    Expect(x->shape.size() == 2 && x->shape[0] == y.shape[0], node, "matrices of as many rows");
    y.shape[1] += x->shape[1];
  }
  for (int64_t row = 0; row < y.shape[0]; ++row) {
    for (const OnnxTensor* x : in) {
      const auto begin = x->values.begin() + row * x->shape[1];
      y.values.insert(y.values.end(), begin, begin + x->shape[1]);
    }
  }
  return y;
}

// ---- products ----

// y = x W' + b; x (N, I), W (O, I), b (O).
OnnxTensor Gemm(const OnnxNode& node, OnnxArguments in) {
  Expect(Get<int64_t>(node, "transB") == 1 && in.size() == 3, node, "transB and three inputs");
  const OnnxTensor &x = *in[0], &w = *in[1], &b = *in[2];
  Expect(x.shape.size() == 2 && w.shape.size() == 2 && x.shape[1] == w.shape[1] &&
             b.shape == Shape{w.shape[0]},
         node, "x (N, I), W (O, I), b (O)");
  const int64_t inputs = w.shape[1], outputs = w.shape[0];
  OnnxTensor y{.shape = {x.shape[0], outputs}};
  for (int64_t n = 0; n < x.shape[0]; ++n) {
    for (int64_t o = 0; o < outputs; ++o) {
      double sum = b.values[size_t(o)];
      for (int64_t i = 0; i < inputs; ++i) {
        sum += double(x.values[size_t(n * inputs + i)]) * w.values[size_t(o * inputs + i)];
      }
      y.values.push_back(float(sum));
    }
  }
  return y;
}

// The last two dimensions of each input are matrices. One of the inputs is a single matrix.
OnnxTensor MatMul(const OnnxNode& node, OnnxArguments in) {
  Expect(in.size() == 2, node, "two inputs");
  const OnnxTensor &a = *in[0], &b = *in[1];
  Expect(std::min(a.shape.size(), b.shape.size()) == 2, node, "a matrix on one side");
  const int64_t rows = a.shape[a.shape.size() - 2], inner = a.shape.back();
  const int64_t columns = b.shape.back();
  Expect(b.shape[b.shape.size() - 2] == inner, node, "matrices that fit");
  const bool many_left = a.shape.size() > 2;
  OnnxTensor y{.shape = many_left ? a.shape : b.shape};
  y.shape[y.shape.size() - 2] = rows;
  y.shape.back() = columns;
  const size_t matrices = Count(y.shape) / size_t(rows * columns);
  for (size_t m = 0; m < matrices; ++m) {
    const float* left = a.values.data() + (many_left ? m * size_t(rows * inner) : 0);
    const float* right = b.values.data() + (many_left ? 0 : m * size_t(inner * columns));
    for (int64_t i = 0; i < rows; ++i) {
      for (int64_t j = 0; j < columns; ++j) {
        double sum = 0;
        for (int64_t k = 0; k < inner; ++k) {
          sum += double(left[i * inner + k]) * right[k * columns + j];
        }
        y.values.push_back(float(sum));
      }
    }
  }
  return y;
}

// ---- windows over maps (N, C, H, W) ----

struct Window {
  int64_t kernel, stride, padding, height, width;  // height, width: of the output

  Window(const OnnxNode& node, const Shape& x)
      : kernel(Side(node, "kernel_shape")),
        stride(Side(node, "strides")),
        padding(node.attributes.contains("pads") ? Side(node, "pads") : 0) {
    Expect(x.size() == 4 && kernel > 0 && stride > 0, node, "a map (N, C, H, W) and a window");
    height = (x[2] + 2 * padding - kernel) / stride + 1;
    width = (x[3] + 2 * padding - kernel) / stride + 1;
    Expect(height > 0 && width > 0, node, "a map as large as the window");
  }

  static int64_t Side(const OnnxNode& node, const char* name) {
    const auto sides = Get<std::vector<int64_t>>(node, name);
    Expect(!sides.empty() && std::ranges::count(sides, sides[0]) == std::ssize(sides), node,
           "the same on all sides");
    return sides[0];
  }

  // Calls visit(u, v, offset in the window) for the window's cells (u, v) within the map.
  template <class Visit>
  void ForCells(int64_t i, int64_t j, const Shape& x, const Visit& visit) const {
    for (int64_t k = 0; k < kernel; ++k) {
      const int64_t u = i * stride - padding + k;
      if (u < 0 || u >= x[2]) continue;
      for (int64_t l = 0; l < kernel; ++l) {
        const int64_t v = j * stride - padding + l;
        if (v >= 0 && v < x[3]) visit(u, v, k * kernel + l);
      }
    }
  }
};

// reduce(plane (H, W), i, j) for every plane of x and every place (i, j) of the output.
template <class Reduce>
OnnxTensor MapPlanes(const OnnxTensor& x, const Window& window, const Reduce& reduce) {
  OnnxTensor y{.shape = {x.shape[0], x.shape[1], window.height, window.width}};
  const int64_t plane = x.shape[2] * x.shape[3];
  for (int64_t p = 0; p < x.shape[0] * x.shape[1]; ++p) {
    for (int64_t i = 0; i < window.height; ++i) {
      for (int64_t j = 0; j < window.width; ++j) {
        y.values.push_back(reduce(x.values.data() + p * plane, i, j));
      }
    }
  }
  return y;
}

OnnxTensor AveragePool(const OnnxNode& node, OnnxArguments in) {
  const Window window(node, in[0]->shape);
  Expect(window.padding == 0, node, "no padding");
  return MapPlanes(*in[0], window, [&](const float* plane, int64_t i, int64_t j) {
    double sum = 0;
    window.ForCells(i, j, in[0]->shape,
                    [&](int64_t u, int64_t v, int64_t) { sum += plane[u * in[0]->shape[3] + v]; });
    return float(sum / double(window.kernel * window.kernel));
  });
}

OnnxTensor MaxPool(const OnnxNode& node, OnnxArguments in) {
  const Window window(node, in[0]->shape);
  return MapPlanes(*in[0], window, [&](const float* plane, int64_t i, int64_t j) {
    float most = -std::numeric_limits<float>::infinity();
    window.ForCells(i, j, in[0]->shape, [&](int64_t u, int64_t v, int64_t) {
      most = std::max(most, plane[u * in[0]->shape[3] + v]);
    });
    return most;
  });
}

OnnxTensor GlobalMaxPool(const OnnxNode& node, OnnxArguments in) {
  const OnnxTensor& x = *in[0];
  Expect(x.shape.size() == 4 && x.shape[2] * x.shape[3] > 0, node, "a map (N, C, H, W)");
  OnnxTensor y{.shape = {x.shape[0], x.shape[1], 1, 1}};
  const int64_t plane = x.shape[2] * x.shape[3];
  for (auto at = x.values.begin(); at != x.values.end(); at += plane) {
    y.values.push_back(*std::max_element(at, at + plane));
  }
  return y;
}

// x (N, C, H, W), W (O, C, k, k), b (O) or nothing. Outside the map is 0.
OnnxTensor Conv(const OnnxNode& node, OnnxArguments in) {
  const Window window(node, in[0]->shape);
  const OnnxTensor &x = *in[0], &w = *in[1];
  const int64_t channels = x.shape[1], outputs = w.shape.at(0),
                cells = window.kernel * window.kernel;
  Expect(w.shape == Shape{outputs, channels, window.kernel, window.kernel} &&
             (in.size() == 2 || in[2]->shape == Shape{outputs}),
         node, "x (N, C, H, W), W (O, C, k, k), b (O)");
  OnnxTensor y{.shape = {x.shape[0], outputs, window.height, window.width}};
  const int64_t plane = x.shape[2] * x.shape[3];
  for (int64_t no = 0; no < x.shape[0] * outputs; ++no) {
    const int64_t n = no / outputs, o = no % outputs;
    const float* image = x.values.data() + n * channels * plane;
    const float* filter = w.values.data() + o * channels * cells;
    for (int64_t i = 0; i < window.height; ++i) {
      for (int64_t j = 0; j < window.width; ++j) {
        double sum = in.size() == 2 ? 0 : in[2]->values[size_t(o)];
        for (int64_t c = 0; c < channels; ++c) {
          window.ForCells(i, j, x.shape, [&](int64_t u, int64_t v, int64_t at) {
            sum += double(image[c * plane + u * x.shape[3] + v]) * filter[c * cells + at];
          });
        }
        y.values.push_back(float(sum));
      }
    }
  }
  return y;
}

// ---- normalisation ----

// Normalises x (N, C, ...) by scale, shift, mean and variance (C).
OnnxTensor BatchNormalization(const OnnxNode& node, OnnxArguments in) {
  Expect(in.size() == 5 && in[0]->shape.size() >= 2, node, "five inputs");
  const int64_t channels = in[0]->shape[1];
  for (size_t i = 1; i < 5; ++i) {
    Expect(in[i]->shape == Shape{channels}, node, "a number per channel");
  }
  const double epsilon = Get<float>(node, "epsilon");
  OnnxTensor y = *in[0];
  const size_t plane = y.values.size() / size_t(y.shape[0] * channels);
  for (size_t i = 0; i < y.values.size(); ++i) {
    const size_t c = i / plane % size_t(channels);
    const double scale = in[1]->values[c] / std::sqrt(double(in[4]->values[c]) + epsilon);
    y.values[i] = float((double(y.values[i]) - in[3]->values[c]) * scale + in[2]->values[c]);
  }
  return y;
}

// Normalises the rows of x (N, F) by scale and shift (F).
OnnxTensor LayerNormalization(const OnnxNode& node, OnnxArguments in) {
  Expect(Get<int64_t>(node, "axis") == -1 && in.size() == 3, node, "the last axis, three inputs");
  const size_t columns = size_t(in[0]->shape.back());
  Expect(in[1]->values.size() == columns && in[2]->values.size() == columns, node,
         "a number per column");
  const double epsilon = Get<float>(node, "epsilon");
  OnnxTensor y = *in[0];
  for (size_t row = 0; row < y.values.size(); row += columns) {
    double sum = 0, squares = 0;
    for (size_t j = 0; j < columns; ++j) sum += y.values[row + j];
    const double mean = sum / double(columns);
    for (size_t j = 0; j < columns; ++j) squares += std::pow(y.values[row + j] - mean, 2);
    const double scale = 1 / std::sqrt(squares / double(columns) + epsilon);
    for (size_t j = 0; j < columns; ++j) {
      float& value = y.values[row + j];
      value = float((value - mean) * scale * in[1]->values[j] + in[2]->values[j]);
    }
  }
  return y;
}

constexpr std::pair<std::string_view, OnnxOperator> kOperators[] = {
    {"Add", Add},
    {"AveragePool", AveragePool},
    {"BatchNormalization", BatchNormalization},
    {"Cast", Cast},
    {"Clip", Clip},
    {"Concat", Concat},
    {"Conv", Conv},
    {"Div", Div},
    {"Elu", Elu},
    {"Exp", Exp},
    {"Flatten", Flatten},
    {"Gemm", Gemm},
    {"GlobalMaxPool", GlobalMaxPool},
    {"MatMul", MatMul},
    {"MaxPool", MaxPool},
    {"Mul", Mul},
    {"Relu", Relu},
    {"Sub", Sub},
    {"Tanh", Tanh},
    {"LayerNormalization", LayerNormalization},
};

}  // namespace

OnnxOperator FindOnnxOperator(std::string_view name) {
  const auto at =
      std::ranges::find(kOperators, name, &std::pair<std::string_view, OnnxOperator>::first);
  return at == std::end(kOperators) ? nullptr : at->second;
}

}  // namespace shoal::launch
