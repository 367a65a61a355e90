#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes docs/landing.gif, which opens the README: a landing a quarter faster than real time, ten pictures a second. What
# is even is made quite even before colours are counted: that saves a quarter of the file.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

build/release/bin/touchdown land forest --seed 10 --video "$folder/landing.mp4"
ffmpeg -loglevel error -y -i "$folder/landing.mp4" -final_delay 200 -filter_complex \
  'setpts=PTS/1.25,fps=10,scale=480:-1:flags=lanczos,bilateral=sigmaS=4:sigmaR=0.06,split[a][b];
   [a]palettegen=max_colors=72[colors];[b][colors]paletteuse=dither=none' docs/landing.gif
