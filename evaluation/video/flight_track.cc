// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/flight_track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/table_rows.h"

namespace touchdown::evaluation {
namespace {

constexpr char kTrue[] = "true";   // source of a state, beside the estimates
constexpr double kFarthest = 1e5;  // that anything is from the origin [m]

void CheckTime(const TableRows& rows, double t, const std::vector<TrackSample>& before) {
  if (!before.empty() && t <= before.back().vehicle.t) {
    rows.Refuse(fmt::format("holds the time {:g} s twice", t));
  }
}

Eigen::Vector3d Place(TableRows* rows) {
  const Eigen::Vector3d p_W = rows->Vector3();
  if (p_W.norm() > kFarthest) rows->Refuse("holds a place beyond 100 km");
  return p_W;
}

Eigen::Quaterniond Attitude(TableRows* rows) {
  const double w = rows->Number();
  const Eigen::Vector3d q = rows->Vector3();
  const Eigen::Quaterniond q_WB(w, q.x(), q.y(), q.z());
  if (std::abs(q_WB.norm() - 1.0) > 0.01) rows->Refuse("holds a quaternion that is no unit one");
  return q_WB.normalized();
}

std::vector<TrackSample> ReadSamples(SqliteDb& db) {
  std::vector<TrackSample> samples;
  TableRows vehicle(db, "vehicle", "source, t, px, py, pz, vx, vy, vz, qw, qx, qy, qz, wx, wy, wz",
                    "t");
  while (vehicle.Next()) {
    if (vehicle.Text() != kTrue) continue;
    const double t = vehicle.Time();
    CheckTime(vehicle, t, samples);
    estimation::VehicleState& s = samples.emplace_back().vehicle;
    s.t = t;
    s.p_WB = Place(&vehicle);
    s.v_WB = vehicle.Vector3();
    s.q_WB = Attitude(&vehicle);
    s.w_WB_B = vehicle.Vector3();
  }
  if (samples.empty()) vehicle.Refuse("holds no true state");
  TableRows pad(db, "pad", "source, t, px, py, pz, vx, vy, vz, yaw, yaw_rate", "t");
  auto sample = samples.begin();
  while (pad.Next()) {
    if (pad.Text() != kTrue) continue;
    if (sample == samples.end() || pad.Number() != sample->vehicle.t) {
      pad.Refuse("does not agree with the table vehicle");
    }
    estimation::PadState& s = (sample++)->pad;
    s.p_WP = Place(&pad);
    s.v_WP = pad.Vector3();
    s.yaw = pad.Number();
    s.yaw_rate = pad.Number();
  }
  if (sample != samples.end()) pad.Refuse("does not agree with the table vehicle");
  return samples;
}

// A table with a source, the true states aside, and one row a sample.
template <typename Read>
void ReadEachSample(TableRows rows, const std::vector<TrackSample>& samples,
                    std::vector<TrackFigures>* figures, const Read& read) {
  std::size_t i = 0;
  while (rows.Next()) {
    if (rows.Text() == kTrue) continue;
    if (i == samples.size() || rows.Number() != samples[i].vehicle.t) {
      rows.Refuse("does not agree with the true states");
    }
    read(&rows, &(*figures)[i++]);
  }
  if (i != samples.size()) rows.Refuse("does not agree with the true states");
}

std::vector<TrackFigures> ReadFigures(SqliteDb& db, const std::vector<TrackSample>& samples) {
  std::vector<TrackFigures> figures(samples.size());
  const auto each = [&](const char* table, const char* columns, const auto& read) {
    ReadEachSample(TableRows(db, table, columns, "t"), samples, &figures, read);
  };
  each("vehicle", "source, t, px, py, pz",
       [](TableRows* rows, TrackFigures* f) { f->p_believed_WB = Place(rows); });
  each("reference", "'', t, px, py, pz",
       [](TableRows* rows, TrackFigures* f) { f->p_reference_WB = Place(rows); });
  each("air", "'', t, vx, vy, vz",
       [](TableRows* rows, TrackFigures* f) { f->v_air_W = rows->Vector3(); });
  each("mode", "'', t, mode", [](TableRows* rows, TrackFigures* f) { f->mode = rows->Text(); });
  each("rotor", "'', t, thrust0, thrust1, thrust2, thrust3, thrust4, thrust5, thrust6, thrust7",
       [](TableRows* rows, TrackFigures* f) {
         constexpr int kMostRotors = 8;
         for (int rotor = 0; rotor < kMostRotors; ++rotor) {
           // Those that the vehicle does not have are empty.
           if (const std::optional<double> thrust = rows->Optional()) f->thrusts.push_back(*thrust);
         }
       });
  return figures;
}

std::vector<TrackBelief> ReadBeliefs(SqliteDb& db) {
  std::vector<TrackBelief> beliefs;
  TableRows pad(db, "pad",
                "source, t, px, py, pz, vx, vy, vz, yaw, yaw_rate, cov_xx, cov_xy, cov_yy", "t");
  while (pad.Next()) {
    if (pad.Text() == kTrue) continue;
    TrackBelief& belief = beliefs.emplace_back();
    belief.t = pad.Time();
    belief.pad.p_WP = Place(&pad);
    belief.pad.v_WP = pad.Vector3();
    belief.pad.yaw = pad.Number();
    belief.pad.yaw_rate = pad.Number();
    const double xx = pad.Number(), xy = pad.Number();
    belief.pad.cov_p << xx, xy, xy, pad.Number();
  }
  return beliefs;
}

std::vector<TrackEvent> ReadEvents(SqliteDb& db) {
  std::vector<TrackEvent> events;
  TableRows mode(db, "mode", "t, mode", "t LIMIT 1");  // the first one is no event
  while (mode.Next()) {
    const double t = mode.Time();
    events.push_back({t, "mode", mode.Text()});
  }
  TableRows rows(db, "event", "t, kind, text", "rowid");
  while (rows.Next()) {
    TrackEvent& event = events.emplace_back();
    event.t = rows.Time();
    event.kind = rows.Text();
    event.text = rows.Text();
  }
  return events;
}

std::optional<TrackTouchdown> ReadTouchdown(SqliteDb& db) {
  SqliteStatement row = db.Prepare("SELECT value FROM meta WHERE key = 'result_json'");
  if (!row.Step()) throw std::invalid_argument("its table meta lacks result_json");
  const nlohmann::json result = nlohmann::json::parse(row.Text(0), nullptr, false);
  if (!result.is_object()) throw std::invalid_argument("its result_json is no JSON object");
  if (!result.value("landed", false)) return std::nullopt;
  return TrackTouchdown{result.at("time_to_land_s").get<double>(),
                        result.at("touchdown").at("error_m").get<double>()};
}

}  // namespace

FlightTrack::FlightTrack(const std::string& record_path) {
  try {
    SqliteDb db(record_path, SqliteDb::Mode::kReadOnly);
    samples_ = ReadSamples(db);
    figures_ = ReadFigures(db, samples_);
    beliefs_ = ReadBeliefs(db);
    events_ = ReadEvents(db);
    touchdown_ = ReadTouchdown(db);
  } catch (...) {
    RethrowNaming(record_path, "record");
  }
}

TrackSample FlightTrack::At(double t) const {
  const auto after = std::upper_bound(
      samples_.begin(), samples_.end(), t,
      [](double time, const TrackSample& sample) { return time < sample.vehicle.t; });
  if (after == samples_.begin()) return samples_.front();
  if (after == samples_.end()) return samples_.back();
  const TrackSample& a = *(after - 1);
  const TrackSample& b = *after;
  const double s = (t - a.vehicle.t) / (b.vehicle.t - a.vehicle.t);
  const auto mix = [s](const Eigen::Vector3d& from, const Eigen::Vector3d& to) -> Eigen::Vector3d {
    return from + s * (to - from);
  };
  TrackSample sample;
  sample.vehicle.t = t;
  sample.vehicle.p_WB = mix(a.vehicle.p_WB, b.vehicle.p_WB);
  sample.vehicle.v_WB = mix(a.vehicle.v_WB, b.vehicle.v_WB);
  sample.vehicle.q_WB = a.vehicle.q_WB.slerp(s, b.vehicle.q_WB);
  sample.vehicle.w_WB_B = mix(a.vehicle.w_WB_B, b.vehicle.w_WB_B);
  sample.pad.p_WP = mix(a.pad.p_WP, b.pad.p_WP);
  sample.pad.v_WP = mix(a.pad.v_WP, b.pad.v_WP);
  sample.pad.yaw = a.pad.yaw + s * estimation::WrapAngle(b.pad.yaw - a.pad.yaw);
  sample.pad.yaw_rate = a.pad.yaw_rate + s * (b.pad.yaw_rate - a.pad.yaw_rate);
  return sample;
}

}  // namespace touchdown::evaluation
