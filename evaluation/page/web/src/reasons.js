// SPDX-License-Identifier: BSD-3-Clause
// Why a mode began: the mission's own words, and what they mean.
export const REASONS = {
  pad_converged: "the pad is known well enough",
  align_timeout: "turning to the flight direction took too long",
  above_pad: "near the pad and slow over it",
  arriving: "contact is near and the landing condition holds",
  contact: "the feet stand on the deck",
  pad_lost: "the pad was not known well enough for too long",
  tags_lost: "the landing condition failed for too long, or too close to the deck",
  error_too_large: "the horizontal distance to the pad is too large",
  too_fast: "too fast relative to the pad",
  gust: "the wind tilts the vehicle too far",
  plan_failed: "there was no new plan for too long",
  no_contact: "contact did not come in time",
  climb_complete: "the vehicle is high enough above the pad again",
  climb_timeout: "the climb took too long",
  recovered: "there is a plan again, and the pad is known",
  invalid_input: "an input was not a number",
  emergency: "the emergency flag is set",
  emergency_cleared: "the emergency flag is cleared",
  own_state_lost: "the own state was unusable for too long",
  depth_lost: "no depth image came for too long",
};
