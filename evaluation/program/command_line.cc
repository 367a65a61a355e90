// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/program/command_line.h"

#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "evaluation/base/list_option.h"
#include "evaluation/base/suggestion.h"

namespace touchdown::evaluation {

Rule::Rule(std::shared_ptr<const CLI::Validator> validator) : validator_(std::move(validator)) {}

namespace {

template <class Number>
Rule NumberIn(const char* type, const char* kind, Number low, Number high) {
  const std::string range = fmt::format("[{}, {}]", low, high);
  const auto check = [=](const std::string& text) {
    Number value = 0;
    const bool number = CLI::detail::lexical_cast(text, value);
    if (number && value >= low && value <= high) return std::string();
    return fmt::format("{} is {} {}", text, number ? "not in" : kind, range);
  };
  return Rule(
      std::make_shared<CLI::Validator>(check, fmt::format("{} in [{} - {}]", type, low, high)));
}

}  // namespace

Rule Range(int low, int high) { return NumberIn("INT", "no whole number in", low, high); }

Rule Range(std::uint64_t low, std::uint64_t high) {
  return NumberIn("UINT", "no whole number in", low, high);
}

Rule Range(double low, double high) { return NumberIn("FLOAT", "not a number in", low, high); }

Rule OneOf(const std::vector<std::string>& words) {
  const CLI::IsMember member(words);
  const auto check = [=](const std::string& text) {
    const std::string fault = member(text);
    return fault.empty() ? fault : fault + DidYouMean(text, words);
  };
  return Rule(std::make_shared<CLI::Validator>(check, member.get_description()));
}

Rule AnyWord() { return Rule(std::make_shared<CLI::Validator>()); }

Option Option::Check(const Rule& rule) const {
  option_->check(rule.validator());
  return *this;
}

Option Option::ShowDefault() const {
  option_->capture_default_str();
  return *this;
}

Option Option::TypeName(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::OneWord() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::Required() const {
  option_->required();
  return *this;
}

Option Option::Excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::Needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

void Command::EndHelp(const std::string& page) const { app_->footer("To read: docs/" + page); }

Command Command::AddCommand(const std::string& name, const std::string& help,
                            const std::string& page) const {
  const Command command(app_->add_subcommand(name, help));
  command.EndHelp(page);
  return command;
}

void Command::RequireCommand() const { app_->require_subcommand(1); }

Option Command::Add(const std::string& name, std::string& value, const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, std::vector<std::string>& value,
                    const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, int& value, const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, std::optional<int>& value,
                    const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, std::uint64_t& value, const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, double& value, const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

Option Command::Add(const std::string& name, std::optional<double>& value,
                    const std::string& help) const {
  return Option(app_->add_option(name, value, help));
}

void Command::AddFlag(const std::string& name, bool& value, const std::string& help) const {
  app_->add_flag(name, value, help);
}

Option Command::AddFile(const std::string& name, std::string* path, const std::string& help,
                        const std::string& type) const {
  const auto named = [](const std::string& text) {
    return std::string(text.empty() ? "no file is named" : "");
  };
  return Option(app_->add_option(name, *path, help)->type_name(type)->check(named));
}

void Command::AddList(const std::string& name, std::vector<int>* list, const std::string& help,
                      const std::string& type, const Rule& entry) const {
  AddListOption(*app_, name, list, help, type, entry.validator());
}

void Command::AddList(const std::string& name, std::vector<double>* list, const std::string& help,
                      const std::string& type, const Rule& entry) const {
  AddListOption(*app_, name, list, help, type, entry.validator());
}

void Command::AddList(const std::string& name, std::vector<std::string>* list,
                      const std::string& help, const std::string& type, const Rule& entry) const {
  AddListOption(*app_, name, list, help, type, entry.validator());
}

void Command::OnChosen(std::function<void()> act) const { app_->callback(std::move(act)); }

Option Command::Find(const std::string& name) const { return Option(app_->get_option(name)); }

bool Command::Given(const std::string& name) const { return app_->count(name) > 0; }

std::vector<std::string> Command::Given() const {
  std::vector<std::string> names;
  const CLI::App& app = *app_;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

}  // namespace touchdown::evaluation
