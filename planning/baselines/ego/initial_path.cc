// SPDX-License-Identifier: BSD-3-Clause
// First guesses of the EGO-Planner baseline, after the measured facts of the published system. The duration of the
// polynomial ignores the velocities of both ends, and its last sample is short of the end. A warm start's points are
// equally spaced in distance, but are used as equally spaced in time.

#include "planning/baselines/ego/initial_path.h"

#include <algorithm>
#include <cmath>

#include "planning/baselines/ego/quintic.h"

namespace touchdown::planning {

namespace {

constexpr int kFewestPoints = 7;
constexpr double kFinerBy = 1.5;     // the sampling, where it does not suit
constexpr double kWidestStep = 1.5;  // in control point distances
constexpr int kMostTrials = 20;      // finer samplings; the published loop has no end
constexpr double kLongest = 10.0;    // first guess, in horizons: no end of points for absurd ends

/// Time of a profile from rest to rest with a plateau of full speed.
double PlateauTime(double length, const EgoOptions& o) {
  const double ramps = o.max_speed * o.max_speed / o.max_acceleration;  // both, as a length
  if (ramps > length) return std::sqrt(length / o.max_acceleration);
  return (length - ramps) / o.max_speed + 2.0 * o.max_speed / o.max_acceleration;
}

/// A point off the middle of the way; the spread grows with the failures so far.
Eigen::Vector3d RandomMiddle(const EgoEnds& ends, EgoRandom* random, int failures) {
  const Eigen::Vector3d way = ends.p_end - ends.start.p;
  const Eigen::Vector3d across = way.cross(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d horizontal =
      across.norm() > 1e-9 ? across.normalized() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d vertical = way.cross(horizontal).normalized();
  const double k = 0.989 - 0.978 / (failures + 0.989);
  const double wide = random->Centred() * 0.8 * way.norm() * k;
  const double high = random->Centred() * 0.4 * way.norm() * k;
  return 0.5 * (ends.start.p + ends.p_end) + wide * horizontal + high * vertical;
}

/// Points at equal distances along a polyline, linearly interpolated, then `last`.
std::vector<Eigen::Vector3d> Resample(const std::vector<Eigen::Vector3d>& line, double step,
                                      const Eigen::Vector3d& last) {
  std::vector<Eigen::Vector3d> points;
  double passed = 0.0, next = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = (line[i + 1] - line[i]).norm();
    while (length > 0.0 && next <= passed + length) {
      points.push_back(line[i] + (next - passed) / length * (line[i + 1] - line[i]));
      next += step;
    }
    passed += length;
  }
  points.push_back(last);
  return points;
}

}  // namespace

double EgoRandom::Centred() {
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  return static_cast<double>(engine_() >> 11) * kUnit - 0.5;
}

double NominalInterval(const EgoOptions& options) {
  return 1.2 * options.control_point_distance / options.max_speed;
}

std::optional<SampledPath> PolynomialPath(const EgoEnds& ends, const EgoOptions& options,
                                          EgoRandom* random, int failures) {
  const SplineState end{ends.p_end, ends.v_end, Eigen::Vector3d::Zero()};
  const double T = PlateauTime((ends.p_end - ends.start.p).norm(), options);
  QuinticChain chain;
  if (random == nullptr) {
    chain.pieces.push_back(Quintic::Between(ends.start, end, T));
  } else {
    const Eigen::Vector3d middle = RandomMiddle(ends, random, failures);
    chain =
        QuinticChain::Through({ends.start.p, middle, end.p}, {0.5 * T, 0.5 * T}, ends.start, end);
  }

  const double most_points = kLongest * options.horizon / options.control_point_distance;
  SampledPath path;
  path.interval = kFinerBy * NominalInterval(options);
  for (int trial = 0; trial < kMostTrials; ++trial) {
    path.interval /= kFinerBy;
    path.points.clear();
    double widest = 0.0, last = 0.0;
    for (double t = 0.0; t < T; t += path.interval) {
      if (static_cast<double>(path.points.size()) > most_points) return std::nullopt;
      const Eigen::Vector3d p = chain.At(t).p;
      if (!path.points.empty()) widest = std::max(widest, (p - path.points.back()).norm());
      path.points.push_back(p);
      last = t;
    }
    if (widest > kWidestStep * options.control_point_distance) continue;
    if (static_cast<int>(path.points.size()) < kFewestPoints) continue;
    path.v_start = ends.start.v;
    path.a_start = ends.start.a;
    path.v_end = ends.v_end;
    path.a_end = chain.At(last).a;
    return path;
  }
  return std::nullopt;
}

std::optional<SampledPath> WarmPath(const UniformBspline& previous, double t, const EgoEnds& ends,
                                    const EgoOptions& options) {
  SampledPath path;
  path.interval = NominalInterval(options);
  std::vector<Eigen::Vector3d> line;
  for (double s = t; s <= previous.t_end(); s += path.interval) {
    line.push_back(previous.Evaluate(s).p_WB);
  }
  const FlatState end = previous.Evaluate(previous.t_end());
  const double T = 2.0 * (end.p_WB - ends.p_end).norm() / options.max_speed;
  if (T > path.interval) {
    const Quintic rest = Quintic::Between({end.p_WB, end.v_WB, end.a_WB},
                                          {ends.p_end, ends.v_end, Eigen::Vector3d::Zero()}, T);
    for (double s = path.interval; s < T; s += path.interval) line.push_back(rest.At(s).p);
  }
  const double most_points = 3.0 * options.horizon / options.control_point_distance;
  double step = kFinerBy * options.control_point_distance;
  for (int trial = 0; trial < kMostTrials && line.size() >= 2; ++trial) {
    step /= kFinerBy;
    path.points = Resample(line, step, ends.p_end);
    if (static_cast<int>(path.points.size()) < kFewestPoints) continue;
    if (static_cast<double>(path.points.size()) > most_points) return std::nullopt;
    const FlatState now = previous.Evaluate(t);
    path.v_start = now.v_WB;
    path.a_start = now.a_WB;
    path.v_end = ends.v_end;
    return path;
  }
  return std::nullopt;
}

}  // namespace touchdown::planning
