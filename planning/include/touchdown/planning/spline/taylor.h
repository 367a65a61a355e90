// SPDX-License-Identifier: BSD-3-Clause
// Functions of time with their first three derivatives: truncated Taylor series, exact in every term (A. Griewank and
// A. Walther, "Evaluating Derivatives", chapter 13).
#pragma once

#include <array>
#include <cmath>

namespace touchdown::planning {

/// A function at a time: c[k] is its k-th derivative over k!.
struct Taylor {
  static constexpr int kOrder = 3;
  std::array<double, kOrder + 1> c{};

  Taylor() = default;
  Taylor(double constant) { c[0] = constant; }  // NOLINT: a number is a constant function
  /// Time itself, at t.
  static Taylor Time(double t) {
    Taylor time(t);
    time.c[1] = 1.0;
    return time;
  }
  double value() const { return c[0]; }
  double first() const { return c[1]; }
  double second() const { return 2.0 * c[2]; }
  double third() const { return 6.0 * c[3]; }
};

inline Taylor operator+(Taylor a, const Taylor& b) {
  for (int k = 0; k <= Taylor::kOrder; ++k) a.c[k] += b.c[k];
  return a;
}
inline Taylor operator-(Taylor a, const Taylor& b) {
  for (int k = 0; k <= Taylor::kOrder; ++k) a.c[k] -= b.c[k];
  return a;
}
inline Taylor operator-(const Taylor& a) { return Taylor() - a; }
inline Taylor operator*(const Taylor& a, const Taylor& b) {
  Taylor out;
  for (int k = 0; k <= Taylor::kOrder; ++k) {
    for (int i = 0; i <= k; ++i) out.c[k] += a.c[i] * b.c[k - i];
  }
  return out;
}
inline Taylor operator/(const Taylor& a, const Taylor& b) {
  Taylor out;
  for (int k = 0; k <= Taylor::kOrder; ++k) {
    double left = a.c[k];
    for (int i = 1; i <= k; ++i) left -= b.c[i] * out.c[k - i];
    out.c[k] = left / b.c[0];
  }
  return out;
}
inline bool operator<(const Taylor& a, const Taylor& b) { return a.c[0] < b.c[0]; }
inline bool operator>(const Taylor& a, const Taylor& b) { return b < a; }

inline Taylor sqrt(const Taylor& a) {
  Taylor out(std::sqrt(a.c[0]));
  for (int k = 1; k <= Taylor::kOrder; ++k) {
    double left = a.c[k];
    for (int i = 1; i < k; ++i) left -= out.c[i] * out.c[k - i];
    out.c[k] = left / (2.0 * out.c[0]);
  }
  return out;
}
inline Taylor exp(const Taylor& a) {
  Taylor out(std::exp(a.c[0]));
  for (int k = 1; k <= Taylor::kOrder; ++k) {
    for (int i = 1; i <= k; ++i) out.c[k] += i * a.c[i] * out.c[k - i] / k;
  }
  return out;
}
/// Sine and cosine of one angle.
inline std::array<Taylor, 2> SinCos(const Taylor& a) {
  Taylor sine(std::sin(a.c[0])), cosine(std::cos(a.c[0]));
  for (int k = 1; k <= Taylor::kOrder; ++k) {
    for (int i = 1; i <= k; ++i) {
      sine.c[k] += i * a.c[i] * cosine.c[k - i] / k;
      cosine.c[k] -= i * a.c[i] * sine.c[k - i] / k;
    }
  }
  return {sine, cosine};
}
inline Taylor sin(const Taylor& a) { return SinCos(a)[0]; }
inline Taylor cos(const Taylor& a) { return SinCos(a)[1]; }

}  // namespace touchdown::planning
