// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/report/interpreter.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "evaluation/base/child_program.h"

namespace touchdown::evaluation {
namespace {

// Nothing is imported: that would take a second. A mere folder with a package's name, for example in the working
// directory, has no origin.
constexpr char kQuestion[] =
    "import importlib.util as u, sys\n"
    "origin = lambda package: getattr(u.find_spec(package), 'origin', None)\n"
    "print('lacks', *[package for package in sys.argv[1:] if origin(package) is None])\n";
constexpr std::string_view kAnswer = "lacks";

// An empty variable counts as not set.
std::string Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// "python3.12" is looked for on PATH, as a shell does.
std::string AsShell(const std::string& program) {
  if (program.find('/') != std::string::npos) return program;
  const std::string found = FindOnPath(program);
  return found.empty() ? program : found;
}

std::string InEnvironment(const std::string& folder) {
  const std::string python = folder + "/bin/python";
  const std::string python3 = python + "3";
  return access(python3.c_str(), X_OK) != 0 && access(python.c_str(), X_OK) == 0 ? python : python3;
}

// The distribution's Python gets its packages from the distribution.
std::string HowToInstall(const std::string& python, const std::vector<std::string>& packages) {
  if (python.starts_with("/usr/bin/")) {
    return fmt::format("apt install python3-{}", fmt::join(packages, " python3-"));
  }
  return fmt::format("{} -m pip install {}", python, fmt::join(packages, " "));
}

// Empty: it has them all.
std::string WhyNotWith(const std::string& python, const std::vector<std::string>& packages,
                       double patience_s) {
  std::vector<std::string> words = {python, "-c", kQuestion};
  words.insert(words.end(), packages.begin(), packages.end());
  const ChildEnd end = RunChild(words, {}, patience_s);
  if (!end.failure.empty()) return "does not work: " + end.failure;
  if (!end.last_line.starts_with(kAnswer)) return "does not answer as Python 3 does";
  std::vector<std::string> lacking;
  std::istringstream names(end.last_line.substr(kAnswer.size()));
  for (std::string name; names >> name;) lacking.push_back(name);
  if (lacking.empty()) return "";
  return fmt::format("lacks {} ({})", fmt::join(lacking, ", "), HowToInstall(python, lacking));
}

}  // namespace

std::vector<Interpreter> InterpretersToAsk() {
  const std::string named = Variable("TOUCHDOWN_PYTHON");
  if (!named.empty()) return {{AsShell(named), "TOUCHDOWN_PYTHON"}};
  std::vector<Interpreter> all;
  const auto add = [&](const std::string& path, const std::string& named_by) {
    const bool there = std::any_of(all.begin(), all.end(),
                                   [&](const Interpreter& other) { return other.path == path; });
    if (!path.empty() && !there) all.push_back({path, named_by});
  };
  for (const char* environment : {"VIRTUAL_ENV", "CONDA_PREFIX"}) {
    const std::string folder = Variable(environment);
    if (!folder.empty()) add(InEnvironment(folder), environment);
  }
  add(FindOnPath("python3"), "PATH");
  add(TOUCHDOWN_DEFAULT_PYTHON, "the build's default");
  return all;
}

Interpreter FirstWith(const std::vector<std::string>& packages,
                      const std::vector<Interpreter>& interpreters, double patience_s) {
  std::vector<std::string> reasons;
  for (const Interpreter& one : interpreters) {
    const std::string why_not = WhyNotWith(one.path, packages, patience_s);
    if (why_not.empty()) return one;
    reasons.push_back(fmt::format("{} ({}) {}", one.path, one.named_by, why_not));
  }
  throw std::runtime_error(fmt::format("{}", fmt::join(reasons, "; ")));
}

std::string InterpreterWith(const std::vector<std::string>& packages) {
  constexpr double kTimeout = 30.0;  // [s], for an interpreter on a slow disk
  static std::map<std::vector<std::string>, std::string> kept;
  const auto known = kept.find(packages);
  if (known != kept.end()) return known->second;
  const Interpreter found = FirstWith(packages, InterpretersToAsk(), kTimeout);
  if (found.path != TOUCHDOWN_DEFAULT_PYTHON) {
    spdlog::info("the report is made by {} ({})", found.path, found.named_by);
  }
  return kept[packages] = found.path;
}

}  // namespace touchdown::evaluation
