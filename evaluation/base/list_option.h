// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchdown::evaluation {

/// The entries of lists with commas. The parser's own delimiter drops empty ones.
/// @throws CLI::ValidationError naming `option` where an entry is empty.
std::vector<std::string> ListEntries(const std::string& option,
                                     const std::vector<std::string>& lists);

/// An option that is a list: entries with commas between them, none empty and none twice, each as
/// `entry` asks. It replaces what `list` holds, which is shown as the default.
template <typename T>
CLI::Option* AddListOption(CLI::App& command, const std::string& name, std::vector<T>* list,
                           const std::string& help, const std::string& type,
                           const CLI::Validator& entry) {
  const auto read = [name, list, entry](const std::vector<std::string>& lists) {
    list->clear();
    for (const std::string& text : ListEntries(name, lists)) {
      T value;
      const std::string fault = entry(text);
      if (!fault.empty()) throw CLI::ValidationError(name, fault);
      if (!CLI::detail::lexical_cast(text, value)) throw CLI::ConversionError(text, name);
      if (std::find(list->begin(), list->end(), value) != list->end()) {
        throw CLI::ValidationError(name, text + " is given twice");
      }
      list->push_back(value);
    }
  };
  return command.add_option_function<std::vector<std::string>>(name, read, help)
      ->type_name(type)
      ->default_str(CLI::detail::join(*list, ","));
}

}  // namespace touchdown::evaluation
