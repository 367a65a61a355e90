// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/list_option.h"

namespace touchdown::evaluation {

std::vector<std::string> ListEntries(const std::string& option,
                                     const std::vector<std::string>& lists) {
  std::vector<std::string> entries;
  for (const std::string& list : lists) {
    for (std::size_t from = 0; from <= list.size();) {
      const std::size_t to = std::min(list.find(',', from), list.size());
      if (to == from) {
        throw CLI::ValidationError(option, "an entry of the list '" + list + "' is empty");
      }
      entries.push_back(list.substr(from, to - from));
      from = to + 1;
    }
  }
  return entries;
}

}  // namespace touchdown::evaluation
