// SPDX-License-Identifier: BSD-3-Clause
// Enumerations are words in Python, those of the program's files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/control/onboard/taken.h"
#include "touchdown/estimation/own_state/own_state_options.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/problem/term_check.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::binding {

/// All words that `ToString` knows, up to the last value.
template <class E>
std::vector<std::string> WordsUpTo(E last) {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    words.emplace_back(ToString(static_cast<E>(i)));
  }
  return words;
}

/// The words of an enumeration whose values are 0, 1, ...
template <class E>
struct Words;

}  // namespace touchdown::binding

namespace pybind11::detail {

/// An enumeration that has words.
template <class E>
struct word_caster {
  using Words = touchdown::binding::Words<E>;
  PYBIND11_TYPE_CASTER(E, Words::kName);

  bool load(handle source, bool /*convert*/) {
    if (!isinstance<str>(source)) return false;
    const auto word = source.cast<std::string>();
    std::string known;
    const std::vector<std::string> words = Words::List();
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == word) {
        value = static_cast<E>(i);
        return true;
      }
      known.append(i == 0 ? "" : ", ").append(words[i]);
    }
    throw value_error("\"" + word + "\" is not among " + known);
  }
  static handle cast(E source, return_value_policy /*policy*/, handle /*parent*/) {
    return str(Words::List().at(static_cast<std::size_t>(source))).release();
  }
};

}  // namespace pybind11::detail

#define TOUCHDOWN_WORDS(type, name, ...)                              \
  template <>                                                         \
  struct touchdown::binding::Words<touchdown::type> {                 \
    static constexpr auto kName = pybind11::detail::const_name(name); \
    static std::vector<std::string> List() { return __VA_ARGS__; }    \
  };                                                                  \
  template <>                                                         \
  struct pybind11::detail::type_caster<touchdown::type>               \
      : pybind11::detail::word_caster<touchdown::type> {}

TOUCHDOWN_WORDS(solvers::SolveStatus, "SolveStatus",
                WordsUpTo(touchdown::solvers::SolveStatus::kNumericalFailure));
TOUCHDOWN_WORDS(solvers::Role, "Role", {"cost", "rows"});
TOUCHDOWN_WORDS(planning::ArrivalMode, "ArrivalMode", {"fixed", "free"});
TOUCHDOWN_WORDS(planning::EndpointMode, "EndpointMode", {"eliminated", "explicit"});
TOUCHDOWN_WORDS(planning::LimitsMode, "LimitsMode", {"soft", "hard"});
TOUCHDOWN_WORDS(planning::CheckedView, "CheckedView", {"full", "reduced", "whitened"});
TOUCHDOWN_WORDS(planning::CheckedPoint, "CheckedPoint", {"random", "zero", "active"});
TOUCHDOWN_WORDS(planning::ReplanStatus, "ReplanStatus",
                WordsUpTo(touchdown::planning::ReplanStatus::kUnsafe));
TOUCHDOWN_WORDS(planning::ReplanReason, "ReplanReason",
                WordsUpTo(touchdown::planning::ReplanReason::kAtGoal));
TOUCHDOWN_WORDS(planning::CellState, "CellState", {"unknown", "free", "occupied"});
TOUCHDOWN_WORDS(control::MissionMode, "MissionMode",
                WordsUpTo(touchdown::control::MissionMode::kEmergencyStop));
TOUCHDOWN_WORDS(control::TransitionReason, "TransitionReason",
                WordsUpTo(touchdown::control::TransitionReason::kDepthLost));
TOUCHDOWN_WORDS(control::Gate, "Gate", WordsUpTo(touchdown::control::Gate::kGust));
TOUCHDOWN_WORDS(control::DescentHold, "DescentHold",
                WordsUpTo(touchdown::control::DescentHold::kAbove));
TOUCHDOWN_WORDS(control::DescentStyle, "DescentStyle", {"none", "vertical", "planned"});
TOUCHDOWN_WORDS(control::Taken, "Taken", WordsUpTo(touchdown::control::Taken::kUnasked));
TOUCHDOWN_WORDS(estimation::OwnStatus, "OwnStatus",
                WordsUpTo(touchdown::estimation::OwnStatus::kImuStale));

#undef TOUCHDOWN_WORDS

namespace touchdown::binding {

/// Every enumeration, by its name in Python.
inline std::map<std::string, std::vector<std::string>> AllWords() {
  return {
      {"SolveStatus", touchdown::binding::Words<touchdown::solvers::SolveStatus>::List()},
      {"Role", touchdown::binding::Words<touchdown::solvers::Role>::List()},
      {"ArrivalMode", touchdown::binding::Words<touchdown::planning::ArrivalMode>::List()},
      {"EndpointMode", touchdown::binding::Words<touchdown::planning::EndpointMode>::List()},
      {"LimitsMode", touchdown::binding::Words<touchdown::planning::LimitsMode>::List()},
      {"CheckedView", touchdown::binding::Words<touchdown::planning::CheckedView>::List()},
      {"CheckedPoint", touchdown::binding::Words<touchdown::planning::CheckedPoint>::List()},
      {"ReplanStatus", touchdown::binding::Words<touchdown::planning::ReplanStatus>::List()},
      {"ReplanReason", touchdown::binding::Words<touchdown::planning::ReplanReason>::List()},
      {"CellState", touchdown::binding::Words<touchdown::planning::CellState>::List()},
      {"MissionMode", touchdown::binding::Words<touchdown::control::MissionMode>::List()},
      {"TransitionReason", touchdown::binding::Words<touchdown::control::TransitionReason>::List()},
      {"Gate", touchdown::binding::Words<touchdown::control::Gate>::List()},
      {"DescentHold", touchdown::binding::Words<touchdown::control::DescentHold>::List()},
      {"DescentStyle", touchdown::binding::Words<touchdown::control::DescentStyle>::List()},
      {"Taken", touchdown::binding::Words<touchdown::control::Taken>::List()},
      {"OwnStatus", touchdown::binding::Words<touchdown::estimation::OwnStatus>::List()},
  };
}

}  // namespace touchdown::binding
