// SPDX-License-Identifier: BSD-3-Clause
// Why a mode began: the mission's own words, and what they mean.
export const REASONS = {
  pad_converged: "the pad is known well enough",
  align_timeout: "turning towards its way took too long",
  above_pad: "near the pad and slow over it",
  arriving: "contact is near and the gate is open",
  contact: "the feet stand on the deck",
  pad_lost: "the pad was not known well enough for too long",
  tags_lost: "the gate was closed for too long, or too close to the deck",
  error_too_large: "too far beside the pad",
  too_fast: "the pad moves otherwise than foretold",
  gust: "it leans too far in the wind",
  plan_failed: "there was no new plan for too long",
  no_contact: "contact did not come in time",
  climb_complete: "high enough above the pad again",
  climb_timeout: "the climb took too long",
  recovered: "there is a plan and a known pad again",
  invalid_input: "something was not a number",
  emergency: "the emergency flag is up",
  emergency_cleared: "the emergency flag is down again",
  own_state_lost: "the own state was not usable for too long",
};
