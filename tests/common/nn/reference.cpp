// SPDX-License-Identifier: Apache-2.0
#include "tests/common/nn/reference.h"

#include <algorithm>
#include <cmath>

namespace shoal::nn::reference {
namespace {

// Calls visit(y index, x index, weight index, filter) for every product of the convolution.
template <class Visit>
void ForConvProducts(const ConvShape& s, const Visit& visit) {
  const int h = s.out_height(), w = s.out_width();
  for (int b = 0; b < s.batch; ++b) {
    for (int n = 0; n < s.filters; ++n) {
      for (int i = 0; i < h; ++i) {
        for (int j = 0; j < w; ++j) {
          for (int c = 0; c < s.channels; ++c) {
            for (int u = 0; u < s.kernel; ++u) {
              for (int v = 0; v < s.kernel; ++v) {
                const int row = i * s.stride + u - s.padding;
                const int column = j * s.stride + v - s.padding;
                if (row < 0 || row >= s.height || column < 0 || column >= s.width) continue;
                visit(((b * s.filters + n) * h + i) * w + j,
                      ((b * s.channels + c) * s.height + row) * s.width + column,
                      ((n * s.channels + c) * s.kernel + u) * s.kernel + v);
              }
            }
          }
        }
      }
    }
  }
}

}  // namespace

Values ConvForward(const ConvShape& s, const Values& x, const Values& weight, const Values& bias) {
  const int map = s.out_height() * s.out_width();
  Values y(size_t(s.batch * s.filters * map));
  for (size_t k = 0; k < y.size(); ++k) y[k] = bias[(k / size_t(map)) % size_t(s.filters)];
  ForConvProducts(s, [&](int at, int from, int with) {
    y[size_t(at)] += x[size_t(from)] * weight[size_t(with)];
  });
  return s.relu ? Relu(y) : y;
}

Gradient ConvBackward(const ConvShape& s, const Values& x, const Values& weight, const Values& y,
                      const Values& dy) {
  const int map = s.out_height() * s.out_width();
  Values masked = dy;
  for (size_t k = 0; k < y.size(); ++k) {
    if (s.relu && y[k] <= 0) masked[k] = 0;
  }
  Gradient gradient{Values(x.size()), Values(weight.size()), Values(size_t(s.filters))};
  for (size_t k = 0; k < y.size(); ++k) {
    gradient.bias[(k / size_t(map)) % size_t(s.filters)] += masked[k];
  }
  ForConvProducts(s, [&](int at, int from, int with) {
    gradient.source[size_t(from)] += masked[size_t(at)] * weight[size_t(with)];
    gradient.weight[size_t(with)] += masked[size_t(at)] * x[size_t(from)];
  });
  return gradient;
}

Moments BatchMoments(int batch, const Values& x, int channels) {
  const size_t c = size_t(channels), n = x.size() / size_t(batch) / c;
  Moments moments{Values(c), Values(c)};
  for (size_t k = 0; k < x.size(); ++k) moments.mean[k / n % c] += x[k] / double(batch * int(n));
  for (size_t k = 0; k < x.size(); ++k) {
    const double apart = x[k] - moments.mean[k / n % c];
    moments.variance[k / n % c] += apart * apart / double(batch * int(n));
  }
  return moments;
}

Values BatchNormForward(int batch, const Values& x, const Moments& moments, const Values& weight,
                        const Values& bias) {
  const size_t channels = weight.size(), n = x.size() / size_t(batch) / channels;
  Values y(x.size());
  for (size_t k = 0; k < x.size(); ++k) {
    const size_t c = k / n % channels;
    y[k] = weight[c] * (x[k] - moments.mean[c]) / std::sqrt(moments.variance[c] + 1e-5) + bias[c];
  }
  return y;
}

Gradient BatchNormBackward(int batch, const Values& x, const Values& weight, const Values& dy) {
  const size_t channels = weight.size(), n = x.size() / size_t(batch) / channels;
  const double count = double(batch) * double(n);
  const Moments moments = BatchMoments(batch, x, int(channels));
  Gradient gradient{Values(x.size()), Values(channels), Values(channels)};
  const auto normalised = [&](size_t k, size_t c) {
    return (x[k] - moments.mean[c]) / std::sqrt(moments.variance[c] + 1e-5);
  };
  for (size_t k = 0; k < x.size(); ++k) {
    const size_t c = k / n % channels;
    gradient.weight[c] += dy[k] * normalised(k, c);
    gradient.bias[c] += dy[k];
  }
  for (size_t k = 0; k < x.size(); ++k) {
    const size_t c = k / n % channels;
    gradient.source[k] =
        weight[c] / std::sqrt(moments.variance[c] + 1e-5) *
        (dy[k] - gradient.bias[c] / count - normalised(k, c) * gradient.weight[c] / count);
  }
  return gradient;
}

namespace {

// Calls visit(y index, x index of the first largest value of its window).
template <class Visit>
void ForMaxima(const PoolShape& s, const Values& x, const Visit& visit) {
  const int h = s.out_height(), w = s.out_width();
  for (int at = 0; at < s.planes * h * w; ++at) {
    const int p = at / (h * w), i = at / w % h, j = at % w;
    int best = -1;
    for (int u = 0; u < s.kernel; ++u) {
      for (int v = 0; v < s.kernel; ++v) {
        const int row = i * s.stride + u - s.padding, column = j * s.stride + v - s.padding;
        if (row < 0 || row >= s.height || column < 0 || column >= s.width) continue;
        const int from = (p * s.height + row) * s.width + column;
        if (best < 0 || x[size_t(from)] > x[size_t(best)]) best = from;
      }
    }
    visit(size_t(at), size_t(best));
  }
}

// Calls visit(y index, x index, numbers in the window).
template <class Visit>
void ForWindows(const AveragePoolShape& s, const Visit& visit) {
  const auto begin = [](int i, int from, int to) { return i * from / to; };
  const auto end = [](int i, int from, int to) { return ((i + 1) * from + to - 1) / to; };
  for (int p = 0; p < s.planes; ++p) {
    for (int i = 0; i < s.out_height; ++i) {
      for (int j = 0; j < s.out_width; ++j) {
        const int top = begin(i, s.height, s.out_height), bottom = end(i, s.height, s.out_height);
        const int left = begin(j, s.width, s.out_width), right = end(j, s.width, s.out_width);
        for (int u = top; u < bottom; ++u) {
          for (int v = left; v < right; ++v) {
            visit(size_t((p * s.out_height + i) * s.out_width + j),
                  size_t((p * s.height + u) * s.width + v), (bottom - top) * (right - left));
          }
        }
      }
    }
  }
}

}  // namespace

Values MaxPoolForward(const PoolShape& s, const Values& x) {
  Values y(size_t(s.planes * s.out_height() * s.out_width()));
  ForMaxima(s, x, [&](size_t at, size_t from) { y[at] = x[from]; });
  return y;
}

Values MaxPoolBackward(const PoolShape& s, const Values& x, const Values& dy) {
  Values dx(x.size());
  ForMaxima(s, x, [&](size_t at, size_t from) { dx[from] += dy[at]; });
  return dx;
}

Values AveragePoolForward(const AveragePoolShape& s, const Values& x) {
  Values y(size_t(s.planes * s.out_height * s.out_width));
  ForWindows(s, [&](size_t at, size_t from, int count) { y[at] += x[from] / count; });
  return y;
}

Values AveragePoolBackward(const AveragePoolShape& s, const Values& dy) {
  Values dx(size_t(s.planes * s.height * s.width));
  ForWindows(s, [&](size_t at, size_t from, int count) { dx[from] += dy[at] / count; });
  return dx;
}

Values Points(const PointsShape& s, const Values& x) {
  const auto coordinate = [](int at, int side) {
    return side == 1 ? 0. : -1 + 2. * at / (side - 1);
  };
  const int plane = s.height * s.width;
  Values points;
  for (int p = 0; p < s.planes; ++p) {
    const auto first = x.begin() + p * plane;
    const double largest = *std::max_element(first, first + plane);
    double sum = 0, across = 0, down = 0;
    for (int i = 0; i < plane; ++i) {
      const double weight = std::exp(s.sharpness * (first[i] - largest));
      sum += weight;
      across += weight * coordinate(i % s.width, s.width);
      down += weight * coordinate(i / s.width, s.height);
    }
    points.push_back(across / sum);
    points.push_back(down / sum);
  }
  return points;
}

Values LinearForward(int batch, const Values& x, const Values& weight, const Values& bias) {
  const size_t outputs = bias.size(), inputs = weight.size() / outputs;
  Values y(size_t(batch) * outputs);
  for (size_t b = 0; b < size_t(batch); ++b) {
    for (size_t o = 0; o < outputs; ++o) {
      y[b * outputs + o] = bias[o];
      for (size_t i = 0; i < inputs; ++i) {
        y[b * outputs + o] += weight[o * inputs + i] * x[b * inputs + i];
      }
    }
  }
  return y;
}

Gradient LinearBackward(int batch, const Values& x, const Values& weight, const Values& dy) {
  const size_t outputs = dy.size() / size_t(batch), inputs = weight.size() / outputs;
  Gradient gradient{Values(x.size()), Values(weight.size()), Values(outputs)};
  for (size_t b = 0; b < size_t(batch); ++b) {
    for (size_t o = 0; o < outputs; ++o) {
      const double d = dy[b * outputs + o];
      gradient.bias[o] += d;
      for (size_t i = 0; i < inputs; ++i) {
        gradient.source[b * inputs + i] += d * weight[o * inputs + i];
        gradient.weight[o * inputs + i] += d * x[b * inputs + i];
      }
    }
  }
  return gradient;
}

namespace {

// xhat of one row, and rstd.
double Normalise(const double* x, size_t n, double* xhat) {
  double mean = 0, variance = 0;
  for (size_t j = 0; j < n; ++j) mean += x[j] / double(n);
  for (size_t j = 0; j < n; ++j) variance += (x[j] - mean) * (x[j] - mean) / double(n);
  const double rstd = 1 / std::sqrt(variance + 1e-5);
  for (size_t j = 0; j < n; ++j) xhat[j] = (x[j] - mean) * rstd;
  return rstd;
}

}  // namespace

Values LayerNormForward(int batch, const Values& x, const Values& weight, const Values& bias) {
  const size_t n = weight.size();
  Values y(x.size()), xhat(n);
  for (size_t b = 0; b < size_t(batch); ++b) {
    Normalise(x.data() + b * n, n, xhat.data());
    for (size_t j = 0; j < n; ++j) y[b * n + j] = weight[j] * xhat[j] + bias[j];
  }
  return y;
}

Gradient LayerNormBackward(int batch, const Values& x, const Values& weight, const Values& dy) {
  const size_t n = weight.size();
  Gradient gradient{Values(x.size()), Values(n), Values(n)};
  Values xhat(n);
  for (size_t b = 0; b < size_t(batch); ++b) {
    const double rstd = Normalise(x.data() + b * n, n, xhat.data());
    double sum = 0, dot = 0;
    for (size_t j = 0; j < n; ++j) {
      sum += dy[b * n + j] * weight[j];
      dot += dy[b * n + j] * weight[j] * xhat[j];
      gradient.weight[j] += dy[b * n + j] * xhat[j];
      gradient.bias[j] += dy[b * n + j];
    }
    for (size_t j = 0; j < n; ++j) {
      gradient.source[b * n + j] =
          rstd * (dy[b * n + j] * weight[j] - sum / double(n) - xhat[j] * dot / double(n));
    }
  }
  return gradient;
}

Values Plus(Values x, const Values& y) {
  for (size_t k = 0; k < x.size(); ++k) x[k] += y[k];
  return x;
}

Values Relu(Values x) {
  for (double& value : x) value = std::max(value, 0.0);
  return x;
}

Values Tanh(Values x) {
  for (double& value : x) value = std::tanh(value);
  return x;
}

Values Beside(int batch, const Values& left, const Values& right) {
  const size_t n = left.size() / size_t(batch), m = right.size() / size_t(batch);
  Values both;
  for (size_t b = 0; b < size_t(batch); ++b) {
    both.insert(both.end(), left.begin() + long(b * n), left.begin() + long((b + 1) * n));
    both.insert(both.end(), right.begin() + long(b * m), right.begin() + long((b + 1) * m));
  }
  return both;
}

}  // namespace shoal::nn::reference
