// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "planning/baselines/ego/bspline_fit.h"
#include "planning/baselines/ego/ego_options.h"

namespace touchdown::planning {

/// Draws of the random first guess: the same seed gives the same draws everywhere.
class EgoRandom {
 public:
  explicit EgoRandom(std::uint64_t seed) : engine_(seed) {}
  double Centred();  ///< uniform in [-0.5, 0.5)

 private:
  std::mt19937_64 engine_;
};

/// Where a plan begins and where it shall end; the end's acceleration is zero.
struct EgoEnds {
  SplineState start;                                ///< in W
  Eigen::Vector3d p_end = Eigen::Vector3d::Zero();  ///< local target in W [m]
  Eigen::Vector3d v_end = Eigen::Vector3d::Zero();  ///< in W [m/s]
};

/// Nominal knot interval [s]: 1.2 d_cp / max_speed.
double NominalInterval(const EgoOptions& options);

/// Samples of one quintic from start to end, or with `random` of two through a random midpoint. The
/// midpoint's range grows with the `failures` before. The samples end up to one interval short of
/// the end, as published. Empty if no interval suits. Allocates.
std::optional<SampledPath> PolynomialPath(const EgoEnds& ends, const EgoOptions& options,
                                          EgoRandom* random, int failures);

/// The rest of `previous` from t on, then a quintic to the end, re-sampled at equal distances.
/// Empty where the polynomial shall be taken instead: no previous time left, or more than three
/// horizons of points. Allocates.
std::optional<SampledPath> WarmPath(const UniformBspline& previous, double t, const EgoEnds& ends,
                                    const EgoOptions& options);

}  // namespace touchdown::planning
