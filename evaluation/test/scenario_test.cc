// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/scenario.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/scenario/scenario_schema.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const Registries kRegistries = StandardRegistries();

class ScenarioTest : public ::testing::Test {
 protected:
  ~ScenarioTest() override { std::filesystem::remove(path_); }

  Scenario Load(const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::ofstream(path_) << text;
    return LoadScenario(path_, overrides, kRegistries);
  }

  /// The sentence that the text is refused with.
  std::string Refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
      Load(text, overrides);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string path_ = ::testing::TempDir() + "scenario.yaml";
};

TEST_F(ScenarioTest, KeysLeftOutKeepTheirDefaults) {
  EXPECT_EQ(DumpScenario(Load("seed: 1\n")), DumpScenario(Scenario{}));
}

TEST_F(ScenarioTest, AFileWithoutAKeyIsRefused) {
  for (const char* text : {"", "\n", "# nothing but a comment\n", "---\n"}) {
    EXPECT_THAT(Refusal(text), AllOf(HasSubstr(path_), HasSubstr("holds no key")));
  }
}

TEST_F(ScenarioTest, SensorKeysAreChecked) {
  EXPECT_THAT(Refusal("sensing: guessed\n"), HasSubstr("sensing must be fast or rendered"));
  EXPECT_THAT(Refusal("gps: {outage: [5, 3]}\n"), HasSubstr("must not end before it begins"));
  EXPECT_THAT(Refusal("own: {gps: {outage: [5, 3]}}\n"), HasSubstr("own.gps.outage must not end"));
  EXPECT_THAT(Refusal("depth: {outage: [5, 3]}\n"), HasSubstr("depth.outage must not end"));
  EXPECT_THAT(Refusal("camera: {outage: [5, 3]}\n"), HasSubstr("camera.outage must not end"));
  EXPECT_THAT(Refusal("own_state: guessed\n"), HasSubstr("own_state must be true or estimated"));
  EXPECT_EQ(Refusal("own: {gps: {rate: 0}}\n"), "accepted");
  EXPECT_THAT(Refusal("own_state: estimated\nown: {gps: {rate: 0}}\n"),
              HasSubstr("cannot tell where it is"));
  EXPECT_EQ(Refusal("own_state: estimated\nown: {gps.rate: 0, odometry: {rate: 30}}\n"),
            "accepted");
  EXPECT_THAT(Refusal("camera: {drop: 1.5}\n"), HasSubstr("camera.drop must be"));
  EXPECT_THAT(Refusal("camera: {occlusion: 0.95}\n"), HasSubstr("camera.occlusion must be"));
  EXPECT_THAT(Refusal("camera: {zoom: 2}\n"), HasSubstr("camera.zoom"));
  EXPECT_EQ(Refusal("pad: {deck_size: 1.0}\n"), "accepted");
  EXPECT_THAT(Refusal("pad: {deck_size: 1.0}\nsensing: rendered\n"),
              HasSubstr("pad.deck_size must be in [1.28, 5] m"));
}

TEST_F(ScenarioTest, NestedAndDottedKeysAreTheSame) {
  const Scenario a = Load("pad: {speed: 1.25, start: [3, -4.5]}\nplanning: {latency: measured}\n");
  const Scenario b = Load("pad.speed: 1.25\npad.start: [3, -4.5]\nplanning.latency: measured\n");
  EXPECT_EQ(a.pad.speed, 1.25);
  EXPECT_EQ(a.pad.start, Eigen::Vector2d(3.0, -4.5));
  EXPECT_TRUE(a.planning.latency.measured);
  EXPECT_EQ(DumpScenario(a), DumpScenario(b));
}

TEST_F(ScenarioTest, EveryKeyRoundTrips) {
  const Scenario s = Load(
      "pad: {motion: circle, speed: 0.123456789012345678, phase_spread: 1.5, prediction: oracle}\n"
      "start: {position: [0.1, -0.2, 3.3], position_spread: [1, 1, 0.25], yaw_random: true}\n"
      "gps: {sigma: 1e-3}\nown_state: estimated\n"
      "own: {imu.noise: 2, gps: {sigma: 0.3, outage: [1, 2]}}\nestimator: {pad: "
      "paper}\ncontroller: paper\ntask: follow\n"
      "solver: {arrival: free}\nseed: 9007199254740991\n"
      "obstacles:\n  boxes:\n    - {centre: [-8, -3], size: [1, 2, 3]}\n"
      "  cylinders:\n    - {centre: [-5, 0.5], radius: 0.3, height: 4}\n");
  const std::string text = DumpScenario(s);
  EXPECT_EQ(DumpScenario(Load(text)), text);
  EXPECT_EQ(Load(text).pad.speed, s.pad.speed);
  EXPECT_EQ(Load(text).seed, 9007199254740991U);
  ASSERT_EQ(Load(text).cylinders.size(), 1U);
}

TEST_F(ScenarioTest, ADescriptionIsOneLineThatReadsBack) {
  const Scenario s = Load("description: 'A \"yard\": C:\\x, 5 °'\n");
  EXPECT_EQ(s.description, "A \"yard\": C:\\x, 5 °");
  EXPECT_EQ(Load(DumpScenario(s)).description, s.description);
  EXPECT_THAT(DumpScenario(Scenario{}), Not(HasSubstr("description")));
  EXPECT_THAT(Refusal("description: \"a\\nb\"\n"), HasSubstr("must be a text of one line"));
}

TEST_F(ScenarioTest, KeysOfTermsAndBackendsAreTheRegistries) {
  const Scenario s = Load(
      "solver: {backend: banded, limits: hard, options: {gap_tolerance: 1e-5}}\n"
      "terms: {tilt_limit: {weight: 3.5, hard: false}, smoothness: {jerk: 0.2}}\n",
      {"terms.speed_limit.hard=false"});
  EXPECT_EQ(s.terms.at("tilt_limit").at("weight"), 3.5);
  EXPECT_EQ(s.terms.at("speed_limit").at("hard"), 0.0);
  EXPECT_EQ(s.solver.options.at("gap_tolerance"), 1e-5);
  EXPECT_EQ(DumpScenario(Load(DumpScenario(s))), DumpScenario(s));
  EXPECT_THAT(Refusal("terms:\n  tilt: {weight: 1}\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("term tilt is unknown; known: smoothness")));
  EXPECT_THAT(Refusal("terms: {smoothness: {jork: 1}}\n"),
              HasSubstr("no parameter jork (did you mean jerk?); known: weight, hard or jerk"));
  EXPECT_THAT(Refusal("terms: {smoothness: {jerk: -1}}\n"), HasSubstr("must be in [0, 1000]"));
  EXPECT_THAT(Refusal("terms: {consistency: {hard: true}}\n"), HasSubstr("a cost only"));
  EXPECT_THAT(
      Refusal("terms: {moving_obstacle: {weight: 1}}\n"),
      AllOf(HasSubstr(path_ + ":1"), HasSubstr("moving_obstacle does nothing in a flight")));
  EXPECT_THAT(Refusal("terms: {speed_limit: {hard: 1}}\n"), HasSubstr("true or false"));
  EXPECT_THAT(Refusal("terms: {speed_limit: 1}\n"), HasSubstr("a map of keys"));
  EXPECT_THAT(Refusal("solver: {options: {foo: 1}}\n"),
              HasSubstr("solver option foo is unknown; known:"));
  EXPECT_THAT(Refusal("solver: {backend: banded, options: {gap_tolerence: 1}}\n"),
              HasSubstr("option gap_tolerence is unknown (did you mean gap_tolerance?)"));
}

TEST_F(ScenarioTest, AFormulationThatTheBackendRefusesIsRefused) {
  EXPECT_THAT(Refusal("seed: 1\n", {"solver.backend=ceres", "solver.limits=hard"}),
              AllOf(HasSubstr("--set solver.backend=ceres"),
                    HasSubstr("backend ceres takes no inequality constraints")));
  EXPECT_THAT(Refusal("solver: {backend: lbfgs, endpoint: explicit}\n"),
              AllOf(HasSubstr(path_ + ":1"), HasSubstr("takes no equality constraints")));
  EXPECT_EQ(Load("solver: {backend: banded, limits: hard}\n").solver.limits, LimitsKind::kHard);
}

TEST_F(ScenarioTest, ShippedScenariosLoadAndRoundTrip) {
  EXPECT_THAT(ListScenarios(), ::testing::IsSupersetOf({"circle", "open", "straight_turn"}));
  for (const std::string& name : ListScenarios()) {
    const Scenario scenario = LoadScenario(FindScenario(name), {}, kRegistries);
    EXPECT_EQ(scenario.name, name);
    EXPECT_FALSE(scenario.description.empty()) << name;
    EXPECT_EQ(DumpScenario(Load(DumpScenario(scenario))), DumpScenario(scenario));
  }
}

TEST_F(ScenarioTest, CaseOneIsThePapers) {
  const Scenario s = LoadScenario(FindScenario("straight_turn"), {}, kRegistries);
  EXPECT_EQ(s.pad.speed, 0.8);
  EXPECT_EQ(Eigen::Vector2d(s.pad.start - s.start.position.head<2>()), Eigen::Vector2d(7.0, 6.5));
  EXPECT_DOUBLE_EQ(s.start.position.z() - s.pad.deck_height, 2.0);
  EXPECT_FALSE(s.boxes.empty());
}

TEST_F(ScenarioTest, AnUnknownKeyNamesFileLineAndWhatIsAllowed) {
  EXPECT_THAT(
      Refusal("seed: 1\npad:\n  sped: 1\n"),
      AllOf(HasSubstr(path_ + ":3"), HasSubstr("unknown key pad.sped"), HasSubstr("pad.speed")));
  EXPECT_THAT(
      Refusal("weather: {mean: 4}\n"),
      AllOf(HasSubstr(path_ + ":1"), HasSubstr("unknown key weather"), HasSubstr("obstacles")));
}

TEST_F(ScenarioTest, AWrongTypeNamesTheRange) {
  EXPECT_THAT(
      Refusal("\npad:\n  speed: fast\n"),
      AllOf(HasSubstr(path_ + ":3"), HasSubstr("pad.speed must be a number in [0.01, 10] m/s"),
            HasSubstr("'fast'")));
  EXPECT_THAT(Refusal("pad: {start: [1, 2, 3]}\n"), HasSubstr("a list of 2 numbers"));
  EXPECT_THAT(Refusal("pad: {start: 3}\n"), HasSubstr("a list of 2 numbers"));
  EXPECT_THAT(Refusal("start: {yaw_random: yes}\n"), HasSubstr("true or false, not 'yes'"));
  EXPECT_THAT(Refusal("seed: -1\n"), HasSubstr("a whole number in [0, "));
  EXPECT_THAT(Refusal("seed: 1.5\n"), HasSubstr("a whole number"));
  EXPECT_THAT(Refusal("pad: {speed: .nan}\n"), HasSubstr("pad.speed"));
  EXPECT_THAT(Refusal("pad: {speed: \"0.8\"}\n"), HasSubstr("pad.speed"));
  EXPECT_THAT(Refusal("pad: {speed: }\n"), HasSubstr("not empty"));
  EXPECT_THAT(Refusal("planning: {latency: soon}\n"), HasSubstr("or measured, not 'soon'"));
  EXPECT_THAT(Refusal("pad: 7\n"), HasSubstr("must be a map of keys"));
  EXPECT_THAT(Refusal("[1, 2]\n"), HasSubstr("must be a map of keys"));
}

TEST_F(ScenarioTest, AnOutOfRangeValueNamesTheRange) {
  EXPECT_THAT(Refusal("gps:\n  sigma: -0.1\n"),
              AllOf(HasSubstr(":2"), HasSubstr("gps.sigma must be a number in [0, 5] m"),
                    HasSubstr("'-0.1'")));
  EXPECT_THAT(Refusal("gps: {rate: 0}\n"), HasSubstr("(0, 100] Hz"));
  EXPECT_THAT(Refusal("timeout: 1e9\n"), HasSubstr("timeout must be a number in [1, 600] s"));
}

// As from a map: UTM.
TEST_F(ScenarioTest, APositionFarAwayIsToldToSubtractAnOrigin) {
  const auto advised = HasSubstr("'5300000': subtract an origin near the flight");
  EXPECT_THAT(Refusal("pad: {start: [0, 5300000]}\n"), advised);
  EXPECT_THAT(Refusal("start: {position: [0, 5300000, 2]}\n"), advised);
  EXPECT_THAT(Refusal("task: go_to\ngo_to: {goal: [5300000, 0, 2]}\n"), advised);
  EXPECT_THAT(Refusal("obstacles: {spheres: [{centre: [0, 5300000, 2], radius: 1}]}\n"), advised);
  EXPECT_THAT(Refusal("pad: {speed: 5300000}\n"), Not(advised));
  EXPECT_THAT(Refusal("pad: {start: [0, 500]}\n"), Not(HasSubstr("origin")));
}

TEST_F(ScenarioTest, AWrongWordListsTheAllowedOnes) {
  EXPECT_THAT(Refusal("descent: steep\n"), HasSubstr("descent must be vertical or planned"));
  EXPECT_THAT(Refusal("pad: {motion: figure8}\n"),
              HasSubstr("straight_turn, circle, line, static, figure_eight, "));
  EXPECT_THAT(Refusal("solver: {backend: newton}\n"),
              AllOf(HasSubstr(":1"), HasSubstr("solver.backend must be banded, lbfgs, ceres, "),
                    HasSubstr("not 'newton'")));
}

TEST_F(ScenarioTest, ASecondDocumentIsRefused) {
  EXPECT_THAT(Refusal("seed: 1\n---\nseed: 2\n"),
              HasSubstr(path_ + ":2: another YAML document begins here; allowed is one"));
  // yaml-cpp finds a document without end at a comma.
  EXPECT_THAT(Refusal(","), HasSubstr(path_ + ":1: "));
}

TEST_F(ScenarioTest, AKeyThatIsNoTextIsRefused) {
  EXPECT_THAT(Refusal("seed: 1\n? {a: 1}\n: 2\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("a key must be a text, not a map")));
}

TEST_F(ScenarioTest, AGroupWithoutKeysNamesItsOwnLine) {
  EXPECT_THAT(Refusal("pad:\nseed: 1\n"), HasSubstr(path_ + ":1: pad must be a map of keys"));
}

TEST_F(ScenarioTest, AKeyTwiceIsRefused) {
  EXPECT_THAT(Refusal("pad:\n  speed: 0.5\n  speed: 0.8\n"),
              AllOf(HasSubstr(":3"), HasSubstr("given twice")));
  EXPECT_THAT(Refusal("go_to: {time: 1}\ngo_to.time: 9\n"),
              AllOf(HasSubstr(":2"), HasSubstr("go_to.time is given twice")));
}

TEST_F(ScenarioTest, BrokenYamlNamesTheLine) {
  EXPECT_THAT(Refusal("pad: {speed: 0.5\nseed: [\n"), HasSubstr(path_ + ":"));
}

TEST_F(ScenarioTest, ObstaclesAreCheckedKeyByKey) {
  EXPECT_THAT(Refusal("obstacles:\n  boxes:\n    - {centre: [20, 20]}\n"),
              AllOf(HasSubstr(":3"), HasSubstr("obstacles.boxes[0] lacks the key size")));
  EXPECT_THAT(Refusal("obstacles:\n  boxes:\n    - {centre: [20, 20], size: [1, 1, 0]}\n"),
              HasSubstr("a list of 3 numbers in (0, 100] m"));
  EXPECT_THAT(Refusal("obstacles:\n  cones: []\n"),
              AllOf(HasSubstr("unknown key obstacles.cones"), HasSubstr("obstacles.cylinders")));
  EXPECT_THAT(Refusal("obstacles: {boxes: [{centre: [20, 20], size: [1, 1, 1], yaw: 1}]}\n"),
              HasSubstr("unknown key obstacles.boxes[0].yaw"));
}

TEST_F(ScenarioTest, DepthCamerasAreAList) {
  const Scenario s = Load(
      "depth:\n  rate: 8\n  cameras:\n    - {}\n    - {position: [0, 0, -0.1], yaw_deg: 180, "
      "pitch_deg: 45, fov_deg: 60, rate: 5}\n");
  ASSERT_EQ(s.depth.cameras.size(), 2u);
  EXPECT_EQ(s.depth.cameras[1].yaw_deg, 180.0);
  EXPECT_EQ(DumpScenario(Load(DumpScenario(s))), DumpScenario(s));
  EXPECT_THAT(DumpScenario(s), HasSubstr("depth.cameras:\n  - {}\n  - {position: [0, 0, -0.1]"));
  EXPECT_THAT(Refusal("depth:\n  cameras:\n    - {pitch: 3}\n"),
              AllOf(HasSubstr(path_ + ":3"), HasSubstr("unknown key depth.cameras[0].pitch")));
  EXPECT_THAT(Refusal("depth:\n  cameras:\n    - {fov_deg: 180}\n"), HasSubstr("[10, 170] deg"));
  std::string nine = "depth:\n  cameras:\n";
  for (int i = 0; i < 9; ++i) nine += "    - {}\n";
  EXPECT_THAT(Refusal(nine), AllOf(HasSubstr(path_ + ":3"), HasSubstr("9 cameras, 8 are allowed")));
}

TEST_F(ScenarioTest, AnObstacleOnTheStartIsRefusedWithItsLine) {
  EXPECT_THAT(Refusal("obstacles:\n  boxes:\n"
                      "    - {centre: [20, 20], size: [1, 1, 4]}\n"
                      "    - {centre: [0.7, 0], size: [1, 1, 4]}\n"),
              AllOf(HasSubstr(path_ + ":4"), HasSubstr("obstacles.boxes[1] stands on the start")));
  EXPECT_THAT(Refusal("obstacles: {cylinders: [{centre: [0, 0], radius: 0.2, height: 4}]}\n"),
              HasSubstr("obstacles.cylinders[0] stands on the start"));
  // Low enough to fly over, and only the spread reaches it.
  EXPECT_EQ(Refusal("obstacles: {boxes: [{centre: [0, 0], size: [1, 1, 1]}]}\n"), "accepted");
  EXPECT_THAT(Refusal("start: {position_spread: [1, 1, 0]}\n"
                      "obstacles: {boxes: [{centre: [1.7, 0], size: [1, 1, 4]}]}\n"),
              HasSubstr("stands on the start"));
}

TEST_F(ScenarioTest, AnObstacleOnThePadsWayIsRefused) {
  EXPECT_THAT(Refusal("obstacles:\n  boxes:\n    - {centre: [10, 7.5], size: [1, 1, 4]}\n"),
              AllOf(HasSubstr(":3"), HasSubstr("stands on the pad's way")));
}

TEST_F(ScenarioTest, APadThatCannotBeCaughtIsFlownAfter) {
  EXPECT_EQ(Refusal("pad: {speed: 10}\n"), "accepted");
}

TEST_F(ScenarioTest, AWindDirectionSwitchesTheDrawOff) {
  EXPECT_TRUE(Load("wind: {mean: 3}\n").wind.direction_random);
  EXPECT_FALSE(Load("wind: {mean: 3, direction_deg: 90}\n").wind.direction_random);
  EXPECT_FALSE(Load("wind: {mean: 3}\n", {"wind.direction_deg=0"}).wind.direction_random);
  EXPECT_THAT(Refusal("wind:\n  direction_deg: 90\n  direction_random: true\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("wind.direction_deg has no effect with")));
}

TEST_F(ScenarioTest, AnAirframeWithoutEffectIsRefused) {
  EXPECT_THAT(Refusal("seed: 1\nairframe:\n  rotor_drag: 0.1\n"),
              AllOf(HasSubstr(path_ + ":3"),
                    HasSubstr("airframe.rotor_drag has no effect with vehicle: default")));
  const std::string models = TOUCHDOWN_SOURCE_DIR "/sim/models/";
  EXPECT_THAT(Refusal("vehicle: " + models + "quadrotor.xml\n", {"airframe.feet=[0.1, 0.1]"}),
              AllOf(HasSubstr("--set airframe.feet"), HasSubstr("no effect on " + models)));
  EXPECT_EQ(Refusal("vehicle: " + models + "mini.xml\nairframe: {rotor_drag: 0.1}\n"), "accepted");
}

TEST_F(ScenarioTest, APadMotionIsAskedWhatItNeeds) {
  EXPECT_EQ(Refusal("pad: {motion: random}\n"), "accepted");
  EXPECT_EQ(Refusal("pad: {motion: figure_eight, speed: 10}\nlimits: {speed: 12}\n"), "accepted");
  EXPECT_THAT(
      Refusal(
          "pad:\n  motion: random\nobstacles: {boxes: [{centre: [40, 40], size: [1, 1, 1]}]}\n"),
      AllOf(HasSubstr(path_ + ":2"), HasSubstr("without obstacles")));
  EXPECT_THAT(Refusal("pad: {motion: random, phase_spread: 1}\n"),
              HasSubstr("pad.phase_spread must be 0"));
  EXPECT_THAT(
      Refusal("pad:\n  motion: stop_and_go\n  stop_time: 2\n"),
      AllOf(HasSubstr(path_ + ":3"), HasSubstr("pad.stop_time is 2; allowed is [3.6, 600]")));
  EXPECT_THAT(Refusal("pad: {motion: waypoints}\n"),
              AllOf(HasSubstr("pad.waypoints"), HasSubstr("none: it cannot be read")));
  std::ofstream(::testing::TempDir() + "sharp.csv") << "t,x,y\n0,0,0\n5,4,0\n10,0,0.1\n";
  EXPECT_THAT(Refusal("pad: {motion: waypoints}\n",
                      {"pad.waypoints=" + ::testing::TempDir() + "sharp.csv"}),
              HasSubstr("sharp.csv: line 3: the path turns by 179 degrees"));
  std::ofstream(::testing::TempDir() + "fast.csv") << "t,x,y\n0,0,0\n1,30,0\n";
  EXPECT_THAT(
      Refusal("pad: {motion: waypoints}\n", {"pad.waypoints=" + ::testing::TempDir() + "fast.csv"}),
      HasSubstr("fast.csv: line 3: the way there is driven at 30.00 m/s; allowed is at most 20"));
}

TEST_F(ScenarioTest, AStartInTheGroundIsRefused) {
  EXPECT_THAT(Refusal("start: {position: [0, 0, 0.1]}\n"), HasSubstr("start.position"));
}

TEST_F(ScenarioTest, AStartOnThePadIsRefused) {
  EXPECT_THAT(Refusal("seed: 1\nstart: {position: [7, 6.5, 0.6]}\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("start.position"), HasSubstr("1.36 m")));
  // Only the drawn phase brings the pad there.
  EXPECT_THAT(Refusal("pad: {phase_spread: 3}\nstart: {position: [9.5, 6.5, 0.6]}\n"),
              HasSubstr("above the deck"));
  EXPECT_EQ(Refusal("start: {position: [7, 6.5, 2]}\n"), "accepted");
  EXPECT_EQ(Refusal("start: {position: [4, 4, 0.6]}\n"), "accepted");
}

TEST_F(ScenarioTest, ALatencyBeyondTheReplanningPeriodIsRefused) {
  EXPECT_THAT(Refusal("planning:\n  rate: 20\n  latency: 60\n"),
              AllOf(HasSubstr(path_ + ":3"), HasSubstr("planning.latency must be in [0, 50] ms"),
                    HasSubstr("not '60'")));
  EXPECT_THAT(Refusal("seed: 1\n", {"planning.latency=101"}),
              AllOf(HasSubstr("--set planning.latency=101"), HasSubstr("[0, 100] ms")));
  // The rate is the chosen value; the latency has its default.
  EXPECT_THAT(Refusal("seed: 1\nplanning: {rate: 100}\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("[0, 10] ms"), HasSubstr("not '20'")));
  // A third of a second is 166.7 time steps: some steps follow each other after 166.
  EXPECT_THAT(Refusal("planning: {rate: 3, latency: 333}\n"), HasSubstr("[0, 332] ms"));
  EXPECT_EQ(Refusal("planning: {rate: 10, latency: 100}\n"), "accepted");
  EXPECT_EQ(Refusal("planning: {rate: 100, latency: measured}\n"), "accepted");
}

TEST_F(ScenarioTest, AClearanceBeyondTheMapIsRefused) {
  EXPECT_THAT(Refusal("planning: {clearance: 1.2}\n"),
              HasSubstr("planning.clearance must be a number in [0.1, 1] m"));
  EXPECT_EQ(Refusal("planning: {clearance: 1}\n"), "accepted");
  EXPECT_EQ(Refusal("planning: {clearance: 0.1}\n"), "accepted") << "it is raised";
  EXPECT_THAT(Refusal("planning:\n  clearance: 0.25\nplanner: ego\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("planning.clearance must be in [0.3, 1] m"),
                    HasSubstr("with planner ego, not '0.25'")));
}

TEST_F(ScenarioTest, AWholeNumberIsWholeAndInItsRange) {
  EXPECT_EQ(Refusal("planning: {guides: 3}\n"), "accepted");
  for (const char* value : {"0", "9", "1.5", "two", "[2]"}) {
    EXPECT_THAT(Refusal(std::string("planning: {guides: ") + value + "}\n"),
                AllOf(HasSubstr(path_ + ":1"),
                      HasSubstr("planning.guides must be a whole number in [1, 8]")))
        << value;
  }
}

TEST_F(ScenarioTest, ACeilingBelowWhatIsFlownIsRefused) {
  EXPECT_THAT(Refusal("planning: {ceiling: 2.5}\n"),
              AllOf(HasSubstr(path_ + ":1"), HasSubstr("planning.ceiling must be in (2.5, 1000] m"),
                    HasSubstr("start.position with its spread")));
  EXPECT_THAT(Refusal("planning: {ceiling: 3}\nstart: {position_spread: [0, 0, 1]}\n"),
              HasSubstr("(3.5, 1000] m"));
  EXPECT_THAT(Refusal("planning: {ceiling: 2}\nstart: {position: [0, 0, 1]}\n"),
              HasSubstr("(2.12, 1000] m, above the height at which the pad is followed"));
}

TEST_F(ScenarioTest, AMotionThatThePadCannotDriveNamesItsKey) {
  EXPECT_THAT(Refusal("pad:\n  motion: circle\n  turn_rate: 0\n"),
              AllOf(HasSubstr(path_ + ":3"), HasSubstr("pad.turn_rate")));
  EXPECT_THAT(Refusal("pad:\n  speed: 0\n"), AllOf(HasSubstr(":2"), HasSubstr("pad.speed")));
  EXPECT_THAT(Refusal("pad:\n  turn_deg: 1\n"), AllOf(HasSubstr(":2"), HasSubstr("turn_deg")));
  EXPECT_EQ(Refusal("pad: {turn_rate: -0.25}\n"), "accepted");
}

TEST_F(ScenarioTest, ADirectoryIsNoScenario) {
  try {
    FindScenario("/tmp");
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/tmp"), HasSubstr("directory")));
  }
}

TEST_F(ScenarioTest, AVehicleFileThatIsNotThereIsRefused) {
  EXPECT_THAT(Refusal("vehicle: no/such/file.xml\n"), HasSubstr("no/such/file.xml"));
  // A file that is no MJCF: MuJoCo answers with several lines.
  EXPECT_THAT(Refusal("vehicle: /etc/passwd\n"),
              AllOf(HasSubstr(path_ + ":1: vehicle /etc/passwd: "), Not(HasSubstr("\n"))));
}

TEST_F(ScenarioTest, OverridesGoThroughTheSameTable) {
  EXPECT_EQ(Load("seed: 5\n", {"seed=6", "pad.speed=1.5"}).seed, 6U);
  EXPECT_EQ(Load("seed: 1\n", {"start.position=[1, 2, 3]"}).start.position,
            Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(Refusal("seed: 1\n", {"pad.speed=11"}),
              AllOf(HasSubstr("--set pad.speed=11"), HasSubstr("[0.01, 10] m/s")));
  EXPECT_THAT(Refusal("seed: 1\n", {"nonsense=9"}), HasSubstr("unknown key nonsense"));
  EXPECT_THAT(Refusal("seed: 1\n", {"nonsense"}), HasSubstr("write KEY=VALUE"));
  EXPECT_THAT(Refusal("seed: 1\n", {"depth.cameras[0].rate=5"}),
              HasSubstr("a list is set as a whole: depth.cameras=[...]"));
  EXPECT_THAT(Refusal("seed: 1\n", {"start.position=[1, 2]"}),
              HasSubstr("must be a list of 3 numbers in [-500, 500] m, not [1, 2]"));
  // There is no line to name.
  EXPECT_THAT(Refusal("seed: 1\n", {"pad.start=[1"}), HasSubstr("--set pad.start=[1: end of "));
  EXPECT_THAT(Refusal("seed: 1\n", {"pad=3"}), HasSubstr("--set pad=3: pad must be a map"));
}

TEST_F(ScenarioTest, AMissingFileNamesTheShippedOnes) {
  EXPECT_THROW(FindScenario("no_such_scenario"), BadInput);
  try {
    FindScenario("no_such_scenario");
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("no_such_scenario"), HasSubstr("straight_turn")));
  }
}

TEST(ScenarioSchema, EveryKeyIsDocumentedOnce) {
  std::set<std::string> names;
  for (const auto& key : ScenarioKeys(StandardRegistries())) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_FALSE(key.doc.empty()) << key.name;
    EXPECT_FALSE(key.range.empty()) << key.name;
  }
}

TEST(ScenarioSchema, TheDocumentationIsTheTable) {
  std::ifstream file(TOUCHDOWN_SOURCE_DIR "/docs/reference/scenario_keys.md");
  std::ostringstream text;
  text << file.rdbuf();
  const std::string tables = ScenarioKeysMarkdown(StandardRegistries());
  EXPECT_NE(text.str().find(tables), std::string::npos)
      << "docs/reference/scenario_keys.md must hold:\n"
      << tables;
}

}  // namespace
}  // namespace touchdown::evaluation
