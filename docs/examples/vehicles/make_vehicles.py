#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the vehicles of this folder, each a model in the common form with its airframe file beside it, and
vehicles drawn at random.

    make_vehicles.py                    the five of this folder
    make_vehicles.py --random 7 FOLDER  one of seed 7: FOLDER/vehicle_7.xml and its airframe file
"""
import argparse
import dataclasses
import math
import pathlib
import random


@dataclasses.dataclass
class Vehicle:
    """A multirotor. Lengths in m, about the geometric middle; x forward, z up."""
    name: str
    says: str
    mass: float  # [kg]
    arm: float  # of a rotor's hub from the middle
    rotors: int = 4  # 0: one thrust and three moments
    first_deg: float = 45.0  # azimuth of rotor 0
    centre: tuple = (0.0, 0.0, 0.0)  # of mass
    moments: tuple = (0.0, 0.0, 0.0)  # principal moments of inertia [kg m^2]
    turn_deg: tuple = (0.0, 0.0, 0.0)  # of their axes: roll, pitch, yaw
    thrust_to_weight: float = 2.2
    torque: float = 0.016  # reaction torque per newton [m]
    lag: float = 0.035  # [s]
    drag: float = 0.0  # of the rotors [N s/m]
    area: float = 0.0  # of the body's drag [m^2]
    rises: tuple = (0.0,)  # of the hubs, by turns
    order: tuple = ()  # of the actuators in the file; empty: around the body
    said_moments: float = 1.0  # of those that the model can make, in its file
    senses: tuple = ()  # of the reaction torques in the file, where they are wrong; empty: by turns

    @property
    def radius(self):  # of a rotor's disc: those beside each other leave a tenth of their radius
        return 0.95 * self.arm * math.sin(math.pi / max(self.rotors, 4))

    @property
    def thrust(self):
        return self.thrust_to_weight * self.mass * 9.81


def numbers(*values):
    return " ".join(f"{round(value, 12):.6g}" for value in values)


def hubs(v):
    count = max(v.rotors, 4)  # those of a model without rotors are only seen
    for i in range(count):
        azimuth = math.radians(v.first_deg + 360.0 * i / count)
        yield i, (v.arm * math.cos(azimuth), v.arm * math.sin(azimuth), 0.1 * v.arm + v.rises[i % len(v.rises)])


def actuators(v):
    if v.rotors == 0:
        roll, yaw = 0.35 * v.thrust * v.arm, 0.7 * v.thrust * v.torque
        rows = [f'<motor name="thrust" site="middle" ctrlrange="0 {v.thrust:.6g}" gear="0 0 1 0 0 0"/>']
        for axis, most in (("x", roll), ("y", roll), ("z", yaw)):
            gear = " ".join("-1" if a == axis else "0" for a in "xyz")
            said = v.said_moments * most
            rows.append(f'<motor name="about_{axis}" site="middle" ctrlrange="{-said:.6g} {said:.6g}" gear="0 0 0 {gear}"/>')
        return rows
    most = v.thrust / v.rotors
    rows = [f'<motor name="motor{i}" site="hub{i}" ctrlrange="0 1" gear="0 0 {numbers(most)} 0 0 '
            f'{numbers(most * v.torque * (v.senses[i] if v.senses else 1 - 2 * (i % 2)))}"/>' for i in range(v.rotors)]
    return [rows[i] for i in v.order or range(v.rotors)]


def model(v):
    lines = ["<!-- SPDX-License-Identifier: BSD-3-Clause -->", f"<!-- {v.says} Made by make_vehicles.py. -->",
             f'<mujoco model="{v.name}">', '  <compiler autolimits="true"/>', "  <worldbody>",
             f'    <body name="{v.name}" pos="0 0 0.5">', "      <freejoint/>",
             f'      <inertial pos="{numbers(*v.centre)}" mass="{v.mass:.6g}" diaginertia="{numbers(*v.moments)}" '
             f'euler="{numbers(*v.turn_deg)}"/>',
             f'      <geom type="box" size="{numbers(0.4 * v.arm, 0.3 * v.arm, 0.15 * v.arm)}" rgba="0.2 0.3 0.5 1"/>',
             '      <site name="middle"/>']
    for i, hub in hubs(v):
        lines += [f'      <geom type="capsule" size="{numbers(0.04 * v.arm)}" fromto="0 0 0 {numbers(*hub)}" rgba="0.2 0.2 0.2 1"/>',
                  f'      <geom type="cylinder" size="{numbers(v.radius, 0.02 * v.arm)}" pos="{numbers(*hub)}" rgba="0.3 0.6 0.9 0.4"/>',
                  f'      <site name="hub{i}" pos="{numbers(*hub)}"/>']
    lines += ["    </body>", "  </worldbody>", "  <actuator>"]
    lines += [f"    {row}" for row in actuators(v)]
    return "\n".join([*lines, "  </actuator>", "</mujoco>", ""])


def airframe(v):
    lines = [f"# What {v.name}.xml does not say.", f"rotor_lag: {v.lag:.4g}",
             f"rotor_drag: {v.drag:.4g}", f"body_drag_area: {v.area:.4g}"]
    if v.rotors == 0 and v.said_moments != 1.0:
        roll, yaw = 0.35 * v.thrust * v.arm, 0.7 * v.thrust * v.torque
        lines.append(f"moment_max: [{roll:.4g}, {roll:.4g}, {yaw:.4g}]")
    if v.senses:
        lines.append("rotor_senses: auto")
    return "\n".join([*lines, ""])


def write(v, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{v.name}.xml").write_text(model(v))
    (folder / f"{v.name}.airframe.yaml").write_text(airframe(v))


def scaled(v, mass, draw=lambda low, high: 1.0):
    """Arms, inertia, lag and drag as those of vehicles of that mass are; `draw` spreads each."""
    v.mass = mass
    v.arm = 0.17 * (mass / 1.18) ** (1 / 3) * draw(0.8, 1.25)
    flat = 0.29 * mass * v.arm ** 2 * draw(0.7, 1.3)
    side = flat * draw(0.8, 1.25)
    v.moments = (flat, side, min(1.7 * flat * draw(0.9, 1.1), 0.97 * (flat + side)))  # of a flat plate: the sum
    v.torque = 0.094 * v.arm * draw(0.7, 1.3)
    v.lag = 0.035 * (v.arm / 0.17) ** 0.6 * draw(0.8, 1.25)
    v.drag = 0.16 * mass * draw(0.5, 1.5)
    v.area = 1.04 * v.arm ** 2 * draw(0.5, 1.5)
    return v


def drawn(seed):
    rng = random.Random(seed)
    rotors = rng.choice([4, 4, 6, 8, 0])
    v = Vehicle(name=f"vehicle_{seed}", says=f"Drawn from seed {seed}.", mass=0.0, arm=0.0, rotors=rotors)
    scaled(v, math.exp(rng.uniform(math.log(0.025), math.log(6.0))), rng.uniform)
    v.first_deg = rng.choice([0.0, 180.0 / max(rotors, 4)])
    v.centre = tuple(rng.uniform(-0.1, 0.1) * v.arm for _ in range(3))
    v.turn_deg = tuple(rng.uniform(-25.0, 25.0) for _ in range(3))
    v.thrust_to_weight = rng.uniform(1.8, 3.5)
    v.rises = (0.0, rng.uniform(0.0, 0.2) * v.arm)
    v.order = tuple(rng.sample(range(rotors), rotors))
    if rotors == 0:
        v.centre = (0.0, 0.0, v.centre[2])  # one thrust has to go through it
    return v


NAMED = [
    scaled(Vehicle("nano", "A quadrotor of 27 g; its battery lies askew.", 0, 0, centre=(0.002, 0.001, -0.002),
                   turn_deg=(0, 8, 20)), 0.027),
    scaled(Vehicle("cargo", "A quadrotor of 5 kg whose load hangs behind the middle.", 0, 0, centre=(-0.02, 0.0, -0.03),
                   turn_deg=(0, 12, 0), thrust_to_weight=2.0), 5.0),
    scaled(Vehicle("hexa", "A hexarotor of 2.4 kg; every other rotor sits higher.", 0, 0, rotors=6, first_deg=30.0,
                   rises=(0.0, 0.03)), 2.4),
    scaled(Vehicle("survey", "A quadrotor of 1.3 kg, front rotors higher, axes of inertia turned. The file's senses of rotation are wrong: "
                   "-, +, +, - around the body.", 0, 0, turn_deg=(0, 9, 0), rises=(0.03, 0.0, 0.0, 0.03), senses=(-1, 1, 1, -1)), 1.3),
    scaled(Vehicle("wrench", "One thrust and three moments, as models that know no rotors have them. The moments of the file "
                   "are a hundredth of what 0.5 kg need.", 0, 0, rotors=0, said_moments=0.01), 0.5),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--random", type=int, metavar="SEED")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    arguments = parser.parse_args()
    for v in [drawn(arguments.random)] if arguments.random is not None else NAMED:
        write(v, arguments.folder)


if __name__ == "__main__":
    main()
