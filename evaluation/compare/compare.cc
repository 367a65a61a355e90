// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/compare/compare.h"

#include <limits>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/compare/source_flights.h"

namespace touchdown::evaluation {
namespace {

constexpr int kEveryOfSeveral = 25;
constexpr int kOfSeveral = 20;

void RefuseNothing(const CompareOptions& options, const CompareResult& result) {
  if (!result.problems.empty()) return;
  if (result.asked > 0 && result.backends.empty()) {
    throw BadInput(fmt::format(
        "No backend can solve this formulation: {}",
        result.refusals.empty() ? "none is registered." : result.refusals.front().reason));
  }
  throw BadInput(fmt::format("{}: no solver backend is asked in it.{}",
                             options.from.empty() ? "The flights" : options.from,
                             result.notes.empty() ? "" : " " + result.notes.front() + "."));
}

}  // namespace

CompareResult RunCompare(const CompareOptions& options, const Registries& registries,
                         const std::function<void(int done, int all)>& report) {
  SolverBench bench(options.bench, registries.backends, registries.terms);
  const FlightSource source = options.from.empty()
                                  ? DrawnFlights(options.seed, options.set, registries)
                                  : FlightsOf(options.from, options.set, registries);
  CompareResult result;
  result.flights_there = source.flights;
  result.every = options.every.value_or(source.flights == 1 ? 1 : kEveryOfSeveral);
  const int all = source.flights == 1 ? std::numeric_limits<int>::max() : kOfSeveral;
  const int most = options.problems.value_or(all);
  const auto done = [&] { return static_cast<int>(bench.result().problems.size()); };
  int solve = 0;  // of the flight
  Registries overheard = registries;
  overheard.backends =
      solvers::Overheard(registries.backends, [&](const solvers::SolveRequest& asked) {
        const int flight = static_cast<int>(result.flights.size()) - 1;
        const int number = solve++;
        if (done() == most || result.asked++ % result.every != 0) return;
        bench.Run(asked, flight, number);
        report(done(), most == std::numeric_limits<int>::max() ? 0 : most);
      });
  for (int i = 0; done() < most && i != source.flights; ++i) {
    const SourceFlight flight = source.flight(i);
    result.flights.push_back(flight.command);
    solve = 0;
    std::string note;
    try {
      note = flight.fly(overheard);
    } catch (const BadInput&) {
      throw;
    } catch (const std::exception& error) {
      note = error.what();
    }
    if (!note.empty()) result.notes.push_back(fmt::format("{}: {}", flight.command, note));
    if (done() == 0 && (result.asked > 0 || !source.flights)) break;  // so it would go on
  }
  static_cast<BenchResult&>(result) = bench.result();
  RefuseNothing(options, result);
  return result;
}

}  // namespace touchdown::evaluation
