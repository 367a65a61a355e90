// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/replan_request.h"

namespace touchdown::evaluation {

const char* ToString(estimation::PadMotion motion) {
  switch (motion) {
    case estimation::PadMotion::kVelocity:
      return "velocity";
    case estimation::PadMotion::kHeading:
      return "heading";
    case estimation::PadMotion::kTurn:
      return "turn";
  }
  return "unknown";
}

}  // namespace touchdown::evaluation
