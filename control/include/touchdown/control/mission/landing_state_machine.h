// SPDX-License-Identifier: BSD-3-Clause
// The mission of one landing as a pure function: Step(state, inputs, parameters) -> state, outputs.
//
// clang-format off
//   from           to              reason             when
//   hovering       tracking        pad_converged      pad converged and heading aligned
//   hovering       tracking        align_timeout      pad converged, aligning took too long
//   tracking       landing         above_pad          descent vertical, near the pad, slow over it
//   tracking       landing         arriving           descent planned, the plan's contact is near,
//                                                     gate open, in the cone over the pad, no gust
//   tracking       hold            pad_lost           no converged pad for over pad_timeout
//   tracking       hold            plan_failed        no plan for over plan_timeout
//   tracking       hold            own_state_lost     own state not usable for over own_timeout
//   tracking       hold            depth_lost         no depth image for over depth_timeout
//   (lands)        disarmed        contact            feet at the deck with a force for contact_time,
//                                                     breaks up to contact_break allowed, and at last
//                                                     for contact_rest without a break
//   landing        go_around       pad_lost           no converged pad for over pad_timeout
//   landing        go_around       tags_lost          gate closed for over gate_timeout (descent
//                                                     planned: at all), or committed and the bridge
//                                                     is over
//   landing        go_around       error_too_large    horizontal error beyond abort_distance (descent
//                                                     planned: outside the cone)
//   landing        go_around       too_fast           committed, too fast relative to the pad
//   landing        go_around       gust               committed (descent planned: at all), and
//                                                     leans farther than lean_max
//   landing        go_around       plan_failed        no plan for over plan_timeout (descent
//                                                     planned: arrival_plan_timeout)
//   landing        go_around       no_contact         committed for over commit_timeout, or the
//                                                     plan's contact overdue by arrival_timeout, or
//                                                     postponed for so long
//   landing        tracking        looks              the planner goes to look, and nothing flown lands
//   landing        go_around       own_state_lost     own state not usable for over own_timeout
//   go_around      tracking        climb_complete     at the follow height, pad converged
//   go_around      tracking        climb_timeout      climbing took too long, or ends before, pad converged
//   go_around      hold            pad_lost           climb over or too long, no converged pad
//   go_around      hold            own_state_lost     climb over or too long, own state not usable
//   go_around      hold            depth_lost         climb over or too long, no depth image
//   hold           tracking        recovered          pad converged, depth images and a plan, for hold_time
//   (flying)       hold            invalid_input      not a number for over invalid_timeout
//   (armed)        emergency_stop  emergency          emergency flag
//   emergency_stop hold            emergency_cleared  flag down for over emergency_time
// clang-format on
//
// Contact counts in every mode in which the flown trajectory leads to it: a go-around without a
// certified trajectory ends on the deck. A foot may be so low over a known deck that a climb would
// come too late. Such a landing goes around for pad_lost, no_contact and own_state_lost only: it
// touches anyway, and would bounce off.
//
// (lands): landing, or any mode while `lands`. (flying): tracking, landing, go_around. (armed):
// every mode except disarmed. Disarmed is final, and only contact leads to it.
//
// A committed landing ends only by contact, an error beyond commit_abort_distance (or outside the
// cone), too_fast, gust, the end of the bridge before the feet touch, no_contact, own_state_lost,
// invalid_input or emergency. A pad counts as converged only while the vehicle's own state is
// usable. Dead reckoning closes the gate for own_patience, so that the vehicle waits during a short
// outage of position and velocity.
//
// The gate predicts whether the feet will meet the deck. It is open while the tags are seen and the
// pad is known well. Without tags it stays open if the rest of the way can be bridged. Then contact
// must be predicted within bridge_time of the last sighting, and the pad must still be known to
// bridge_sigma at contact. Without sightings neither improves. So a descent that pauses, or that
// lost the tags too high up, closes the gate. A committed descent is aborted if the bridge ends
// without contact.
//
// A vehicle that tilts farther than lean_max in a gust waits as it does at a closed gate. It gives
// up a landing before it touches: its hull would touch before its feet, or it would be blown off.
//
// With descent planned, tracking already flies a plan that ends in contact. The same gate decides decide_time before
// contact. If it is open, the landing begins. Else the vehicle arrives above the pad instead, and makes a new plan to
// contact from there once the gate is open.
#pragma once

#include <limits>
#include <string_view>

namespace touchdown::control {

enum class MissionMode {
  kHovering,
  kTracking,
  kLanding,
  kDisarmed,
  kHold,
  kGoAround,
  kEmergencyStop
};
std::string_view ToString(MissionMode mode);

/// Why a mode was left; kNone while it lasts.
enum class TransitionReason {
  kNone,
  kPadConverged,
  kAlignTimeout,
  kAbovePad,
  kArriving,
  kContact,
  kPadLost,
  kTagsLost,
  kErrorTooLarge,
  kTooFast,
  kGust,
  kPlanFailed,
  kNoContact,
  kClimbComplete,
  kClimbTimeout,
  kRecovered,
  kInvalidInput,
  kEmergency,
  kEmergencyCleared,
  kOwnStateLost,
  kDepthLost,
  kLooks,
};
std::string_view ToString(TransitionReason reason);

/// Whether the gate is open, and if not, why.
enum class Gate {
  kOpen,
  kOwnState,      ///< the own state is not usable, or something is not a number
  kNoPad,         ///< the pad was not found yet
  kTagsUnseen,    ///< its tags are not seen, and the rest of the way is too long for that
  kPadUncertain,  ///< it is not known well enough
  kGust,          ///< all is known, but the vehicle leans too far in the wind
};
std::string_view ToString(Gate gate);

/// Why the descent pauses; kNone while it goes on. kAbove: a planned one waits above the pad for the gate. kLook: the
/// vehicle goes to look.
enum class DescentHold { kNone, kGate, kCorridor, kLag, kAbove, kLook };
std::string_view ToString(DescentHold hold);

/// What the vehicle shall do.
enum class Guidance {
  kHoldPosition,  ///< brake and stay
  kFollowPad,     ///< arrive and stay above the pad at foot_height, moving with foot_height_rate
  kTouchDown,     ///< arrive at the deck, sinking with touchdown_rate
  kClimb,         ///< brake, then rise with foot_height_rate where it is, without a plan
  kIdle,          ///< rotors off
};
std::string_view ToString(Guidance guidance);

enum class DescentStyle {
  kNone,      ///< follow above the pad, never land
  kVertical,  ///< the paper's: approach above the pad, then descend over it
  kPlanned,   ///< one plan from wherever the vehicle is to contact
};

struct MissionInputs {
  double t = 0.0;                    ///< now [s], not decreasing
  bool pad_available = false;        ///< a pad estimate exists
  bool pad_converged = false;        ///< and is good enough to plan with
  double horizontal_distance = 0.0;  ///< vehicle to pad centre, estimated [m]
  double height = 0.0;               ///< feet above the deck, estimated [m]
  double foot_drop = 0.0;            ///< the lowest foot of a leaning vehicle, below `height` [m]
  double horizontal_speed = 0.0;     ///< relative to the pad, estimated [m/s]
  /// Towards the deck, estimated; of the reference, if that sinks faster [m/s].
  double sink_rate = 0.0;
  double pad_sigma = 0.0;            ///< horizontal 1 sigma of the pad's position [m], may be inf
  /// The same, predicted for ContactIn from now, without further measurements; may be inf.
  double contact_sigma = std::numeric_limits<double>::infinity();
  double tag_age = std::numeric_limits<double>::infinity();  ///< of the last sighting [s]
  bool own_fresh = true;    ///< own state runs on fresh measurements, else it is dead reckoning
  bool own_usable = true;   ///< own state is good enough to fly to the pad by
  double depth_age = 0.0;   ///< of the last depth image, or of the flight if none has come [s]
  double foot_force = 0.0;  ///< sum over the feet [N]
  bool has_plan = false;    ///< a certified plan exists
  bool looks = false;       ///< the vehicle flies to where it looks from, not to the pad
  bool lands =
      false;  ///< what is flown ends in contact, whatever the mode: nothing else was certified
  bool at_goal = false;  ///< the planner takes what was commanded as reached: no use to wait for it
  bool rests = false;    ///< it was to rest, and does: a climb comes no higher
  double plan_failed_for = 0.0;  ///< time since planning last succeeded, 0 if it did [s]
  /// Until the committed plan touches the deck [s], negative when that is overdue; infinite where it
  /// does not lead there.
  double arrival_in = std::numeric_limits<double>::infinity();
  double lean = 0.0;        ///< that holding still takes in the wind at contact [rad]
  bool yaw_aligned = true;  ///< body heading along the direction of travel
  bool emergency = false;   ///< obstacle too close, operator's stop, …
  DescentStyle descent = DescentStyle::kVertical;
};

struct MissionParameters {
  double follow_height = 1.5;  ///< feet above the deck while tracking [m]
  double align_timeout = 2.0;  ///< [s]

  double landing_distance = 0.5;  ///< tracking -> landing, the paper's figure [m]
  double landing_speed = 0.4;     ///< and the relative horizontal speed [m/s]

  double fast_rate = 0.5;             ///< descent above gate_height [m/s]
  double slow_rate = 0.3;             ///< descent below it [m/s] ...
  double contact_rate = 0.2;          ///< ... and at the deck, where gusts add to it [m/s], ...
  double contact_deceleration = 0.1;  ///< ... reached by so much [m/s^2]
  double climb_rate = 0.8;            ///< go-around [m/s]
  double height_acceleration = 1.0;   ///< of the commanded height [m/s^2]

  double gate_height = 1.0;      ///< no descent below it with the gate closed [m]
  double gate_sigma = 0.08;      ///< the gate is open at pad_sigma up to this [m] ...
  double gate_tag_age = 0.3;     ///< ... and tag_age up to this [s], or else if it can be bridged:
  double bridge_time = 2.6;      ///< last sighting to contact [s]
  double bridge_sigma = 0.19;    ///< contact_sigma up to this, by the size of the deck [m]
  double contact_reserve = 0.4;  ///< by which contact may be later than the commanded height [s]
  double gate_timeout = 3.0;     ///< closed for longer at the gate or below it: go around [s]
  double commit_height = 0.35;   ///< below it the descent goes on by prediction [m]
  double commit_timeout = 4.0;   ///< committed for longer without contact: go around [s]

  double corridor_radius = 0.12;       ///< horizontal error allowed at the deck [m] ...
  double corridor_slope = 0.35;        ///< ... and more by so much per metre of height [-]
  double abort_distance = 1.0;         ///< horizontal error that ends a landing [m]
  double commit_abort_distance = 0.5;  ///< the same below commit_height [m]

  double touchdown_rate = 0.3;        ///< with which a planned landing meets the deck in calm [m/s]
  double decide_time = 1.2;           ///< so long before contact it is decided on [s]
  double arrival_commit_time = 0.4;   ///< ... and from then on it goes on by prediction [s]
  double arrival_plan_timeout = 0.4;  ///< deciding and later: no plan for longer: go around [s]
  double arrival_timeout = 1.5;       ///< contact overdue for longer: go around [s]
  double turn_time = 0.2;             ///< until a new plan ends a planned descent [s] ...
  double climb_time = 0.2;            ///< ... and until a climb ends any [s], ...
  double turn_acceleration = 3.0;     ///< ... with so much [m/s^2]
  double contact_speed = 0.8;  ///< horizontal, relative: committed to contact no faster [m/s], ...
  double closing_rate = 4.0;   ///< ... or than can be taken off until it is due [m/s^2]
  double lean_max =
      1.5;  ///< leaning farther a vehicle waits for a lull before it descends to contact [rad]
  double cone_slope = 1.2;  ///< horizontal errors allowed grow by so much per metre of height [-]

  double height_lag = 0.15;       ///< the command waits for a vehicle higher than this above it [m]
  double press_depth = 0.3;       ///< the command goes this far below the deck until contact [m]
  double contact_force = 2.0;     ///< [N]
  double contact_time = 0.4;      ///< [s]: so long it takes to stand upright (settling.h)
  double contact_height = 0.15;   ///< |height| must be below it for contact to count [m] ...
  double contact_distance = 1.2;  ///< ... and the horizontal distance, by the size of the deck [m]
  double foothold = 0.57;         ///< horizontal distance at which all feet are over the deck [m]
  double contact_gap = 0.05;      ///< samples farther apart do not count as lasting contact [s]
  double contact_rest = 0.15;     ///< at the end of contact_time without a break [s]
  double contact_break = 0.2;     ///< feet that bounce lose it for so long without an end [s]

  double pad_timeout = 1.0;       ///< [s]
  double plan_timeout = 1.0;      ///< [s]
  double hold_time = 0.5;         ///< [s]
  double climb_timeout = 5.0;     ///< [s]
  double climb_tolerance = 0.25;  ///< of the follow height for climb_complete [m]
  double invalid_timeout = 0.2;   ///< [s]
  double own_timeout = 0.2;       ///< [s]
  double depth_timeout = 5.0;     ///< [s]
  double own_patience = 2.0;      ///< dead reckoning closes the gate for no longer [s]
  double emergency_time = 1.0;    ///< [s]
};

/// Throws std::invalid_argument naming the first parameter out of its range.
void Validate(const MissionParameters& parameters);

/// What the mission remembers. Start from MissionState{} and pass on what Step returns.
struct MissionState {
  MissionMode mode = MissionMode::kHovering;
  bool started = false;           ///< a valid time was seen
  double t = 0.0;                 ///< of the last step [s]
  double mode_since = 0.0;        ///< [s]
  double foot_height = 0.0;       ///< commanded, feet above the deck [m]
  double foot_height_rate = 0.0;  ///< its time derivative [m/s]
  bool committed = false;         ///< near the deck with the gate passed
  bool waits_above = false;       ///< descent planned: follows above the pad until the gate opens
  double committed_since = 0.0;   ///< [s]
  /// Times since when a condition has held without a break [s]; infinite while it does not.
  double converged_since = std::numeric_limits<double>::infinity();
  double pad_missing_since = std::numeric_limits<double>::infinity();
  double gate_closed_since = std::numeric_limits<double>::infinity();
  double contact_since = std::numeric_limits<double>::infinity();
  double touching_since = std::numeric_limits<double>::infinity();  ///< without a break
  double lifted_since = std::numeric_limits<double>::infinity();    ///< after a contact
  double recovered_since = std::numeric_limits<double>::infinity();
  double invalid_since = std::numeric_limits<double>::infinity();
  double own_lost_since = std::numeric_limits<double>::infinity();
  double own_stale_since = std::numeric_limits<double>::infinity();
  double calm_since = std::numeric_limits<double>::infinity();  ///< emergency flag down
};

struct MissionOutputs {
  MissionMode mode = MissionMode::kHovering;
  TransitionReason reason = TransitionReason::kNone;  ///< of the transition in this step
  DescentHold descent_hold = DescentHold::kNone;
  Gate gate = Gate::kNoPad;
  Guidance guidance = Guidance::kHoldPosition;
  bool motors_armed = true;
  bool plan_requested = false;  ///< planning to the pad makes sense now
  bool committed = false;
  /// Feet above the deck [m] and its rate [m/s]: the offset and the approach velocity of the plan's
  /// endpoint. Continuous in time, except at the beginning of a planned landing.
  double foot_height = 0.0;
  double foot_height_rate = 0.0;
};

struct MissionStep {
  MissionState state;
  MissionOutputs outputs;
};

/// Time until the feet are on the deck, at the latest, if nothing pauses the descent [s]. Vertical:
/// from the higher of the command and the vehicle's height, for heights up to gate_height. Planned:
/// the plan's time of contact. Uses descent, height and arrival_in of the inputs; infinite where
/// these are not finite.
double ContactIn(const MissionState& state, const MissionInputs& inputs,
                 const MissionParameters& parameters) noexcept;

/// One step. Pure: no hidden state, no exception, no allocation. Inputs that are not finite count
/// as missing and, if they last, lead to hold; they never disarm.
/// @pre Validate(parameters) passes.
MissionStep Step(const MissionState& state, const MissionInputs& inputs,
                 const MissionParameters& parameters) noexcept;

}  // namespace touchdown::control
