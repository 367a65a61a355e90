// SPDX-License-Identifier: BSD-3-Clause
// How a term gets into a landing problem. A term's file writes an inner map (window_term.h), which
// may have
//
//     void Update(const LandingContext& context);   // before every solve; must not allocate
//
// and one function that returns its TermEntry. Everything else follows from the entry: the choice
// between cost and rows, the samples of the derivative checks, scenario keys and `touchdown list
// terms`. docs/adding_a_term.md shows whole examples.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"
#include "touchdown/solvers/problem/window_term.h"

namespace touchdown::planning {

/// One {p, v} pair of a control point: the half-space that keeps it off an obstacle.
struct ObstaclePair {
  int control_point = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();   ///< on the surface of the inflated obstacle [m]
  Eigen::Vector3d v = Eigen::Vector3d::UnitX();  ///< unit vector out of it
};

/// An ellipsoid along W's axes that moves at constant velocity.
struct MovingObstacle {
  double t_reference = 0.0;                        ///< when it is at p_WO [s]
  Eigen::Vector3d p_WO = Eigen::Vector3d::Zero();  ///< centre [m]
  Eigen::Vector3d v_WO = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d semi_axes = {0.5, 0.5, 0.5};     ///< > 0, the vehicle's own size included [m]
};

/// The data of one solve. What it points to outlives the solve.
struct LandingContext {
  int segments = 0;       ///< M
  SplineState start;      ///< at knot 0
  double t0 = 0.0;        ///< absolute time of knot 0 [s]
  double interval = 1.0;  ///< h, or the first guess of a free one [s]
  const estimation::PadPrediction* pad = &estimation::UnknownPad();  ///< never null
  EndpointTarget target;
  Limits limits;                                     ///< at most those of the TermSetup
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< steady force over the mass [m/s^2]
  const UniformBspline* previous = nullptr;          ///< plan to stay near to; may be null
  std::span<const MovingObstacle> obstacles;         ///< at most TermSetup::max_obstacles
  std::span<const ObstaclePair> pairs;               ///< at most TermSetup::max_pairs

  EndState End(double h) const { return EndStateAt(*pad, target, t0 + segments * h); }
};

/// A number that a term can be tuned by, beside its weight.
struct TermParameter {
  std::string name;
  double value = 0.0;  ///< default
  double lo = 0.0;
  double hi = 0.0;
  std::string help;  ///< meaning with its unit
};

/// Parameters that many terms share: where the hinge turns from cubic to quadratic, and the share of
/// a limit from which a soft term acts. Rows use neither.
TermParameter HingeWidth(double width, const std::string& unit);
TermParameter SoftMargin();

/// What a term is made from.
struct TermSetup {
  int control_points = 0;  ///< N
  double weight = 0.0;
  bool hard = false;                  ///< made as rows: at the full limit, without margin
  bool free_end_acceleration = true;  ///< else the last A_i and V_i follow from the end
  Limits limits;
  VehicleFacts vehicle;
  int max_pairs = 0;
  int max_obstacles = 0;
  std::vector<TermParameter> parameters;  ///< the entry's, with the values to use

  int segments() const { return control_points - 3; }
  /// Value of a parameter of the entry. Throws std::invalid_argument if it has none of that name.
  double Get(std::string_view name) const;
  /// The hinge of `weight` with the parameter `width`.
  solvers::HingeLoss Hinge() const { return solvers::HingeLoss(weight, Get("width")); }
};

/// When a landing problem can use a term at all. kMovingObstacles: only if LandingProblem is given
/// some, which flights do not do.
enum class TermUse { kAlways, kFreeArrival, kExplicitEndpoint, kMovingObstacles };

/// Where in W a term acts, for pictures.
struct TermZone {
  enum class Shape { kSphere, kBox, kCylinder };  ///< upright, along W's axes
  Shape shape = Shape::kSphere;
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d size = Eigen::Vector3d::Ones();      ///< from side to side along x, y and z [m]
};
struct NamedZone {
  std::string term;
  TermZone zone;
};
/// "sphere", "box" or "cylinder".
const char* ToString(TermZone::Shape shape);

/// An entry of a term registry.
struct TermEntry {
  solvers::TermInfo info;
  double default_weight = 0.0;            ///< 0: off unless asked for
  std::vector<TermParameter> parameters;  ///< with their defaults
  bool can_be_hard = true;                ///< its u can stand as rows
  bool is_limit = false;                  ///< where it is used it becomes rows with hard limits
  bool is_clearance = false;              ///< rounds that find the curve blocked press it harder
  TermUse use = TermUse::kAlways;
  std::function<std::vector<TermZone>(const TermSetup&)> zones;  ///< may be empty: it has none
  std::function<std::shared_ptr<solvers::Term>(const TermSetup&)> make;
};

/// What a user asks of one term. What is not set stays as the entry has it.
struct TermSettings {
  std::string name;
  std::optional<double> weight;  ///< > 0 switches a term on that is off by default, 0 off
  std::optional<bool> hard;
  std::vector<std::pair<std::string, double>> parameters;
};

/// A term that is informed of every solve before it begins, or whose weight can be raised.
class ContextUser {
 public:
  virtual ~ContextUser() = default;
  virtual void Update(const LandingContext& context) = 0;
  /// Multiplies the weight that it was made with.
  virtual void ScaleWeight(double factor) = 0;
};

template <class Inner>
concept UsesContext = requires(Inner& inner, const LandingContext& context) {
  inner.Update(context);
};

template <class Loss>
concept Scalable = requires(const Loss& loss) {
  { loss.Scaled(1.0) } -> std::same_as<Loss>;
};

/// A WindowTerm that hands the context to its inner map, and whose loss can be scaled.
template <class Inner, class Loss>
class ContextWindowTerm : public solvers::WindowTerm<Inner, Loss>, public ContextUser {
 public:
  ContextWindowTerm(const solvers::TermInfo& info, Inner inner, const Loss& loss, int max_windows)
      : solvers::WindowTerm<Inner, Loss>(info, std::move(inner), loss, max_windows), loss_(loss) {}

  void Update(const LandingContext& context) override {
    if constexpr (UsesContext<Inner>) this->inner().Update(context);
  }
  void ScaleWeight(double factor) override {
    if constexpr (Scalable<Loss>) this->set_loss(loss_.Scaled(factor));
  }

 private:
  Loss loss_;  // with the weight it was made with
};

/// The term of an inner map, told of every solve if the map has an Update. `max_windows`: the most
/// it can ever have.
template <class Inner, class Loss>
std::shared_ptr<solvers::Term> MakeLandingTerm(const solvers::TermInfo& info, Inner inner,
                                               const Loss& loss, int max_windows) {
  if constexpr (UsesContext<Inner> || Scalable<Loss>) {
    return std::make_shared<ContextWindowTerm<Inner, Loss>>(info, std::move(inner), loss,
                                                            max_windows);
  } else {
    return std::make_shared<solvers::WindowTerm<Inner, Loss>>(info, std::move(inner), loss,
                                                              max_windows);
  }
}

}  // namespace touchdown::planning
