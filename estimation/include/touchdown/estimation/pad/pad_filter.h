// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include <Eigen/Core>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_motion_model.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::estimation {

enum class PadModel {
  kPaper,     ///< the paper's EKF: [Px, Py, V, phi] from [Px, Py, phi] (eq. 9-11)
  kTurnRate,  ///< [Px, Py, V, phi, omega]; GPS at every range, tags when seen
};

/// "paper" or "turn_rate". Throws std::invalid_argument for any other name.
PadModel PadModelFromName(std::string_view name);
std::string_view ToString(PadModel model);

/// What became of a measurement.
enum class PadUpdate {
  kInitialized,   ///< the first one, or the one that restarted a lost filter
  kAccepted,      ///< in time order
  kAcceptedLate,  ///< older than the newest one; the newer ones were processed again
  kGated,         ///< too unlikely; nothing changed but the count
  kTooOld,        ///< older than the buffer reaches
  kNotUsed,       ///< GPS in the paper's model while the tags guide (hand-over at 2 m)
  kInvalid,       ///< not finite, or a standard deviation out of range
};
std::string_view ToString(PadUpdate update);

/// A GPS fix with a smaller stated standard deviation, even zero, counts as this good: an exact
/// receiver must not make the covariance singular. [m]
inline constexpr double kLeastGpsSigma = 1e-3;

struct PadFilterOptions {
  PadModel model = PadModel::kTurnRate;
  double pad_height = 0.0;  ///< deck's upper face in W [m], constant (flat ground, section 3.1)
  PadNoise noise;

  double speed_prior = 1.5;      ///< 1 sigma of each velocity component at the start [m/s]
  double turn_rate_prior = 0.2;  ///< 1 sigma of omega when the heading becomes known [rad/s]
  /// Heading is read off the motion at this ratio of speed to its 1 sigma, above min_speed.
  double heading_significance = 2.5;
  /// kPaper measures the heading between fixes that lie this many of their 1 sigma apart. The fixes
  /// are then used twice, for the position too. Rare measurements keep the covariance consistent.
  double chord_significance = 5.0;
  double min_speed = 0.05;          ///< [m/s]
  double heading_lost_sigma = 0.7;  ///< back to kVelocity beyond this [rad]

  double gate_probability = 0.999;  ///< a good measurement passes with this probability
  /// If a sensor's measurements are gated twice in a row, the pad is assumed to manoeuvre. The
  /// belief is widened by these standard deviations, and the measurement is tried again.
  double maneuver_speed = 0.3;       ///< [m/s]
  double maneuver_heading = 0.2;     ///< [rad]
  double maneuver_turn_rate = 0.3;   ///< [rad/s]
  int restart_after = 5;             ///< consecutive gated measurements of one sensor
  double gps_restart_silence = 1.0;  ///< GPS restarts the filter only without tags for so long [s]
  double max_delay = 0.5;            ///< late measurements are taken up to this age [s]

  /// The vehicle's own pose enters a sighting with these standard deviations.
  double own_position_sigma = 0.0;  ///< [m]
  double own_attitude_sigma = 0.0;  ///< [rad]

  double hand_over_distance = 2.0;  ///< kPaper: tags nearer than this replace GPS [m] ...
  double hand_over_timeout = 0.5;   ///< ... until none was accepted for so long [s]

  double converged_position_sigma = 0.5;   ///< horizontal 1 sigma for converged() [m]
  double converged_velocity_sigma = 0.40;  ///< 1 sigma of the velocity for converged() [m/s]
};

/// Throws std::invalid_argument naming the first option out of its range.
void Validate(const PadFilterOptions& options);

/// Counts since the construction, and times of the last accepted measurements.
struct PadDiagnostics {
  int gps_accepted = 0;
  int gps_gated = 0;
  int tag_accepted = 0;
  int tag_gated = 0;
  int maneuvers = 0;  ///< beliefs widened
  int late_accepted = 0;
  int too_old = 0;
  int not_used = 0;
  int invalid = 0;
  int restarts = 0;
  double last_gps_t = -std::numeric_limits<double>::infinity();  ///< [s]
  double last_tag_t = -std::numeric_limits<double>::infinity();  ///< [s]
};

/// Extended Kalman filter of the landing pad's horizontal motion.
///
/// It starts in Cartesian velocity (PadMotion::kVelocity), so that a standing pad has no undefined heading. It turns to
/// the model's own state as soon as a tag shows the heading or the motion is significant. It turns back when the heading
/// is lost (standing for long without tags).
/// Measurements carry their own time stamps and may come late. A value type: copies are
/// independent. No call allocates after construction.
class PadFilter {
 public:
  /// Throws std::invalid_argument naming the first option out of its range.
  explicit PadFilter(const PadFilterOptions& options = {});

  /// The fix's standard deviation must not be negative; kLeastGpsSigma is the least that counts.
  PadUpdate AddGps(const PadGpsFix& fix);

  /// All standard deviations must be positive.
  /// `vehicle` is the vehicle's state at the sighting's time stamp.
  PadUpdate AddSighting(const PadSighting& sighting, const VehicleState& vehicle);

  /// True after the first measurement.
  bool initialized() const { return current_.initialized; }

  /// Position and velocity known within the options' converged_* figures at time t [s].
  bool Converged(double t) const;

  /// True while the heading is a state of the filter.
  bool heading_known() const {
    return current_.initialized && current_.belief.motion != PadMotion::kVelocity;
  }

  /// The belief at the last measurement. Meaningful once initialized().
  const PadBelief& belief() const { return current_.belief; }

  /// The belief carried to time t [s], and as a pad state. Meaningful once initialized().
  PadBelief BeliefAt(double t) const;
  PadState Estimate(double t) const;

  /// Largest horizontal 1 sigma of the position at time t [m]; infinite before the first fix.
  double PositionSigma(double t) const;

  /// Age of the last accepted sighting at time t [s]; infinite if there was none.
  double TagAge(double t) const;

  const PadDiagnostics& diagnostics() const { return current_.diagnostics; }
  const PadFilterOptions& options() const { return options_; }

 private:
  static constexpr int kHistory = 64;

  struct Measurement {
    double t = 0.0;
    bool is_tag = false;
    bool near = false;  ///< a tag nearer than the hand-over distance
    Eigen::Vector2d p_WP = Eigen::Vector2d::Zero();
    Eigen::Matrix2d cov_p = Eigen::Matrix2d::Zero();
    double yaw = 0.0;
    double yaw_variance = 0.0;
  };

  /// A past fix that the paper's heading from motion is measured from.
  struct HeadingAnchor {
    bool set = false;
    double t = 0.0;
    Eigen::Vector2d p_WP = Eigen::Vector2d::Zero();
    double variance = 0.0;
  };

  /// All that a measurement changes, so that a late one can be inserted by going back.
  struct Snapshot {
    bool initialized = false;
    PadBelief belief;
    PadDiagnostics diagnostics;
    int gps_gated_in_row = 0;
    int tag_gated_in_row = 0;
    double last_near_tag_t = -std::numeric_limits<double>::infinity();
    HeadingAnchor anchor;
  };

  struct Entry {
    Measurement measurement;
    Snapshot before;
  };

  PadUpdate Add(const Measurement& measurement);
  PadUpdate Insert(const Measurement& measurement);
  PadUpdate Process(const Measurement& measurement, Snapshot& state) const;
  void Restart(const Measurement& measurement, Snapshot& state) const;
  bool UpdateGps(const Measurement& measurement, Snapshot& state) const;
  bool UpdateTag(const Measurement& measurement, Snapshot& state) const;
  void WidenForManeuver(PadBelief& belief) const;
  void ChangeMotion(PadBelief& belief) const;

  PadFilterOptions options_;
  double gate_[4] = {0.0, 0.0, 0.0, 0.0};  ///< by degrees of freedom
  Snapshot current_;
  std::array<Entry, kHistory> history_;  ///< time-ordered, the newest last
  int history_size_ = 0;
};

}  // namespace touchdown::estimation
