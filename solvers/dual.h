// SPDX-License-Identifier: BSD-3-Clause
// Forward automatic differentiation with a fixed number of directions. Nests: Dual<Dual<double, n>,
// n> carries exact second derivatives. The whole derivative vector lives on the stack.
#pragma once

#include <array>
#include <cmath>

namespace touchdown::solvers {

/// value + sum_i d[i] eps_i with eps_i eps_j = 0. S is double or another Dual.
template <class S, int n>
struct Dual {
  S v{};
  std::array<S, n> d{};

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: constants mix freely with duals in formulas
  Dual(const S& value, int direction) : v(value) { d[direction] = S(1.0); }

  Dual& operator+=(const Dual& o) { return *this = *this + o; }
  Dual& operator-=(const Dual& o) { return *this = *this - o; }
  Dual& operator*=(const Dual& o) { return *this = *this * o; }
  Dual& operator/=(const Dual& o) { return *this = *this / o; }

  friend Dual operator-(const Dual& a) { return Chain(a, -a.v, S(-1.0)); }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return Combine(a, b, a.v + b.v, S(1.0), S(1.0));
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return Combine(a, b, a.v - b.v, S(1.0), S(-1.0));
  }
  friend Dual operator*(const Dual& a, const Dual& b) { return Combine(a, b, a.v * b.v, b.v, a.v); }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const S inverse = S(1.0) / b.v;
    const S quotient = a.v * inverse;
    return Combine(a, b, quotient, inverse, -quotient * inverse);
  }
  /// Comparisons are of values, as branches are taken by them.
  friend bool operator==(const Dual& a, const Dual& b) { return a.v == b.v; }
  friend bool operator!=(const Dual& a, const Dual& b) { return !(a == b); }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return b < a; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend bool operator>=(const Dual& a, const Dual& b) { return b <= a; }

  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const S root = sqrt(a.v);
    return Chain(a, root, S(0.5) / root);
  }
  friend Dual sin(const Dual& a) {
    using std::cos, std::sin;
    return Chain(a, sin(a.v), cos(a.v));
  }
  friend Dual cos(const Dual& a) {
    using std::cos, std::sin;
    return Chain(a, cos(a.v), -sin(a.v));
  }
  friend Dual exp(const Dual& a) {
    using std::exp;
    const S value = exp(a.v);
    return Chain(a, value, value);
  }
  friend Dual log(const Dual& a) {
    using std::log;
    return Chain(a, log(a.v), S(1.0) / a.v);
  }
  friend Dual tan(const Dual& a) {
    using std::tan;
    const S value = tan(a.v);
    return Chain(a, value, S(1.0) + value * value);
  }
  friend Dual asin(const Dual& a) {
    using std::asin, std::sqrt;
    return Chain(a, asin(a.v), S(1.0) / sqrt(S(1.0) - a.v * a.v));
  }
  friend Dual acos(const Dual& a) {
    using std::acos, std::sqrt;
    return Chain(a, acos(a.v), S(-1.0) / sqrt(S(1.0) - a.v * a.v));
  }
  friend Dual atan(const Dual& a) {
    using std::atan;
    return Chain(a, atan(a.v), S(1.0) / (S(1.0) + a.v * a.v));
  }
  friend Dual sinh(const Dual& a) {
    using std::cosh, std::sinh;
    return Chain(a, sinh(a.v), cosh(a.v));
  }
  friend Dual cosh(const Dual& a) {
    using std::cosh, std::sinh;
    return Chain(a, cosh(a.v), sinh(a.v));
  }
  friend Dual tanh(const Dual& a) {
    using std::tanh;
    const S value = tanh(a.v);
    return Chain(a, value, S(1.0) - value * value);
  }
  /// The slope at 0 is that of the right side.
  friend Dual abs(const Dual& a) { return a.v < S(0.0) ? -a : a; }
  /// A constant exponent: negative bases are fine where it is whole. (The second derivative of x^1 at 0 is 0.)
  friend Dual pow(const Dual& a, double exponent) {
    using std::pow;
    if (exponent == 0.0) return Dual(1.0);
    return Chain(a, pow(a.v, exponent), S(exponent) * pow(a.v, exponent - 1.0));
  }
  /// Positive bases alone.
  friend Dual pow(const Dual& a, const Dual& exponent) {
    using std::log, std::pow;
    const S value = pow(a.v, exponent.v);
    return Combine(a, exponent, value, exponent.v * pow(a.v, exponent.v - S(1.0)), value * log(a.v));
  }
  friend Dual pow(double base, const Dual& exponent) { return exp(std::log(base) * exponent); }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const S norm2 = x.v * x.v + y.v * y.v;
    return Combine(y, x, atan2(y.v, x.v), x.v / norm2, -y.v / norm2);
  }

 private:
  static Dual Chain(const Dual& a, const S& value, const S& slope) {
    Dual r;
    r.v = value;
    for (int i = 0; i < n; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  static Dual Combine(const Dual& a, const Dual& b, const S& value, const S& da, const S& db) {
    Dual r;
    r.v = value;
    for (int i = 0; i < n; ++i) r.d[i] = da * a.d[i] + db * b.d[i];
    return r;
  }
};

}  // namespace touchdown::solvers
