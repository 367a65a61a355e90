// SPDX-License-Identifier: BSD-3-Clause
// Forward automatic differentiation with a fixed number of directions: Dual carries a gradient,
// SecondDual a Hessian as well. A formula that is a template over its scalar takes both, and plain
// numbers.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace touchdown::solvers {

/// Partial derivatives of a function of two numbers.
struct Partials {
  double a, b;
};
struct SecondPartials {
  double aa, ab, bb;
};

/// The functions that a dual knows, by the chain rule. D has a value `v` and
///
///   D D::Chain(const D& a, double value, double slope, curvature)
///   D D::Combine(const D& a, const D& b, double value, Partials slopes, curvatures),
///
/// where curvature() and curvatures() are computed only if D asks for them.
template <class D>
struct DualFunctions {
  friend D operator+(const D& a, const D& b) {
    return D::Combine(a, b, a.v + b.v, {1.0, 1.0}, [] { return SecondPartials{0.0, 0.0, 0.0}; });
  }
  friend D operator-(const D& a, const D& b) {
    return D::Combine(a, b, a.v - b.v, {1.0, -1.0}, [] { return SecondPartials{0.0, 0.0, 0.0}; });
  }
  friend D operator*(const D& a, const D& b) {
    return D::Combine(a, b, a.v * b.v, {b.v, a.v}, [] { return SecondPartials{0.0, 1.0, 0.0}; });
  }
  friend D operator/(const D& a, const D& b) {
    const double inverse = 1.0 / b.v;
    const double quotient = a.v * inverse;
    return D::Combine(a, b, quotient, {inverse, -quotient * inverse}, [=] {
      return SecondPartials{0.0, -inverse * inverse, 2.0 * quotient * inverse * inverse};
    });
  }
  friend D operator-(const D& a) {
    return D::Chain(a, -a.v, -1.0, [] { return 0.0; });
  }
  friend D& operator+=(D& a, const D& b) { return a = a + b; }
  friend D& operator-=(D& a, const D& b) { return a = a - b; }
  friend D& operator*=(D& a, const D& b) { return a = a * b; }
  friend D& operator/=(D& a, const D& b) { return a = a / b; }

  /// Comparisons are of values, as branches are taken by them.
  friend bool operator==(const D& a, const D& b) { return a.v == b.v; }
  friend bool operator!=(const D& a, const D& b) { return a.v != b.v; }
  friend bool operator<(const D& a, const D& b) { return a.v < b.v; }
  friend bool operator>(const D& a, const D& b) { return a.v > b.v; }
  friend bool operator<=(const D& a, const D& b) { return a.v <= b.v; }
  friend bool operator>=(const D& a, const D& b) { return a.v >= b.v; }

  friend D sqrt(const D& a) {
    const double root = std::sqrt(a.v);
    return D::Chain(a, root, 0.5 / root, [&] { return -0.25 / (root * a.v); });
  }
  friend D sin(const D& a) {
    const double value = std::sin(a.v);
    return D::Chain(a, value, std::cos(a.v), [&] { return -value; });
  }
  friend D cos(const D& a) {
    const double value = std::cos(a.v);
    return D::Chain(a, value, -std::sin(a.v), [&] { return -value; });
  }
  friend D tan(const D& a) {
    const double value = std::tan(a.v), slope = 1.0 + value * value;
    return D::Chain(a, value, slope, [&] { return 2.0 * value * slope; });
  }
  friend D asin(const D& a) {
    const double slope = 1.0 / std::sqrt(1.0 - a.v * a.v);
    return D::Chain(a, std::asin(a.v), slope, [&] { return a.v * slope * slope * slope; });
  }
  friend D acos(const D& a) {
    const double slope = -1.0 / std::sqrt(1.0 - a.v * a.v);
    return D::Chain(a, std::acos(a.v), slope, [&] { return a.v * slope * slope * slope; });
  }
  friend D atan(const D& a) {
    const double slope = 1.0 / (1.0 + a.v * a.v);
    return D::Chain(a, std::atan(a.v), slope, [&] { return -2.0 * a.v * slope * slope; });
  }
  friend D exp(const D& a) {
    const double value = std::exp(a.v);
    return D::Chain(a, value, value, [&] { return value; });
  }
  friend D log(const D& a) {
    const double slope = 1.0 / a.v;
    return D::Chain(a, std::log(a.v), slope, [&] { return -slope * slope; });
  }
  friend D sinh(const D& a) {
    const double value = std::sinh(a.v);
    return D::Chain(a, value, std::cosh(a.v), [&] { return value; });
  }
  friend D cosh(const D& a) {
    const double value = std::cosh(a.v);
    return D::Chain(a, value, std::sinh(a.v), [&] { return value; });
  }
  friend D tanh(const D& a) {
    const double value = std::tanh(a.v), slope = 1.0 - value * value;
    return D::Chain(a, value, slope, [&] { return -2.0 * value * slope; });
  }
  /// The slope at 0 is that of the right side.
  friend D abs(const D& a) {
    const double sign = a.v < 0.0 ? -1.0 : 1.0;
    return D::Chain(a, sign * a.v, sign, [] { return 0.0; });
  }
  /// A constant exponent: negative bases are fine where it is whole.
  friend D pow(const D& a, double exponent) {
    const auto derivative = [&](double factor, double power) {
      return factor == 0.0 ? 0.0 : factor * std::pow(a.v, power);
    };
    return D::Chain(a, std::pow(a.v, exponent), derivative(exponent, exponent - 1.0),
                    [&] { return derivative(exponent * (exponent - 1.0), exponent - 2.0); });
  }
  /// Positive bases alone.
  friend D pow(const D& a, const D& exponent) {
    const double value = std::pow(a.v, exponent.v), e = exponent.v, log = std::log(a.v);
    const double less = value / a.v;
    return D::Combine(a, exponent, value, {e * less, value * log}, [=, &a] {
      return SecondPartials{e * (e - 1.0) * less / a.v, less * (1.0 + e * log), value * log * log};
    });
  }
  friend D pow(double base, const D& exponent) { return exp(std::log(base) * exponent); }
  friend D atan2(const D& y, const D& x) {
    const double inverse = 1.0 / (x.v * x.v + y.v * y.v);
    const Partials slopes = {x.v * inverse, -y.v * inverse};
    return D::Combine(y, x, std::atan2(y.v, x.v), slopes, [=] {
      return SecondPartials{2.0 * slopes.a * slopes.b, slopes.b * slopes.b - slopes.a * slopes.a,
                            -2.0 * slopes.a * slopes.b};
    });
  }
};

/// value + sum_i d[i] eps_i with eps_i eps_j = 0.
template <int n>
struct Dual : DualFunctions<Dual<n>> {
  double v = 0.0;
  std::array<double, n> d{};

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: constants mix freely with duals in formulas
  Dual(double value, int direction) : v(value) { d[direction] = 1.0; }

  double slope(int i) const { return d[i]; }

  template <class Curvature>
  static Dual Chain(const Dual& a, double value, double slope, const Curvature&) {
    Dual r;
    r.v = value;
    for (int i = 0; i < n; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  template <class Curvatures>
  static Dual Combine(const Dual& a, const Dual& b, double value, Partials s, const Curvatures&) {
    Dual r;
    r.v = value;
    for (int i = 0; i < n; ++i) r.d[i] = s.a * a.d[i] + s.b * b.d[i];
    return r;
  }
};

/// Value, gradient and Hessian by n variables. Most numbers of a formula depend on few of these.
/// Two sets of bits say which variables a number has a slope by, and between which it curves. Only
/// these entries are stored.
template <int n>
struct SecondDual : DualFunctions<SecondDual<n>> {
  static_assert(n <= 64, "more variables than a SecondDual has bits: write the curvature by hand");
  using Set = std::uint64_t;

  double v = 0.0;

  SecondDual() = default;
  SecondDual(double value) : v(value) {}  // NOLINT: as Dual's
  SecondDual(double value, int variable) : v(value), sloped_(Set{1} << variable) {
    slope_[variable] = 1.0;
  }
  SecondDual(const SecondDual& other) { *this = other; }
  SecondDual& operator=(const SecondDual& other) {
    v = other.v;
    sloped_ = other.sloped_;
    curved_ = other.curved_;
    ForEach(sloped_, [&](int i) { slope_[i] = other.slope_[i]; });
    ForEachPair(curved_, [&](int at, int, int) { curvature_[at] = other.curvature_[at]; });
    return *this;
  }

  double slope(int i) const { return Has(sloped_, i) ? slope_[i] : 0.0; }
  double curvature(int i, int j) const {
    return Has(curved_, i) && Has(curved_, j) ? curvature_[At(i, j)] : 0.0;
  }
  /// visit(i, j, curvature) for all i <= j that can curve.
  template <class Visit>
  void ForEachCurvature(Visit&& visit) const {
    ForEachPair(curved_, [&](int at, int i, int j) { visit(i, j, curvature_[at]); });
  }

  template <class Curvature>
  static SecondDual Chain(const SecondDual& a, double value, double slope,
                          const Curvature& curvature) {
    SecondDual r;
    r.v = value;
    r.sloped_ = a.sloped_;
    ForEach(r.sloped_, [&](int i) { r.slope_[i] = slope * a.slope_[i]; });
    const double second = curvature();
    r.curved_ = a.curved_ | (second != 0.0 ? a.sloped_ : 0);
    ForEachPair(r.curved_, [&](int at, int i, int j) {
      double sum = Has(a.curved_, i, j) ? slope * a.curvature_[at] : 0.0;
      if (second != 0.0 && Has(a.sloped_, i, j)) sum += second * a.slope_[i] * a.slope_[j];
      r.curvature_[at] = sum;
    });
    return r;
  }
  template <class Curvatures>
  static SecondDual Combine(const SecondDual& a, const SecondDual& b, double value, Partials s,
                            const Curvatures& curvatures) {
    SecondDual r;
    r.v = value;
    r.sloped_ = a.sloped_ | b.sloped_;
    ForEach(r.sloped_, [&](int i) { r.slope_[i] = s.a * a.slope(i) + s.b * b.slope(i); });
    const SecondPartials second = curvatures();
    r.curved_ = a.curved_ | b.curved_ | (second.aa != 0.0 ? a.sloped_ : 0) |
                (second.bb != 0.0 ? b.sloped_ : 0);
    if (second.ab != 0.0 && a.sloped_ && b.sloped_) r.curved_ |= r.sloped_;
    ForEachPair(r.curved_, [&](int at, int i, int j) {
      double sum = 0.0;
      if (Has(a.curved_, i, j)) sum += s.a * a.curvature_[at];
      if (Has(b.curved_, i, j)) sum += s.b * b.curvature_[at];
      const double ai = a.slope(i), aj = a.slope(j), bi = b.slope(i), bj = b.slope(j);
      r.curvature_[at] =
          sum + second.aa * ai * aj + second.ab * (ai * bj + aj * bi) + second.bb * bi * bj;
    });
    return r;
  }

 private:
  static bool Has(Set set, int i) { return (set >> i & 1) != 0; }
  static bool Has(Set set, int i, int j) { return Has(set, i) && Has(set, j); }
  static constexpr int At(int i, int j) { return i <= j ? j * (j + 1) / 2 + i : At(j, i); }
  template <class Visit>
  static void ForEach(Set set, Visit&& visit) {
    for (; set != 0; set &= set - 1) visit(std::countr_zero(set));
  }
  /// visit(place, i, j), i <= j.
  template <class Visit>
  static void ForEachPair(Set set, Visit&& visit) {
    ForEach(set, [&](int j) {
      ForEach(set & (~Set{0} >> (63 - j)), [&](int i) { visit(j * (j + 1) / 2 + i, i, j); });
    });
  }

  Set sloped_ = 0, curved_ = 0;
  std::array<double, n> slope_;                  // where sloped_ says so
  std::array<double, n*(n + 1) / 2> curvature_;  // upper triangle, where curved_ does
};

/// The number behind a scalar of any type.
inline double ValueOf(double x) { return x; }
template <class D>
double ValueOf(const DualFunctions<D>& x) {
  return static_cast<const D&>(x).v;
}

}  // namespace touchdown::solvers
