// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/replan_request.h"

namespace touchdown::evaluation {

const char* ToString(PredictionSource source) {
  switch (source) {
    case PredictionSource::kNone:
      return "none";
    case PredictionSource::kBelief:
      return "belief";
    case PredictionSource::kOracle:
      return "oracle";
  }
  return "unknown";
}

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
