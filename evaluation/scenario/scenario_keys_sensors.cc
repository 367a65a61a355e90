// SPDX-License-Identifier: BSD-3-Clause
// Keys of the sensors for pad and obstacles, and of the use of their data.
#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation::schema {

void AddCameraKeys(KeyList& keys) {
  keys.push_back(Whole("camera.width", 16, 2048, "pixels of the downward camera in a row",
                       TOUCHDOWN_AT(camera.width)));
  keys.push_back(
      Whole("camera.height", 16, 2048, "rows of the downward camera", TOUCHDOWN_AT(camera.height)));
  keys.push_back(Number<Scenario>("camera.fov_deg", In(10, 150, "deg"),
                                  "vertical field of view of the downward camera",
                                  TOUCHDOWN_AT(camera.fov_deg)));
  keys.push_back(Number<Scenario>("camera.noise", In(0, 100, ""),
                                  "sensing rendered: standard deviation of a pixel in grey levels "
                                  "of 255; the model of sensing fast is fitted at 2",
                                  TOUCHDOWN_AT(camera.noise)));
  keys.push_back(Number<Scenario>("camera.exposure_ms", In(0, 100, "ms"),
                                  "sensing rendered: exposure, over which motion blurs the image",
                                  TOUCHDOWN_AT(camera.exposure_ms)));
  keys.push_back(Number<Scenario>("camera.latency_ms", In(0, 400, "ms"),
                                  "from the middle of the exposure until the pad's pose is known",
                                  TOUCHDOWN_AT(camera.latency_ms)));
  keys.push_back(Number<Scenario>("camera.drop", In(0, 1, ""),
                                  "probability of each image of the downward camera to be lost",
                                  TOUCHDOWN_AT(camera.drop)));
  keys.push_back(Vector<2, Scenario>("camera.outage", In(0, 600, "s"),
                                     "the downward camera takes no image from the first time to "
                                     "the second; none is missing if they are equal",
                                     TOUCHDOWN_AT(camera.outage)));
  keys.push_back(Number<Scenario>("camera.occlusion", In(0, 0.9, ""),
                                  "share of the pad's printed sheet under an opaque plate, from "
                                  "its front edge on",
                                  TOUCHDOWN_AT(camera.occlusion)));
}

void AddDepthKeys(KeyList& keys) {
  keys.push_back(Whole("depth.width", 8, 1024,
                       "pixels of the depth camera in a row; 160 is recommended for sensing "
                       "rendered",
                       TOUCHDOWN_AT(depth.width)));
  keys.push_back(Whole("depth.height", 8, 1024,
                       "rows of the depth camera; 120 is recommended for sensing rendered",
                       TOUCHDOWN_AT(depth.height)));
  keys.push_back(
      Number<Scenario>("depth.range", In(1, 12, "m"),
                       "farthest that the depth camera sees; what it has to see to brake "
                       "bounds the speed of the vehicle",
                       TOUCHDOWN_AT(depth.range)));
  keys.push_back(Number<Scenario>("depth.noise", In(0, 0.3, ""),
                                  "standard deviation of a range over the range",
                                  TOUCHDOWN_AT(depth.noise)));
  keys.push_back(Number<Scenario>("depth.latency_ms", In(0, 400, "ms"),
                                  "from the depth image to the map",
                                  TOUCHDOWN_AT(depth.latency_ms)));
  keys.push_back(Number<Scenario>("depth.drop", In(0, 1, ""),
                                  "probability of each depth image to be lost",
                                  TOUCHDOWN_AT(depth.drop)));
  keys.push_back(Vector<2, Scenario>("depth.outage", In(0, 600, "s"),
                                     "the depth camera takes no image from the first time to the "
                                     "second; none is missing if they are equal",
                                     TOUCHDOWN_AT(depth.outage)));
}

void AddSensorKeys(KeyList& keys) {
  keys.push_back(Number<Scenario>("gps.sigma", In(0, 5, "m"),
                                  "standard deviation of the pad's GPS, each axis; the pad filter "
                                  "assumes at least 1 mm",
                                  TOUCHDOWN_AT(gps.sigma)));
  keys.push_back(Number<Scenario>("gps.rate", Above(0, 100, "Hz"), "rate of the pad's GPS",
                                  TOUCHDOWN_AT(gps.rate)));
  keys.push_back(Vector<2, Scenario>("gps.outage", In(0, 600, "s"),
                                     "no fix comes from the first time to the second; none is "
                                     "missing if they are equal",
                                     TOUCHDOWN_AT(gps.outage)));
  keys.push_back(Number<Scenario>("gps.outliers", In(0, 1, ""),
                                  "probability of each fix to be off by gps.outlier_size, "
                                  "without a larger sigma",
                                  TOUCHDOWN_AT(gps.outliers)));
  keys.push_back(Number<Scenario>("gps.outlier_size", In(0, 1000, "m"),
                                  "error of an outlier, in any direction",
                                  TOUCHDOWN_AT(gps.outlier_size)));
  keys.push_back(Number<Scenario>("tags.rate", Above(0, 100, "Hz"), "rate of the downward camera",
                                  TOUCHDOWN_AT(tag_rate)));
  AddCameraKeys(keys);
  keys.push_back(Number<Scenario>("depth.rate", Above(0, 100, "Hz"),
                                  "rate of the depth camera; 5 s without an image end in a hold",
                                  TOUCHDOWN_AT(depth_rate)));
  AddDepthKeys(keys);
  keys.push_back(Text(
      "map.prior", "none or the path of an OctoMap file (.bt or .ot)",
      "what is believed of the obstacles before the flight, in cells of any size (docs/worlds.md)",
      TOUCHDOWN_AT(map_prior)));
  keys.push_back(
      Choice("map.observed_free", {"sensed", "truth"},
             "which cells stops may use: what the depth camera saw free, or, for studies "
             "alone, all that no obstacle reaches into",
             TOUCHDOWN_AT(map_observed_free)));
  keys.push_back(Number<Scenario>("map.thinnest_obstacle", In(0.01, 1, "m"),
                                  "obstacles of this thickness are always seen: where a thinner "
                                  "one fits between two pixels, no cell becomes free",
                                  TOUCHDOWN_AT(map_thinnest_obstacle)));
  keys.push_back(
      Number<Scenario>("map.start_free", In(0.5, 3, "m"),
                       "this far around the start, and 0.45 m from the hull at least, cells are "
                       "given as free; those that are not count as falsely free",
                       TOUCHDOWN_AT(map_start_free)));
  keys.push_back(Choice("sensing", {"fast", "rendered"},
                        "fast: models of both cameras; rendered: images, in which the pad is found",
                        TOUCHDOWN_AT(sensing)));
  keys.push_back(
      Choice("estimator.pad", {"paper", "turn_rate"}, "pad filter", TOUCHDOWN_AT(pad_estimator)));
}

}  // namespace touchdown::evaluation::schema
