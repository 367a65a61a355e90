// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "evaluation/playground/point_flight.h"
#include "evaluation/playground/scene_step.h"

namespace touchdown::evaluation {

/// What the page talks to: questions and answers are JSON texts (docs/playground.md). One flight at a time. Not
/// thread-safe.
class Playground {
 public:
  /// Never throws: what is wrong with a question is its answer, {"error": "a sentence"}.
  std::string Ask(std::string_view question) noexcept;

 private:
  std::optional<PointFlight> flight_;
  struct Timed {
    std::string scene;
    std::unique_ptr<SceneStep> step;
  };
  std::map<std::string, Timed> timed_;  ///< [backend]: what was timed last with it
};

}  // namespace touchdown::evaluation
