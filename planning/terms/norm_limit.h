// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/term.h"

namespace touchdown::planning {

/// Limits on the norm of a derivative control point d, as u = (|d|^2 - d_max^2) / (2 d_max): smooth,
/// zero on the limit, and there with the slope of |d| itself. Hinge loss, or the hard row u <= 0.
/// Convex at fixed h (a convex map under a nondecreasing convex loss).
/// Velocity: V_i = (Q_{i+1} - Q_i)/h, i = 2..N-3; knot velocities are means of neighbours, so they
/// are bounded with them. V_0 is no Bezier point and V_1 is the start's.
/// Acceleration: A_i = (Q_i - 2 Q_{i+1} + Q_{i+2})/h^2, i = 1..N-3; A_0 is the start's.
/// Units: m/s and m/s^2. Source: paper eq. 15; docs/formulation.md.
/// `limit` > 0 [m/s or m/s^2]; `weight` >= 0; `width` > 0 is where the hinge turns quadratic.
std::shared_ptr<solvers::Term> MakeSpeedLimit(int control_points, double limit, double weight,
                                              double width);
std::shared_ptr<solvers::Term> MakeAccelerationLimit(int control_points, double limit,
                                                     double weight, double width);

/// Their registry entries.
solvers::TermFactory SpeedLimitFactory();
solvers::TermFactory AccelerationLimitFactory();

}  // namespace touchdown::planning
