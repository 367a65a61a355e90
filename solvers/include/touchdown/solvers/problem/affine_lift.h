// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

namespace touchdown::solvers {

/// The part of a lift that moves with the interval: l(h) with its first two derivatives, arrays of
/// blocks x block_size. Implemented where the meaning is known (planning/boundary_lift).
class LiftOffset {
 public:
  virtual ~LiftOffset() = default;
  /// dl and d2l may be null. Does not allocate.
  virtual void At(double h, double* l, double* dl, double* d2l) const noexcept = 0;
};

/// x_i = c_i y_{b(i)} + l_i(h): every block of x is a multiple of at most one reduced block plus an
/// offset. Enough to eliminate both ends of a spline exactly, and it keeps the band.
struct AffineLift {
  int reduced_blocks = 0;
  std::vector<int> block;           ///< b(i), nondecreasing where >= 0; -1: x_i is the offset alone
  std::vector<double> coefficient;  ///< c_i
  std::shared_ptr<const LiftOffset> offset;  ///< null: zero

  /// x = y.
  static AffineLift Identity(int blocks);
};

}  // namespace touchdown::solvers
