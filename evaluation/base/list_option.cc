// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/list_option.h"

#include <utility>

#include "evaluation/base/words.h"

namespace touchdown::evaluation {

std::vector<std::string> ListEntries(const std::string& option,
                                     const std::vector<std::string>& lists) {
  std::vector<std::string> entries;
  for (const std::string& list : lists) {
    for (std::string& entry : Split(list, ',')) {
      if (entry.empty()) {
        throw CLI::ValidationError(option, "an entry of the list '" + list + "' is empty");
      }
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

}  // namespace touchdown::evaluation
