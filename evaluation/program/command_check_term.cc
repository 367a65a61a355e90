// SPDX-License-Identifier: BSD-3-Clause
// touchdown check-term: derivatives of one term against finite differences, on every view.
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/program/commands.h"
#include "evaluation/scenario/scenario_check.h"
#include "touchdown/planning/problem/term_check.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using planning::TermCheckRow;

struct CheckTermArguments {
  std::string name;
  planning::TermCheckOptions options;
  bool json = false;
};

const char* ViewName(planning::CheckedView view) {
  switch (view) {
    case planning::CheckedView::kFull:
      return "full";
    case planning::CheckedView::kReduced:
      return "reduced";
    case planning::CheckedView::kWhitened:
      return "whitened";
  }
  return "unknown";
}

const char* PointName(planning::CheckedPoint point) {
  switch (point) {
    case planning::CheckedPoint::kRandom:
      return "random";
    case planning::CheckedPoint::kZero:
      return "u = 0";
    case planning::CheckedPoint::kActive:
      return "active";
  }
  return "unknown";
}

const char* ArrivalName(const TermCheckRow& row) {
  return row.arrival == planning::ArrivalMode::kFree ? "free" : "fixed";
}

const char* RoleName(const TermCheckRow& row) { return row.hard ? "rows" : "cost"; }

std::string Text(const std::string& name, const std::vector<TermCheckRow>& rows) {
  constexpr const char* kLine = "{:<9} {:<7} {:<5} {:<7} {:>6}  {:>9} {:>9} {:>9} {:>9}\n";
  std::string text = fmt::format("{}: worst relative error against central differences\n", name);
  text += fmt::format(kLine, "view", "arrival", "as", "point", "points", "gradient", "Hessian",
                      "residuals", "rows");
  for (const TermCheckRow& row : rows) {
    const auto figure = [&](double error) {
      if (row.points == 0) return std::string("-");
      return row.errors.evaluated ? fmt::format("{:.1e}", error) : "undefined";
    };
    const solvers::DerivativeErrors& e = row.errors;
    text += fmt::format(kLine, ViewName(row.view), ArrivalName(row), RoleName(row),
                        PointName(row.point), row.points, figure(e.gradient), figure(e.hessian),
                        figure(e.residual_jacobian), figure(e.row_jacobian));
  }
  const std::string complaint = planning::Complaint(rows);
  text += fmt::format("{} (tolerance {:.0e})\n",
                      complaint.empty() ? "all derivatives agree" : "FAILED: " + complaint,
                      planning::kTermCheckTolerance);
  return text;
}

Json ToJson(const CheckTermArguments& arguments, const std::vector<TermCheckRow>& rows) {
  Json checks = Json::array();
  for (const TermCheckRow& row : rows) {
    // JSON has no infinity: what could not be evaluated is null.
    const auto figure = [&](double error) {
      return row.points == 0 || !row.errors.evaluated ? Json() : Json(error);
    };
    checks.push_back({{"view", ViewName(row.view)},
                      {"arrival", ArrivalName(row)},
                      {"as", RoleName(row)},
                      {"point", PointName(row.point)},
                      {"points", row.points},
                      {"gradient", figure(row.errors.gradient)},
                      {"hessian", figure(row.errors.hessian)},
                      {"residual_jacobian", figure(row.errors.residual_jacobian)},
                      {"row_jacobian", figure(row.errors.row_jacobian)}});
  }
  return {{"name", arguments.name},
          {"control_points", arguments.options.control_points},
          {"trials", arguments.options.trials},
          {"seed", arguments.options.seed},
          {"tolerance", planning::kTermCheckTolerance},
          {"passed", planning::Passed(rows)},
          {"complaint", planning::Complaint(rows)},
          {"checks", checks}};
}

const planning::TermEntry& Find(const Registries& registries, const std::string& name) {
  try {
    return TermNamed(registries.terms, name);
  } catch (const std::invalid_argument& error) {
    throw BadInput(std::string(error.what()) + ".");
  }
}

int CheckTerm(const CheckTermArguments& arguments, const Registries& registries) {
  const std::vector<TermCheckRow> rows =
      planning::CheckTerm(Find(registries, arguments.name), arguments.options);
  if (arguments.json) {
    std::cout << ToJson(arguments, rows).dump(2) << std::endl;
  } else {
    std::cout << Text(arguments.name, rows) << std::flush;
  }
  return planning::Passed(rows) ? kDone : kFellShort;
}

}  // namespace

void AddCheckTermCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(
      "check-term", "Check a term's derivatives on every view of the problem", "adding_a_term.md");
  const auto arguments = std::make_shared<CheckTermArguments>();
  command.Add("NAME", arguments->name, "Name of a term (`touchdown list terms`)").Required();
  command.Add("--points", arguments->options.control_points, "Control points of the spline")
      .Check(Range(9, 60))
      .ShowDefault();
  command.Add("--trials", arguments->options.trials, "Random landings")
      .Check(Range(1, 10000))
      .ShowDefault();
  command.Add("--seed", arguments->options.seed, "Seed of the landings and points")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return CheckTerm(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
