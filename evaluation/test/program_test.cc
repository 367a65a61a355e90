// SPDX-License-Identifier: BSD-3-Clause
// The program as a library function, with a backend that is broken on purpose. A failure in flight
// is the program's fault and must not look like the user's.
#include "touchdown/evaluation/program/program.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/machine.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class BrokenSolver : public solvers::SolverBackend {
 public:
  BrokenSolver() : SolverBackend("broken", {}) {}
  solvers::Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const solvers::View&) override {}
  void DoSolve(const solvers::View&, const solvers::WarmStart&, const solvers::Stop&,
               solvers::Evaluator*, solvers::SolverResult*) override {
    throw std::invalid_argument("broken on purpose");
  }
};

struct Ran {
  int status = 0;
  std::string out;
  std::string err;
};

Ran Call(std::vector<const char*> arguments) {
  Registries registries = StandardRegistries();
  registries.backends.push_back(
      {"broken", "throws", [] { return std::make_unique<BrokenSolver>(); }});
  arguments.insert(arguments.begin(), "touchdown");
  Ran ran;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  ran.status = RunProgram(static_cast<int>(arguments.size()), arguments.data(), registries);
  ran.out = ::testing::internal::GetCapturedStdout();
  ran.err = ::testing::internal::GetCapturedStderr();
  return ran;
}

TEST(Program, UnknownCommandsAreNamedAtEveryLevel) {
  EXPECT_THAT(Call({"flutter"}).err,
              HasSubstr("unknown command flutter; the commands are fly, land,"));
  const Ran ran = Call({"study", "hostel"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(
      ran.err,
      AllOf(HasSubstr("unknown command hostel of study (did you mean hostile?); the commands are "),
            HasSubstr("hostile")));
}

// Wherever a name is one of several, the message for a typo suggests the right one, in one sentence.
TEST(Program, ATypoIsToldWhatWasMeant) {
  const std::filesystem::path folder = ::testing::TempDir();
  const auto file = [&folder](const char* name, const char* text) {
    const std::filesystem::path path = folder / name;
    std::ofstream(path) << text;
    return path.string();
  };
  const std::string group = file("group.yaml", "planing: {rate: 5}\n");
  const std::string element =
      file("element.yaml", "obstacles: {boxes: [{center: [9, 9], size: [1, 1, 1]}]}\n");
  const std::string study = file("study.yaml", "titel: A\n");
  const std::vector<std::pair<std::vector<const char*>, const char*>> typos = {
      {{"lnad"}, "land"},
      {{"study", "papr"}, "paper"},
      {{"land", "--recrod=x.db"}, "--record"},
      {{"land", "cirle"}, "circle"},
      {{"study", "run", "ablaton"}, "ablation"},
      {{"land", "open", "--set", "planing.rate=5"}, "planning.rate"},
      {{"land", "open", "--set", "pad.sped=1"}, "pad.speed"},
      {{"land", group.c_str()}, "planning"},
      {{"land", element.c_str()}, "centre"},
      {{"study", "run", study.c_str()}, "title"},
      {{"land", "open", "--planner", "landin"}, "landing"},
      {{"land", "open", "--backend", "baned"}, "banded"},
      {{"land", "open", "--set", "pad.motion=circel"}, "circle"},
      {{"land", "open", "--set", "controller=papr"}, "paper"},
      {{"land", "open", "--set", "pad.prediction=turnrate"}, "turn_rate"},
      {{"land", "open", "--set", "task=folow"}, "follow"},
      {{"land", "open", "--set", "terms.tilt_limt.weight=1"}, "tilt_limit"},
      {{"land", "open", "--set", "terms.tilt_limit.wieght=1"}, "weight"},
      {{"land", "open", "--set", "solver.options.gap_tolerence=1"}, "gap_tolerance"},
      {{"check-term", "tilt_limt"}, "tilt_limit"},
      {{"sweep", "open", "--vary", "pad.sped=1..2"}, "pad.speed"},
      {{"list", "backend"}, "backends"},
      {{"compare", "--backends", "ipot"}, "ipopt"},
      {{"study", "paper", "--out", "x", "--methods", "plannd"}, "planned"},
      {{"study", "hostile", "--families", "pols"}, "poles"},
  };
  for (const auto& [arguments, meant] : typos) {
    SCOPED_TRACE(arguments.back());
    const Ran ran = Call(arguments);
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, HasSubstr(std::string("(did you mean ").append(meant).append("?)")));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_THAT(ran.err, Not(HasSubstr("try --help")));
  }
  for (const char* key :
       {"solver.max=1", "estimator.yaw=1", "planning.name=1", "wind.far=1", "pid.seed=1"}) {
    const Ran ran = Call({"land", "open", "--set", key});
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, Not(HasSubstr("did you mean"))) << key;
  }
  EXPECT_THAT(Call({"land", "--quickly"}).err, HasSubstr("has no option --quickly (try --help)"));
}

TEST(Program, WordsFromOutsideDoNotBreakALine) {
  for (const std::vector<const char*>& arguments :
       {std::vector<const char*>{"land", "open", "--set", "description=\"a\\nb\""},
        {"land", "a\nb"},
        {"land", "open", "--video", "a\nb"},
        {"land", "--a\nb"},
        {"a\nb"}}) {
    const Ran ran = Call(arguments);
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, HasSubstr("a\\nb"));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
  EXPECT_THAT(Call({"land", "a\x1b[2Jb"}).err, HasSubstr("a\\x1b[2Jb"));
}

TEST(Program, APageReplacesNoOtherFile) {
  const Ran ran = Call({"study", "hostile", "--flights", "1", "--html", "hostile.db"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("--html hostile.db: the name must end in .html."));
}

TEST(Program, AFaultInFlightIsNoBadInput) {
  const Ran ran = Call({"land", "open", "--backend", "broken"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_TRUE(ran.out.empty());
  EXPECT_THAT(ran.err, AllOf(HasSubstr("internal error in flight at "), HasSubstr("(seed 1)"),
                             HasSubstr("broken on purpose")));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
}

TEST(Program, AFaultInASweepIsAnErrorRowAndStatusOne) {
  const Ran ran = Call({"sweep", "open", "--trials", "2", "--set", "timeout=2", "--vary",
                        "solver.backend=ceres,broken", "--jobs", "1"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.out, AllOf(HasSubstr("1 x error"), HasSubstr("1 x timeout"),
                             HasSubstr("broken on purpose")));
}

TEST(Program, ASweepOfFlightsThatFailIsDone) {
  const Ran ran = Call({"sweep", "open", "--trials", "2", "--set", "timeout=1", "--jobs", "1"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.out, HasSubstr("0 of 2 landed"));
}

// A pad faster than the vehicle drives away from it.
TEST(Program, APadThatCannotBeCaughtIsAFlightWithAnOutcome) {
  const Ran flight = Call({"land", "open", "--set", "pad.motion=line", "--set", "pad.speed=4",
                           "--set", "timeout=20", "--json"});
  EXPECT_EQ(flight.status, 1);
  EXPECT_TRUE(flight.err.empty()) << flight.err;
  const nlohmann::json json = nlohmann::json::parse(flight.out);
  EXPECT_EQ(json["outcome"], "infeasible");
  EXPECT_FALSE(json["landed"]);
  const Ran plan = Call({"plan", "open", "--set", "pad.speed=4"});
  EXPECT_THAT(plan.out, HasSubstr("pad_unreachable"));
}

TEST(Program, AScenarioThatIsRefusedIsBadInput) {
  const Ran ran = Call({"land", "open", "--backend", "unheard_of"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("solver.backend"), HasSubstr("broken")));
}

TEST(Program, WhatDoesNotGoTogetherIsBadInput) {
  const Ran ego = Call({"land", "open", "--planner", "ego", "--backend", "banded"});
  EXPECT_EQ(ego.status, 2);
  EXPECT_THAT(ego.err, AllOf(HasSubstr("--backend banded"), HasSubstr("planner ego")));
  const Ran growth = Call({"study", "replan", "--parts", "growth", "--kinds", "B,C"});
  EXPECT_EQ(growth.status, 2);
  EXPECT_THAT(growth.err, HasSubstr("--kinds"));
  const Ran flat = Call({"sweep", "open", "--picture", "p.png", "--vary", "gps.sigma=0,1", "--vary",
                         "pad.speed=0.2,0.4", "--vary", "controller=geometric,paper"});
  EXPECT_EQ(flat.status, 2);
  EXPECT_THAT(flat.err, AllOf(HasSubstr("--picture p.png"), HasSubstr("--vary gives 3")));
  const Ran nothing_varied = Call({"sweep", "open", "--picture", "p.png"});
  EXPECT_EQ(nothing_varied.status, 2);
  EXPECT_THAT(nothing_varied.err, AllOf(HasSubstr("--picture p.png"), HasSubstr("--vary")));
  const Ran replay = Call({"profile", "--from", "none.db", "--set", "planning.rate=5"});
  EXPECT_EQ(replay.status, 2);
  EXPECT_THAT(replay.err, HasSubstr("planning.guides"));
}

TEST(Program, CompareTimesNoBuildThatIsNotOptimised) {
  const Ran ran = Call({"compare", "--problems", "1", "--backends", "banded"});
  if (TimingsMeanSomething()) {
    EXPECT_EQ(ran.status, 0) << ran.err;
  } else {
    EXPECT_EQ(ran.status, 2);
    EXPECT_TRUE(ran.out.empty());
    EXPECT_THAT(ran.err, HasSubstr("--allow-debug"));
  }
}

TEST(Program, CompareTellsEveryBackendsFigures) {
  const std::filesystem::path db = std::filesystem::path(::testing::TempDir()) / "compare.db";
  std::filesystem::remove(db);
  const Ran ran = Call({"compare", "--problems", "2", "--repeats", "1", "--backends",
                        "banded,ceres", "--allow-debug", "--json", "--db", db.c_str()});
  EXPECT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["problems"]["all"], 2);
  EXPECT_EQ(json["problems"]["hard_limits"], 0);
  EXPECT_EQ(json["settings"]["gap"], 1e-4);
  for (const char* name : {"banded", "ceres"}) {
    const nlohmann::json& backend = json["backends"][name];
    EXPECT_EQ(backend["solved_fraction"], 1.0);
    for (const char* key : {"median", "p95", "p99", "max"}) {
      EXPECT_GT(backend["time_ms"][key], 0.0) << name;
    }
    EXPECT_TRUE(backend["iterations"].contains("median"));
    EXPECT_TRUE(backend["evaluations"].contains("median"));
    EXPECT_LE(backend["cost_gap"]["p95"], 1e-4);
    EXPECT_LE(backend["max_violation"], 1e-6);
  }
  // A study is never overwritten, and nothing is left where it is refused.
  EXPECT_TRUE(std::filesystem::exists(db));
  const Ran again = Call({"compare", "--problems", "1", "--allow-debug", "--db", db.c_str()});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("never overwritten"));
  std::filesystem::remove(db);
  const Ran refused = Call(
      {"compare", "--allow-debug", "--limits", "hard", "--backends", "ceres", "--db", db.c_str()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("takes no inequality constraints"));
  EXPECT_FALSE(std::filesystem::exists(db));
}

TEST(Program, AFlightTellsItsWindAndWhereItsTermsAct) {
  const Ran still = Call({"land", "open", "--set", "timeout=1"});
  EXPECT_THAT(still.out, AllOf(Not(HasSubstr("wind")), Not(HasSubstr("zone"))));
  const Ran steady = Call({"land", "open", "--set", "timeout=1", "--set", "wind.mean=3", "--set",
                           "wind.direction_deg=-90"});
  EXPECT_THAT(
      steady.out,
      HasSubstr("\n  wind                   3 m/s in the mean, towards -90 deg from x, left "
                "positive\n"));
  const Ran all = Call({"land", "open", "--set", "timeout=1", "--set", "wind.mean=3", "--set",
                        "wind.max=4.5", "--set", "wind.gust.speed=2", "--set",
                        "terms.keep_out.weight=10", "--set", "terms.keep_out.radius=1.5"});
  EXPECT_THAT(all.out, HasSubstr("left positive; at most 4.5 m/s; gusts of 2 m/s along it\n"));
  EXPECT_THAT(all.out, HasSubstr("\n  zone of keep_out       "));
  EXPECT_THAT(all.out, HasSubstr("] m, 3 x 3 x 3 m\n"));
  // A baseline has no terms.
  const Ran ego = Call({"land", "open", "--planner", "ego", "--set", "timeout=1", "--set",
                        "terms.keep_out.weight=10"});
  EXPECT_EQ(ego.status, 1) << ego.err;
  EXPECT_THAT(ego.out, Not(HasSubstr("zone")));
}

TEST(Program, ARecordReplacesNoOtherFile) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "notes.md";
  std::ofstream(file) << "# Notes that nobody wants to lose\n";
  const Ran ran = Call({"land", "straight_turn", "--set", "timeout=1", "--record", file.c_str()});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("no SQLite file"));
  std::string kept;
  std::getline(std::ifstream(file) >> std::ws, kept);
  EXPECT_EQ(kept, "# Notes that nobody wants to lose");
  std::filesystem::remove(file);
  // A record is replaced.
  for (int i = 0; i < 2; ++i) {
    const Ran flown =
        Call({"land", "straight_turn", "--set", "timeout=1", "--record", file.c_str()});
    EXPECT_EQ(flown.status, 1) << flown.err;
  }
  std::filesystem::remove(file);
}

TEST(Program, AStepIsAskedAgainWithAnotherBudget) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "budget.db";
  Call({"land", "forest", "--set", "timeout=1", "--record", file.c_str()});
  const std::string step = file.string() + ":4";  // a plan that takes more than 1,000 units
  const Ran flown = Call({"plan", "--from", step.c_str()});
  EXPECT_THAT(flown.out, HasSubstr("the recorded answer, bit for bit")) << flown.err;
  const Ran less = Call({"plan", "--from", step.c_str(), "--set", "planning.max_work=1000"});
  EXPECT_THAT(less.out, HasSubstr("not the recorded answer, which was: planned")) << less.err;
  std::filesystem::remove(file);
}

TEST(Program, AFlightAndAStepNameTheTermThatForbidsAPlan) {
  // A cone over the pad that begins far from it: its rows cannot be kept.
  const auto call = [](std::vector<const char*> words) {
    for (const char* key :
         {"terms.approach_corridor.hard=true", "terms.approach_corridor.span=60",
          "terms.approach_corridor.angle_deg=5", "solver.limits=hard",
          "terms.approach_corridor.radius=0.05", "timeout=2", "planning.max_work=2500"}) {
      words.insert(words.end(), {"--set", key});
    }
    return Call(words);
  };
  EXPECT_THAT(call({"plan", "open"}).out,
              AllOf(HasSubstr("violates approach_corridor by "),
                    HasSubstr("failed: limits_exceeded (forbidden by approach_corridor)\n"),
                    HasSubstr("plan: limits_exceeded (forbidden by approach_corridor): ")));
  const nlohmann::json plan = nlohmann::json::parse(call({"plan", "open", "--json"}).out);
  EXPECT_EQ(plan["result"]["forbidden_by"], "approach_corridor");
  EXPECT_EQ(plan["attempts"].back()["forbidden_by"], "approach_corridor");
  EXPECT_THAT(call({"land", "open"}).out,
              AllOf(ContainsRegex("forbidden(, most)? by approach_corridor[.]"),
                    HasSubstr("; forbidden by: ")));
  const nlohmann::json flight = nlohmann::json::parse(call({"land", "open", "--json"}).out);
  EXPECT_GT(flight["replans_forbidden_by"]["approach_corridor"], 0);
}

TEST(Program, AFormulationThatTheBackendRefusesIsBadInput) {
  for (const char* key :
       {"solver.limits=hard", "solver.endpoint=explicit", "terms.obstacle_pair.hard=true"}) {
    const Ran ran = Call({"land", "open", "--backend", "ceres", "--set", key});
    EXPECT_EQ(ran.status, 2) << key;
    EXPECT_THAT(ran.err, HasSubstr("backend ceres takes no ")) << key;
  }
}

TEST(Program, TermsAreCheckedByName) {
  const Ran good = Call({"check-term", "tilt_limit", "--trials", "1"});
  EXPECT_EQ(good.status, 0);
  EXPECT_THAT(good.out, AllOf(HasSubstr("whitened  free    rows"), HasSubstr("u = 0"),
                              HasSubstr("all derivatives agree")));
  const Ran unknown = Call({"check-term", "tilt"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("term tilt is unknown; known: smoothness"));
}

TEST(Program, BackendsAreListedWithEveryFormulation) {
  const Ran ran = Call({"list", "backends", "--json"});
  EXPECT_EQ(ran.status, 0);
  const nlohmann::json list = nlohmann::json::parse(ran.out);
  for (const nlohmann::json& backend : list) {
    EXPECT_EQ(backend["formulations"].size(), 8U) << backend["name"];
    for (const nlohmann::json& f : backend["formulations"]) {
      EXPECT_NE(f["solves"].get<bool>(), !f["reason"].get<std::string>().empty());
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
