// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/flight_document.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/page/flight_steps.h"
#include "evaluation/page/flight_tables.h"
#include "evaluation/page/flight_vehicle.h"
#include "evaluation/page/rounded.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/true_clearance.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// Between the hull and the nearest obstacle, at every sample [m].
Json ClearanceOf(const RecordedFlight& flight, const Json& vehicle) {
  std::vector<sim::Obstacle> obstacles;
  for (NamedObstacle& named : ObstaclesOf(flight.scenario)) obstacles.push_back(named.obstacle);
  Json json = Json::array();
  if (obstacles.empty()) return json;
  const sim::TrueClearance clearance(sim::ObstacleField(std::move(obstacles)),
                                     sim::LoadVehicleModel(VehicleMjcf(flight.scenario)));
  const auto number = [&vehicle](const char* column, std::size_t i) {
    const Json& value = vehicle[column][i];
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  };
  for (std::size_t i = 0; i < vehicle["t"].size(); ++i) {
    estimation::VehicleState state;
    state.p_WB = {number("px", i), number("py", i), number("pz", i)};
    state.q_WB =
        Eigen::Quaterniond(number("qw", i), number("qx", i), number("qy", i), number("qz", i))
            .normalized();
    const bool known = state.p_WB.allFinite() && state.q_WB.coeffs().allFinite();
    json.push_back(known ? Rounded(clearance.Distance(state), 3) : Json());
  }
  return json;
}

}  // namespace

Json FlightDocument(const std::string& record, const std::string& name,
                    const Registries& registries, const std::function<void(int, int)>& done) {
  RecordedFlight flight = ReadRecord(record, {}, registries);
  flight.path = name;
  return NamingFile(name, "record", [&] {
    SqliteDb db(record, SqliteDb::Mode::kReadOnly);
    Json json = {{"format", "touchdown flight"},
                 {"version", 1},
                 {"name", name},
                 {"scenario", flight.scenario.name},
                 {"planner", flight.scenario.planner},
                 {"backend", flight.scenario.solver_name()},
                 {"seed", flight.scenario.seed},
                 {"own_estimated", flight.scenario.own_state == OwnStateKind::kEstimated},
                 {"max_work", flight.scenario.planning.max_work}};
    json.update(FlightTables(db));
    json["goal"] = GoalDocument(flight.scenario);
    json["vehicle"] = VehicleDocument(flight.scenario);
    json["pad"] = PadDocument(flight.scenario);
    json["map"] = MapDocument(flight);
    json["samples"]["clearance"] = ClearanceOf(flight, json["samples"]["vehicle"]);
    json["steps"] = StepsDocument(flight, registries, done);
    return json;
  });
}

}  // namespace touchdown::evaluation
