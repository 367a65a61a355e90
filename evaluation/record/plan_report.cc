// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/plan_report.h"

#include <cmath>

#include <fmt/format.h>

namespace touchdown::evaluation {
namespace {

std::string Vector(const Eigen::Vector3d& v) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", v.x(), v.y(), v.z());
}

// What is flown at the start of the step.
std::string CommittedBefore(const RecordPlan& asked, double t_start) {
  const planning::FlightPair& pair = asked.before.next;
  if (!pair.Lands() && pair.Last().t_end() <= t_start) {
    return fmt::format("  committed  rest, since t = {:.3f} s\n", pair.Last().t_end());
  }
  if (pair.t_stop <= t_start) {
    return fmt::format("  committed  a stored stop, until t = {:.3f} s\n", pair.stop.t_end());
  }
  std::string text = fmt::format("  committed  {} of {:.2f} s, until t = {:.3f} s",
                                 asked.before.planned ? "a plan" : "a curve to rest",
                                 pair.curve.duration(), pair.curve.t_end());
  if (pair.t_stop < pair.curve.t_end()) {
    text += fmt::format("; its stop begins at t = {:.3f} s", pair.t_stop);
  }
  return text + "\n";
}

std::string QuestionText(const SolvedStep& solved) {
  const RecordPlan& asked = solved.recorded;
  const planning::ReplanInput& input = asked.request.input;
  std::string text = fmt::format("asked at t = {:.3f} s for a curve that takes over at {:.3f} s\n",
                                 input.t_now, input.t_start);
  text += fmt::format("  vehicle    p {} m, v {} m/s\n", Vector(input.vehicle.p_WB),
                      Vector(input.vehicle.v_WB));
  if (asked.request.rest_climb) {
    text += fmt::format("  wanted     rest, {:.2f} m higher\n", *asked.request.rest_climb);
  } else {
    const estimation::PadState& pad = solved.pad.front();
    const bool to_goal = solved.scenario.task == TaskKind::kGoTo;
    text += fmt::format("  {:9}  p {} m, v {} m/s", to_goal ? "goal" : "pad", Vector(pad.p_WP),
                        Vector(pad.v_WP));
    text += to_goal ? "\n" : fmt::format(", predicted by {}\n", solved.scenario.pad.prediction);
    if (input.look_from_W) {
      text += fmt::format("  wanted     rest at {} m, to look from there\n",
                          Vector(*input.look_from_W));
      return text + CommittedBefore(asked, input.t_start);
    }
    if (to_goal) return text + CommittedBefore(asked, input.t_start);
    const planning::EndpointTarget& end = input.endpoint;
    text +=
        end.touches()
            ? fmt::format("  wanted     contact, {:.2f} m above the deck, sinking at {:.2f} m/s\n",
                          end.height, end.arrival_sink)
            : fmt::format(
                  "  wanted     {:.2f} m above the deck, sinking at {:.2f} m/s to {:.2f} m\n",
                  end.height, end.sink_rate, end.height_floor);
    if (end.at_rest) text += "             without the pad's velocity\n";
  }
  return text + CommittedBefore(asked, input.t_start);
}

std::string ForbiddenBy(const std::string& name) {
  return name.empty() ? "" : fmt::format(" (forbidden by {})", name);
}

std::string RoundText(const planning::RoundLog& round, int number) {
  const solvers::SolverResult& solver = round.solver;
  std::string text = fmt::format(
      "    round {}{}: {} pairs with weight x {:.2f}, limits x {:.0f}; {} after {} iterations, "
      "cost {:.6g}{}\n",
      number, round.guide > 0 ? ", another way around" : "", round.pairs.size(), round.pressure,
      round.limit_pressure, solvers::ToString(solver.status), solver.iterations, solver.cost,
      solver.message.empty() ? "" : fmt::format(" ({})", solver.message));
  std::string costs;
  for (const solvers::TermCost& term : solver.cost_by_term) {
    if (term.cost == 0.0) continue;
    costs += fmt::format("{}{} {:.4g}", costs.empty() ? "" : ", ", term.name, term.cost);
  }
  if (!costs.empty()) text += fmt::format("      cost by term: {}\n", costs);
  if (solver.worst_term >= 0 && solver.max_violation > planning::kLimitSlack) {
    text += fmt::format("      violates {} by {:.3g}\n",
                        solver.cost_by_term[static_cast<std::size_t>(solver.worst_term)].name,
                        solver.max_violation);
  }
  if (!solver.usable()) return text;
  if (round.blocked.empty()) return text + "      the curve is clear\n";
  for (const planning::BlockedRun& run : round.blocked) {
    text += fmt::format("      blocked from {:.2f} s to {:.2f} s{}{}\n", run.t_in, run.t_out,
                        run.at_start ? ", from the start" : "", run.at_end ? ", at the end" : "");
  }
  return text;
}

// `indent` stands before every line.
std::string CertificateText(const planning::Certificate& c, const planning::Limits& limits,
                            const std::string& indent) {
  if (c.earlier) {
    return fmt::format("{}committed before: {}\n", indent,
                       c.stops_in_observed_space ? "proven then, and it still holds"
                                                 : "not proven, then or now (docs/safety.md)");
  }
  std::string text =
      fmt::format("{}certificate {}\n", indent, c.passed() ? "passed" : "not passed");
  const auto bound = [&](const char* what, double value, double limit, const char* unit) {
    const bool beyond = value > limit + planning::kLimitSlack;
    return fmt::format("{} {:.4g} of {:.4g} {}{}", what, value, limit, unit,
                       !beyond         ? ""
                       : c.limits_kept ? " (recovering)"
                                       : " (not kept)");
  };
  text += fmt::format("{}  bounds: {}, {}, {}\n", indent,
                      bound("speed", c.speed_bound, limits.speed, "m/s"),
                      bound("acceleration", c.acceleration_bound, limits.acceleration, "m/s^2"),
                      bound("body rate", c.body_rate_bound, limits.body_rate, "rad/s"));
  if (c.endpoint_required) {
    text += fmt::format("{}  endpoint residual {:.1e} m, {:.1e} m/s\n", indent,
                        c.endpoint_position_residual, c.endpoint_velocity_residual);
  }
  const std::string way = c.clear      ? fmt::format("clear by {:.2f} m", c.clearance)
                          : c.escaping ? fmt::format("escapes, {:.2f} m away", c.clearance)
                                       : fmt::format("blocked at t = {:.2f} s", c.first_hit_t);
  text += fmt::format("{}  {}; {} before space that was not observed\n", indent, way,
                      c.stops_in_observed_space ? "stops" : "does not stop");
  return text;
}

std::string AttemptText(const planning::AttemptLog& attempt, int number,
                        const planning::Limits& limits) {
  std::string text = fmt::format(
      "  attempt {}: T = {:.3f} s ({}) in {} segments\n", number, attempt.duration,
      attempt.arrival == planning::ArrivalMode::kFree ? "free" : "fixed", attempt.segments);
  int round = 0;
  for (const planning::RoundLog& log : attempt.rounds) text += RoundText(log, ++round);
  if (attempt.best >= 0 && attempt.best + 1 < round) {
    text += fmt::format("    round {} is the best\n", attempt.best + 1);
  }
  if (attempt.certificate) text += CertificateText(*attempt.certificate, limits, "    ");
  if (attempt.reason != planning::ReplanReason::kNone) {
    text += fmt::format("    failed: {}{}\n", planning::ToString(attempt.reason),
                        ForbiddenBy(attempt.forbidden_by));
  }
  return text;
}

std::string TimesText(const planning::StageTimes& times) {
  std::string text = fmt::format("  took {:.3f} ms of thread CPU time, {:.3f} ms of wall time:",
                                 1e3 * times.total.cpu, 1e3 * times.total.wall);
  for (const planning::StageTimes::Span* stage : times.Stages()) {
    text += fmt::format(" {} {:.3f}", stage->stage, 1e3 * stage->cpu);
  }
  return text + "\n";
}

}  // namespace

namespace {

// The trajectory committed before, which is flown on. Without a newer pair it goes to the end of
// its stop.
std::string CommittedText(const planning::FlightPair& pair) {
  const planning::UniformBspline& last = pair.Last();
  const std::string end =
      fmt::format("until t = {:.3f} s at {} m", last.t_end(), Vector(last.Position(last.t_end())));
  if (!std::isfinite(pair.t_stop)) return fmt::format("  flown: the committed curve, {}\n", end);
  return fmt::format("  flown: the committed curve until t = {:.3f} s, then its stored stop {}\n",
                     pair.t_stop, end);
}

std::string RecordedText(const ReplanOutcome& result) {
  return result.status == planning::ReplanStatus::kPlanned
             ? fmt::format("{}, cost {:.6g}", planning::ToString(result.status), result.cost)
             : std::string(planning::ToString(result.status));
}

}  // namespace

std::string PlanText(const SolvedStep& solved) {
  std::string text = fmt::format("{}, backend {}: ", solved.source, solved.scenario.solver.backend);
  text += QuestionText(solved);
  int number = 0;
  for (const planning::AttemptLog& attempt : solved.log.attempts) {
    text += AttemptText(attempt, ++number, solved.limits);
  }
  const ReplanOutcome& out = solved.outcome;
  text += fmt::format("{}: {}\n", planning::ToString(out.status), planning::Explain(out.status));
  if (out.reason != planning::ReplanReason::kNone) {
    text += fmt::format("  no new plan: {}{}: {}\n", planning::ToString(out.reason),
                        ForbiddenBy(solved.forbidden_by), planning::Explain(out.reason));
  }
  if (solved.unseen_W) {
    text += fmt::format("  to be seen next: the cell at {} m\n", Vector(*solved.unseen_W));
  }
  if (out.from_odometry) text += "  starts at the vehicle: the tracking error was too large\n";
  if (out.certificate.earlier) {
    text += CommittedText(solved.recorded.before.next);
  } else {
    text += fmt::format("  flown from t = {:.3f} s to {:.3f} s: {} control points every {:.4f} s\n",
                        out.curve.t0(), out.curve.t_end(), out.curve.control_points().cols(),
                        out.curve.interval());
  }
  text += CertificateText(out.certificate, solved.limits, "  ");
  if (out.work > 0) {
    text +=
        fmt::format("  did {} of {} units of work\n", out.work, solved.scenario.planning.max_work);
  }
  text += TimesText(solved.times);
  if (solved.same) {
    text += *solved.same ? "  the recorded answer, bit for bit\n"
                         : fmt::format("  not the recorded answer, which was: {}\n",
                                       RecordedText(solved.recorded.result));
  }
  return text;
}

}  // namespace touchdown::evaluation
