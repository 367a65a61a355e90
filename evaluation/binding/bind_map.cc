// SPDX-License-Identifier: BSD-3-Clause
// Maps: from arrays, points, depth images and OctoMap files.
#include <fstream>

#include "evaluation/base/map_file.h"
#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/map_view.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using planning::OccupancyMap;
using planning::OccupancyMapOptions;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using PointsIn = Eigen::Ref<const Points>;

namespace {

template <class Work>
auto Look(const MapView& look, Work&& work) {
  const InUse::Share share(look.use);
  return work(look.get());
}

template <class Ask>
py::array_t<bool> OfPoints(const MapView& look, const PointsIn& points, const Ask& ask) {
  py::array_t<bool> told(points.rows());
  bool* out = told.mutable_data();
  Look(look, [&](const OccupancyMap& map) {
    WithoutLock([&] {
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        out[i] = ask(map, Eigen::Vector3d(points.row(i)));
      }
    });
  });
  return told;
}

py::array_t<bool> Blocked(const MapView& look, const PointsIn& points) {
  return OfPoints(look, points, [](const OccupancyMap& map, const Eigen::Vector3d& p) {
    return map.IsBlocked(p);
  });
}

py::array_t<bool> ObservedFree(const MapView& look, const PointsIn& points) {
  return OfPoints(look, points, [](const OccupancyMap& map, const Eigen::Vector3d& p) {
    return map.HasIndex(p) && map.IsObservedFree(map.CellOf(p));
  });
}

py::array_t<std::uint8_t> States(const MapView& look) {
  const InUse::Share share(look.use);
  std::vector<planning::CellState> states;
  look.get().CopyStates(&states);
  const Eigen::Vector3i& size = look.get().size();
  py::array_t<std::uint8_t> array({size.z(), size.y(), size.x()});
  static_assert(sizeof(planning::CellState) == 1);
  std::memcpy(array.mutable_data(), states.data(), states.size());
  return array;
}

double FirstBlocked(const MapView& look, const planning::UniformBspline& curve,
                    std::optional<double> t_from, double floor, double ceiling) {
  const InUse::Share share(look.use);
  planning::FreeSpace space;
  space.map = &look.get();
  space.floor = floor;
  space.ceiling = ceiling;
  return planning::FirstBlockedTime(curve, t_from.value_or(curve.t0()), space);
}

/// What reads alone.
template <class Class>
void DefLooks(Class& c) {
  c.def_property_readonly(
       "resolution",
       [](const MapView& l) { return Look(l, [](const auto& map) { return map.resolution(); }); },
       "Side of a cell [m].")
      .def_property_readonly(
          "origin",
          [](const MapView& l) {
            return Look(l, [](const auto& map) { return Eigen::Vector3i(map.origin()); });
          },
          "Lowest cell of the window: the cell of a place p is floor(p / resolution).")
      .def_property_readonly(
          "size",
          [](const MapView& l) {
            return Look(l, [](const auto& map) { return Eigen::Vector3i(map.size()); });
          },
          "Of the window along x, y and z [cells].")
      .def("observed_free", &ObservedFree, "points"_a,
           "Whether the cells of places of shape (n, 3) [m] were observed free: (n,). Out of the "
           "window: no.")
      .def("blocked", &Blocked, "points"_a,
           "Whether places of shape (n, 3) [m] are blocked after inflation: (n,). Out of the "
           "window: no.")
      .def("states", &States,
           "States of the window's cells, shape (size z, size y, size x): 0 unknown, 1 observed "
           "free, 2 occupied, "
           "before inflation.")
      .def("first_blocked", &FirstBlocked, "curve"_a, "t_from"_a = py::none(),
           "floor"_a = -std::numeric_limits<double>::infinity(),
           "ceiling"_a = std::numeric_limits<double>::infinity(), Doc("FirstBlockedTime"))
      .def(
          "count_observed_free",
          [](const MapView& l) {
            return Look(l, [](const auto& map) { return map.CountObservedFree(); });
          },
          Doc("OccupancyMap::CountObservedFree"));
}

template <class Work>
auto Change(OwnMap& map, Work&& work) {
  const InUse::Claim claim(map.use);
  return work(map.map());
}

void SetOccupied(OwnMap& self, const PointsIn& points) {
  if (!points.allFinite()) throw py::value_error("a point is not finite");
  Change(self, [&](OccupancyMap& map) {
    for (Eigen::Index i = 0; i < points.rows(); ++i) map.SetOccupied(points.row(i));
  });
}

void SetStates(OwnMap& self, const py::array& given) {
  const std::string kind = py::str(given.dtype().attr("kind"));
  const bool whole = kind == "i" || kind == "u";
  if (!whole || given.ndim() != 3 ||
      (given.size() > 0 && (py::cast<double>(given.attr("min")()) < 0.0 ||
                            py::cast<double>(given.attr("max")()) > 2.0))) {
    throw py::value_error(
        "states must be whole numbers 0, 1 and 2 of the shape (size z, size y, size x) of the map");
  }
  const py::array_t<std::uint8_t, py::array::c_style> states = given.attr("astype")("uint8");
  Change(self, [&](OccupancyMap& map) {
    const Eigen::Vector3i size = map.size();
    if (states.shape(0) != size.z() || states.shape(1) != size.y() || states.shape(2) != size.x()) {
      throw py::value_error("states has the shape " + std::string(py::str(states.attr("shape"))) +
                            ", it must be (size z, size y, size x) of the map");
    }
    const std::uint8_t* at = states.data();
    planning::ForEachCell({map.origin(), map.origin() + size}, [&](const planning::CellIndex& c) {
      map.SetState(c, static_cast<planning::CellState>(*at++));
    });
  });
}

void ReadOctomap(OwnMap& self, const py::object& given) {
  const std::string path = PathOf(given);
  Change(self, [&](OccupancyMap& map) {
    WithoutLock([&] {
      planning::PersistentMap memory(map.options());
      evaluation::ReadMapFile(path, &memory);
      memory.Refill(&map);
    });
  });
}

void Integrate(OwnMap& self, const estimation::DepthFrame& frame, const planning::PadOutline& pad) {
  Change(self, [&](OccupancyMap& map) { WithoutLock([&] { map.Integrate(frame, pad); }); });
}

}  // namespace

void BindMap(py::module_& m) {
  using Options = OccupancyMapOptions;
  Plain<Options>(m, "OccupancyMapOptions")
      .Field("resolution", &Options::resolution)
      .Field("size_log2", &Options::size_log2)
      .Field("inflation_radius", &Options::inflation_radius)
      .Field("probability_hit", &Options::probability_hit)
      .Field("probability_miss", &Options::probability_miss)
      .Field("probability_min", &Options::probability_min)
      .Field("probability_max", &Options::probability_max)
      .Field("probability_occupied", &Options::probability_occupied)
      .Field("min_ray", &Options::min_ray)
      .Field("thinnest_obstacle", &Options::thinnest_obstacle)
      .Field("range_noise", &Options::range_noise)
      .Field("ground_height", &Options::ground_height)
      .Done();
  using estimation::CameraIntrinsics;
  Plain<CameraIntrinsics>(m, "CameraIntrinsics")
      .Field("width", &CameraIntrinsics::width)
      .Field("height", &CameraIntrinsics::height)
      .Field("focal", &CameraIntrinsics::focal)
      .Field("cx", &CameraIntrinsics::cx)
      .Field("cy", &CameraIntrinsics::cy)
      .Done();
  using estimation::DepthFrame;
  Plain<DepthFrame>(m, "DepthFrame")
      .Field("t", &DepthFrame::t)
      .Field("intrinsics", &DepthFrame::intrinsics)
      .Field("p_WC", &DepthFrame::p_WC)
      .Field("R_WC", &DepthFrame::R_WC)
      .Field("max_range", &DepthFrame::max_range)
      .Field(
          "depth",
          [](const DepthFrame& f) {
            return py::array_t<float>(static_cast<py::ssize_t>(f.depth.size()), f.depth.data());
          },
          [](DepthFrame& f,
             const py::array_t<float, py::array::c_style | py::array::forcecast>& d) {
            f.depth.assign(d.data(), d.data() + d.size());
          })
      .Done();
  using planning::PadOutline;
  Plain<PadOutline>(m, "PadOutline")
      .Field("p_WP", &PadOutline::p_WP)
      .Field("yaw", &PadOutline::yaw)
      .Field("half_size", &PadOutline::half_size)
      .Field("sigma", &PadOutline::sigma)
      .Done();
  py::class_<MapView, std::shared_ptr<MapView>> look(
      m, "MapView", "A map that may be looked at during one call: what planners are given.");
  DefLooks(look);
  py::class_<OwnMap, MapView, std::shared_ptr<OwnMap>>(m, "OccupancyMap", Doc("OccupancyMap"))
      .def(py::init([](const Options* options, const std::optional<Eigen::Vector3d>& centre) {
             auto made = std::make_shared<OwnMap>(options ? *options : Options());
             if (centre) made->map().Recentre(*centre);
             return made;
           }),
           "options"_a = py::none(), "centre"_a = py::none(), Doc("OccupancyMap::OccupancyMap"))
      .def(
          "recentre",
          [](OwnMap& self, const Eigen::Vector3d& p_W) {
            if (!p_W.allFinite()) throw py::value_error("p_W is not finite");
            Change(self, [&](OccupancyMap& map) { map.Recentre(p_W); });
          },
          "p_W"_a, Doc("OccupancyMap::Recentre"))
      .def("set_occupied", &SetOccupied, "points"_a,
           "Sets the cells of points, shape (n, 3) [m], to surely occupied: a point cloud, or "
           "prior knowledge. Those "
           "out of the window are ignored. Raises ValueError where one is not finite.")
      .def("set_states", &SetStates, "states"_a, "All cells of the window as `states` gives them.")
      .def(
          "mark_free",
          [](OwnMap& self, const Eigen::Vector3d& p_W, double radius) {
            Change(self, [&](OccupancyMap& map) { map.MarkFree(p_W, radius); });
          },
          "p_W"_a, "radius"_a, Doc("OccupancyMap::MarkFree"))
      .def(
          "mark_rest_free",
          [](OwnMap& self) { Change(self, [](OccupancyMap& map) { map.MarkRestFree(); }); },
          Doc("OccupancyMap::MarkRestFree"))
      .def("integrate", &Integrate, "frame"_a, "pad"_a = PadOutline(),
           Doc("OccupancyMap::Integrate"))
      .def("read_octomap", &ReadOctomap, "path"_a,
           "Gives the window what an OctoMap file (.bt or .ot) holds occupied or free. What was "
           "read is not observed: "
           "`mark_rest_free` takes the rest for known. Raises ValueError naming the file and what "
           "is wrong with it.");
}

}  // namespace touchdown::binding
