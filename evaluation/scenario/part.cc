// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/part.h"

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

double PartSetup::Get(std::string_view key) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const Parameter& p) { return p.key == key; });
  if (found == parameters.end()) {
    throw std::invalid_argument("the part has no parameter " + std::string(key));
  }
  const auto given = scenario.parameters.find(found->key);
  return given == scenario.parameters.end() ? found->value : given->second;
}

}  // namespace touchdown::evaluation
