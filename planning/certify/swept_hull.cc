// SPDX-License-Identifier: BSD-3-Clause
// The hull's tube through the observed-free cells. The hull at every tilt is a ball, and so is the hull grown by its
// margins. Balls larger by kSweepRoom are placed along the curve, so that two consecutive ones contain what the hull
// sweeps between them. The cells that a ball touches are tested row by row, 64 along x at a time. The surroundings of
// most tubes are free: a box that contains several balls is tested first.

#include "touchdown/planning/certify/swept_hull.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "planning/certify/start_cells.h"
#include "planning/spline/fastest_leg.h"
#include "touchdown/planning/map/cell_box.h"
#include "touchdown/planning/map/pad_outline.h"

namespace touchdown::planning {

namespace {

constexpr double kStep =
    0.01;  // between looks at the position, at most [s]; a bend of 10 m/s^2 is 0.1 mm off
constexpr double kAhead =
    0.25;  // the box of free cells is to reach the ball that comes so much later [s]
constexpr double kRounding = 1e-9;  // of heights of cells and deck [m]
constexpr double kFaceRange = 1.5;  // the deck was looked at from so far, about, at last [m]
constexpr double kFaceSlack = 0.02;  // of feet that are about to meet the deck [m]
constexpr double kLevel = 2e-3;  // rounding of floor and ceiling: kChordSagitta [m]

/// Positions along a curve. A piece of it costs less as a whole than position by position. Past its end the curve
/// goes on at its end's velocity.
class Path {
 public:
  explicit Path(const UniformBspline& curve)
      : curve_(curve),
        t_end_(curve.t_end()),
        per_second_(1.0 / curve.interval()),
        last_(curve.segments() - 1) {}

  Eigen::Vector3d At(double t) {
    if (t > t_end_) return curve_.EvaluateOnward(t).p_WB;
    const double s = std::max(0.0, (t - curve_.t0()) * per_second_);
    const int piece = std::min(static_cast<int>(s), last_);
    if (piece != piece_) Enter(piece);
    const double u = s - piece;
    return c0_ + u * (c1_ + u * (c2_ + u * c3_));
  }

 private:
  void Enter(int piece) {
    piece_ = piece;
    const Eigen::Map<const ControlPoints> q = curve_.control_points();
    const auto q0 = q.col(piece), q1 = q.col(piece + 1), q2 = q.col(piece + 2);
    c0_ = (q0 + 4.0 * q1 + q2) / 6.0;
    c1_ = (q2 - q0) / 2.0;
    c2_ = (q0 - 2.0 * q1 + q2) / 2.0;
    c3_ = (q.col(piece + 3) - 3.0 * q2 + 3.0 * q1 - q0) / 6.0;
  }

  const UniformBspline& curve_;
  const double t_end_, per_second_;
  const int last_;
  int piece_ = -1;
  Eigen::Vector3d c0_, c1_, c2_, c3_;  // of the piece as a polynomial in u
};

/// The positions since the last ball. Two balls must contain the hull at all of them.
///
/// A hull of radius r midway between two balls that are g apart is in their union if these are larger by g^2 / 8 r.
/// One that is e off the line between them needs e more. The axis is the direction in which the path left the first
/// ball. Positions within e / 2 of it are within e of that line, wherever on the path the second ball is.
class Stretch {
 public:
  explicit Stretch(double radius) : radius_(radius) {}

  void Begin(const Eigen::Vector3d& ball) {
    ball_ = ball;
    axis_.setZero();
    away2_ = off2_ = 0.0;
  }

  /// Adds a position, unless balls at the beginning and there would not contain what is between.
  bool Add(const Eigen::Vector3d& p) {
    const Eigen::Vector3d way = p - ball_;
    const double away2 = way.squaredNorm();
    if (away2 < away2_) return false;  // turned back: it was at its farthest just before
    // So near, the first ball contains the hull alone, whatever the axis will be.
    if (away2 > kOwn * kOwn && axis_.isZero(0.0)) axis_ = way / std::sqrt(away2);
    const double off2 = std::max(off2_, (way - way.dot(axis_) * axis_).squaredNorm());
    if (2.0 * std::sqrt(off2) + away2 / (8.0 * radius_) > kSweepRoom) return false;
    away2_ = away2;
    if (!axis_.isZero(0.0)) off2_ = off2;
    return true;
  }

 private:
  static constexpr double kOwn = 0.45 * kSweepRoom;

  double radius_;
  Eigen::Vector3d ball_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();  // zero: the way has not left the ball
  double away2_ = 0.0, off2_ = 0.0;                 // largest, of the places since the ball
};

class Tube {
 public:
  Tube(const HullSpace& hull, const HullStart& start)
      : hull_(hull),
        map_(*hull.space->map),
        start_(start.p_W),
        radius_(hull.radius() + kSweepRoom),
        face_noise_(OccupancyMap::kNoiseSigmas * map_.options().range_noise * kFaceRange +
                    kRounding),
        first_above_ground_(Index(map_.options().ground_height + kRounding)),
        start_deck_(DeckBelow(start.p_W, start.t)) {}

  /// The ball at p is in the box that was found free last.
  bool InFreeBox(const Eigen::Vector3d& p) const {
    return (p.array() >= free_from_.array()).all() && (p.array() <= free_to_.array()).all();
  }

  /// Makes it the box around the balls at p and at `ahead`, if all of it was observed free.
  bool FindFreeBox(const Eigen::Vector3d& p, const Eigen::Vector3d& ahead) {
    CellBox box = BoxAround(p);
    const CellBox there = BoxAround(ahead);
    box = {box.low.cwiseMin(there.low), box.high.cwiseMax(there.high)};
    const bool is_free = AllFree(box);
    const double inside = radius_ + kRounding;
    free_from_ = (box.low.cast<double>() * map_.resolution()).array() + inside;
    if (box.low.z() == first_above_ground_) {
      free_from_.z() = -std::numeric_limits<double>::infinity();
    }
    free_to_ = (box.high.cast<double>() * map_.resolution()).array() - inside;
    if (!is_free) free_to_.setConstant(-std::numeric_limits<double>::infinity());
    return is_free;
  }

  /// Whether all cells that the ball at p touches at time t are observed free, or excepted.
  bool Holds(const Eigen::Vector3d& p, double t, Sweep* sweep) const {
    const CellBox box = BoxAround(p);
    const double cell = map_.resolution();
    const bool has_rows = HasRows(box);
    const Deck deck = DeckBelow(p, t);
    for (int z = box.low.z(); z < box.high.z(); ++z) {
      if ((z + 1) * cell <= deck.exempt_below + kRounding) continue;
      const bool holds_deck = HoldsFace(z, deck);
      const double dz = Gap(p.z(), z, cell);
      const double left = radius_ * radius_ - dz * dz;
      if (left <= 0.0) continue;
      const double reach = std::sqrt(left);
      const int y_high = Index(p.y() + reach);
      for (int y = Index(p.y() - reach); y <= y_high; ++y) {
        // Most rows are free beyond the ball, too.
        if (has_rows && RowIsFree(box, y, z)) continue;
        const double dy = Gap(p.y(), y, cell);
        const double half2 = left - dy * dy;
        if (half2 <= 0.0) continue;
        const double half = std::sqrt(half2);
        const int x_low = Index(p.x() - half), x_high = Index(p.x() + half);
        const Deck* surface = holds_deck ? &deck : nullptr;
        if (!RowHolds({x_low, y, z}, x_high - x_low + 1, p, surface, sweep)) return false;
      }
    }
    return true;
  }

 private:
  int Index(double x) const { return static_cast<int>(std::floor(x / map_.resolution())); }

  /// All cells that the ball may touch, except those that are ground.
  CellBox BoxAround(const Eigen::Vector3d& p) const {
    const CellIndex low(Index(p.x() - radius_), Index(p.y() - radius_),
                        std::max(Index(p.z() - radius_), first_above_ground_));
    const CellIndex last(Index(p.x() + radius_), Index(p.y() + radius_), Index(p.z() + radius_));
    return {low, last + CellIndex::Ones()};
  }

  /// The box's rows can be read as a whole.
  bool HasRows(const CellBox& box) const {
    return box.high.x() - box.low.x() <= 64 && map_.InWindow(box.low) &&
           map_.InWindow(box.high - CellIndex::Ones());
  }

  bool RowIsFree(const CellBox& box, int y, int z) const {
    const int count = box.high.x() - box.low.x();
    return map_.ObservedFreeRow({box.low.x(), y, z}, count) == ~std::uint64_t{0} >> (64 - count);
  }

  bool AllFree(const CellBox& box) const {
    if (!HasRows(box)) return false;
    for (int z = box.low.z(); z < box.high.z(); ++z) {
      for (int y = box.low.y(); y < box.high.y(); ++y) {
        if (!RowIsFree(box, y, z)) return false;
      }
    }
    return true;
  }

  /// The deck below the ball.
  struct Deck {
    PadOutline outline;
    bool over = false;          ///< the body is over it, wherever it may be
    double exempt_below = 0.0;  ///< cells whose upper face is no higher are excepted [m]
  };
  Deck DeckBelow(const Eigen::Vector3d& p, double t) const {
    Deck deck;
    deck.exempt_below = map_.options().ground_height;
    if (hull_.pad == nullptr) return deck;
    const double top = hull_.pad->MeanAt(t).p_WP.z();
    const double highest = top + face_noise_ + map_.resolution();  // of cells that hold its face
    if (p.z() - radius_ >= highest) return deck;
    deck.outline = OutlineOf(hull_.pad->At(t), hull_.deck_half_size);
    deck.over = deck.outline.SurelyOver(p);
    if (deck.over) deck.exempt_below = std::max(deck.exempt_below, top);
    return deck;
  }

  /// Cells of this level over the deck are where its returns lie.
  bool HoldsFace(int z, const Deck& deck) const {
    return deck.over && z * map_.resolution() <= deck.outline.p_WP.z() + face_noise_;
  }

  /// What a ray met in this cell was the deck, unless it is occupied.
  bool IsFace(const CellIndex& cell, const Deck& deck) const {
    return DistanceBeside(deck.outline, map_.CentreOf(cell)) <= 0.0 && !map_.IsOccupied(cell);
  }

  /// `surface`: the deck whose face cells of this row hold.
  bool RowHolds(const CellIndex& first, int count, const Eigen::Vector3d& p, const Deck* surface,
                Sweep* sweep) const {
    CellIndex at = first;
    for (int left = count; left > 0;) {
      const int n = std::min(left, 64);
      if (!map_.InWindow(at) || !map_.InWindow(at + CellIndex(n - 1, 0, 0))) {
        return Unseen(at, sweep);
      }
      const std::uint64_t all = ~std::uint64_t{0} >> (64 - n);
      std::uint64_t missing = ~map_.ObservedFreeRow(at, n) & all;
      for (; missing != 0; missing &= missing - 1) {
        const CellIndex cell = at + CellIndex(std::countr_zero(missing), 0, 0);
        if (hull_.unseen_passes && !map_.IsOccupied(cell)) continue;
        if (surface != nullptr && IsFace(cell, *surface)) continue;
        if (!WasThere(cell, start_, p, radius_, map_.resolution())) {
          return Unseen(cell, sweep);
        }
        // The deck may have driven on: where it was nothing else is.
        if (HoldsFace(cell.z(), start_deck_) && IsFace(cell, start_deck_)) continue;
        // What only the room between two balls reaches into is not in the grown hull.
        const double at_start = DistanceTo(cell, start_, map_.resolution());
        if (at_start < hull_.hull_radius - kNoNearer) {
          const bool occupied = map_.IsOccupied(cell);
          sweep->start.occupied |= occupied;
          sweep->start.unknown |= !occupied && !hull_.start_proven;
        }
        sweep->start.narrow |= at_start < hull_.radius() - kNoNearer;
      }
      left -= n;
      at.x() += n;
    }
    return true;
  }

  bool Unseen(const CellIndex& cell, Sweep* sweep) const {
    sweep->unseen_W = map_.CentreOf(cell);
    return false;
  }

  const HullSpace& hull_;
  const OccupancyMap& map_;
  Eigen::Vector3d start_;
  double radius_;
  double face_noise_;                                    // of returns from the deck [m]
  int first_above_ground_;                               // level of cells
  Eigen::Vector3d free_from_ = Eigen::Vector3d::Ones();  // of balls in a box of free cells [m]
  Eigen::Vector3d free_to_ = Eigen::Vector3d::Zero();    // ... none yet
  Deck start_deck_;                                      // below the start, when it was there
};

/// Whether the feet are no more than `below` the deck [m] as far as the hull may be over it. Close over it they may
/// move [m/s] no faster than they may touch it. A start that is so close already is exempt.
bool AboveDeck(const HullSpace& hull, const Eigen::Vector3d& p, double t, const Eigen::Vector3d& v,
               double below, const Eigen::Vector3d& start) {
  if (hull.pad == nullptr || p.z() >= start.z() - kRounding) return true;
  const estimation::PadState pad = hull.pad->MeanAt(t);
  const double deck_feet = pad.p_WP.z() + hull.foot_depth, above = p.z() - deck_feet;
  const Eigen::Vector3d v_PB = v - pad.v_WP;
  const bool softly = IsSoft(v_PB, kLandingRoom);
  if (above >= kFootLowers || (above >= -below && (softly || start.z() < deck_feet + kFootLowers)))
    return true;
  const PadOutline deck = OutlineOf(hull.pad->At(t), hull.deck_half_size);
  return DistanceBeside(deck, p) > hull.radius() + PadOutline::kSigmas * deck.sigma;
}

/// Whether p is between floor and ceiling. A vehicle that starts beyond one of them must not go farther. Where the
/// deck may be touched it is the floor itself.
bool LevelKept(const FreeSpace& space, const Eigen::Vector3d& p, const Eigen::Vector3d& start,
               bool may_touch) {
  const double ceiling = std::max(space.ceiling, start.z());
  if (p.z() > ceiling + kLevel) return false;
  const double above_both = std::max(space.floor, space.pad_floor);
  if (p.z() >= std::min(above_both, start.z()) - kLevel) return true;
  if (may_touch && space.OverPad(p)) return true;
  return p.z() >= std::min(space.FloorAt(p), start.z()) - kLevel;
}

}  // namespace

Sweep SweepHull(const UniformBspline& curve, double t_from, double t_to, const HullStart& start,
                const HullSpace& hull, double t_contact) {
  Sweep sweep;
  Tube tube(hull, start);
  Path path(curve), ahead(curve);
  // A hull thinner than kSweepRoom counts as half of it: two such balls contain as much at least.
  const double radius = std::max(hull.radius(), 0.5 * kSweepRoom);
  Stretch stretch(radius);
  Eigen::Vector3d before = start.p_W, v = curve.EvaluateOnward(t_from).v_WB;
  double t_before = t_from;
  const double below = std::isfinite(t_contact) ? kFaceSlack : 0.0;
  const auto holds = [&](const Eigen::Vector3d& p, double t) {
    return tube.InFreeBox(p) || tube.FindFreeBox(p, ahead.At(std::min(t + kAhead, t_to))) ||
           tube.Holds(p, t, &sweep);
  };
  // One step is a stretch that two balls hold.
  const double longest = std::sqrt(8.0 * radius * kSweepRoom);
  const double step = std::min(kStep, 0.9 * longest / std::max(FastestLeg(curve), 1e-9));
  const int steps = std::max(1, static_cast<int>(std::ceil((t_to - t_from) / step)));
  for (int i = 0; i <= steps; ++i) {
    const double t = t_from + (t_to - t_from) * i / steps;
    const Eigen::Vector3d p = path.At(t);
    const bool may_touch = t >= t_contact;
    if (!LevelKept(*hull.space, p, start.p_W, may_touch)) return sweep;
    if (t > t_before) v = (p - before) / (t - t_before);
    if (!may_touch && !AboveDeck(hull, p, t, v, below, start.p_W)) return sweep;
    if (i == 0) stretch.Begin(p);
    if (!stretch.Add(p)) {
      if (!holds(before, t_before)) return sweep;
      stretch.Begin(before);
      stretch.Add(p);
    }
    if ((i == 0 || i == steps) && !holds(p, t)) return sweep;
    before = p;
    t_before = t;
  }
  sweep.proven = true;
  return sweep;
}

}  // namespace touchdown::planning
