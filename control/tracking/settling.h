// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// How a vehicle comes to stand on the deck that its feet have touched.
struct SettlingParameters {
  double fade_time = 0.2;      ///< from flying to standing [s], > 0
  double return_time = 0.1;    ///< from standing to flying [s], > 0
  double thrust_share = 0.15;  ///< of the weight that the rotors carry then, in (0, 1) [-]
  double contact_gap = 0.2;    ///< a shorter loss of contact does not interrupt it [s], >= 0
};

/// Fades a tracking law's inputs from flight to standing while the feet touch: the vehicle stays
/// where it is, upright, on its weight. In wind it comes in leaning; stopped like that it would drop
/// from one pair of feet onto the other and roll over. Not to be shared between threads.
class Settling {
 public:
  /// Throws std::invalid_argument naming the first parameter out of its range.
  explicit Settling(const SettlingParameters& parameters = {});

  /// Notes at time t [s], rising, whether the feet touch what they are to stand on. A vehicle that does
  /// not land any more flies again, whatever touches.
  void Note(double t, bool touching, bool landing) noexcept;

  /// Share of standing at time t, not before that of the last note, in [0, 1]. Continuous.
  double Share(double t) const noexcept;

  /// Of the weight that the rotors carry at time t.
  double CarriedShare(double t) const noexcept {
    return 1.0 - Share(t) * (1.0 - parameters_.thrust_share);
  }

  /// Blends the law's inputs with those of standing at state.t; without contact nothing changes.
  void Apply(estimation::VehicleState* state, planning::FlatState* reference,
             Disturbance* disturbance) const noexcept;

 private:
  SettlingParameters parameters_;
  double t_ = 0.0;             ///< of the last note [s]
  double share_ = 0.0;         ///< then
  double rate_ = 0.0;          ///< of the share since then [1/s]
  double last_contact_ = 0.0;  ///< [s]
  bool stands_ = false;        ///< touches, or did until a moment ago
};

}  // namespace touchdown::control
