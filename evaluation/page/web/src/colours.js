// SPDX-License-Identifier: BSD-3-Clause
// Okabe and Ito's palette: distinct for colour-blind readers as well. Nothing is told by colour alone.
export const BLACK = "#000000", ORANGE = "#E69F00", SKY = "#56B4E9", GREEN = "#009E73", YELLOW = "#F0E442",
  BLUE = "#0072B2", VERMILLION = "#D55E00", PURPLE = "#CC79A7", GREY = "#999999";

export const FLIGHTS = [BLUE, VERMILLION];

export const MODES = {
  hovering: GREY,
  tracking: BLUE,
  landing: VERMILLION,
  disarmed: GREEN,
  hold: ORANGE,
  go_around: PURPLE,
  emergency_stop: BLACK,
};
