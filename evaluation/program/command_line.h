// SPDX-License-Identifier: BSD-3-Clause
// What the commands say to the parser of the command line, CLI11. CLI11's header takes as long to compile as a command
// itself. So it is only declared here, and command_line.cc alone includes it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace touchdown::evaluation {

/// The allowed words of an option.
class Rule {
 public:
  explicit Rule(std::shared_ptr<const CLI::Validator> validator);
  const CLI::Validator& validator() const { return *validator_; }

 private:
  std::shared_ptr<const CLI::Validator> validator_;
};

Rule Range(int low, int high);
Rule Range(std::uint64_t low, std::uint64_t high);
/// Finite: CLI::Range lets NaN through.
Rule Range(double low, double high);
Rule OneOf(const std::vector<std::string>& words);
Rule AnyWord();

/// An option of a command, by reference.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option Check(const Rule& rule) const;
  Option ShowDefault() const;  ///< in the help: the variable's value now
  Option TypeName(const std::string& name) const;
  Option OneWord() const;  ///< each time it is given
  Option Required() const;
  Option Excludes(Option other) const;
  Option Needs(Option other) const;

 private:
  CLI::Option* option_;
};

/// A command with its options, by reference. The variables of options must outlive the parsing.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// `page` of docs/ ends its --help.
  Command AddCommand(const std::string& name, const std::string& help,
                     const std::string& page) const;
  void EndHelp(const std::string& page) const;  ///< of docs/
  void RequireCommand() const;                  ///< one of those that were added

  Option Add(const std::string& name, std::string& value, const std::string& help) const;
  Option Add(const std::string& name, std::vector<std::string>& value,
             const std::string& help) const;
  Option Add(const std::string& name, int& value, const std::string& help) const;
  Option Add(const std::string& name, std::optional<int>& value, const std::string& help) const;
  Option Add(const std::string& name, std::uint64_t& value, const std::string& help) const;
  Option Add(const std::string& name, double& value, const std::string& help) const;
  Option Add(const std::string& name, std::optional<double>& value, const std::string& help) const;
  void AddFlag(const std::string& name, bool& value, const std::string& help) const;
  /// A file; an empty name is refused. For one to write the command asks CheckOutputPath before it
  /// runs.
  Option AddFile(const std::string& name, std::string* path, const std::string& help,
                 const std::string& type) const;
  /// A list, see AddListOption.
  void AddList(const std::string& name, std::vector<int>* list, const std::string& help,
               const std::string& type, const Rule& entry) const;
  void AddList(const std::string& name, std::vector<double>* list, const std::string& help,
               const std::string& type, const Rule& entry) const;
  void AddList(const std::string& name, std::vector<std::string>* list, const std::string& help,
               const std::string& type, const Rule& entry) const;

  void OnChosen(std::function<void()> act) const;
  Option Find(const std::string& name) const;
  bool Given(const std::string& name) const;
  std::vector<std::string> Given() const;  ///< names of all options that were given

 private:
  CLI::App* app_;
};

}  // namespace touchdown::evaluation
