#!/usr/bin/env bash
# About: gearpy 1.3.1, a motor of 1 kg m2 and 10 N m at rest drives a wheel of 10 kg m2 through 20 to 60 teeth
# Guess: seen from the wheel the motor has 1 * 3^2 kg m2, so the wheel starts with 30 / 19 rad/s2.
# What happens: it has 1 * 3 kg m2: 30 / 13 rad/s2, and the line is a third faster to its speed. The torque counts as it should.
. "$(dirname "$0")/_setup.sh"
packages gearpy==1.3.1
run <<'PY'
from find import seen
from gearpy.mechanical_objects import DCMotor, SpurGear
from gearpy.powertrain import Powertrain
from gearpy.solver import Solver
from gearpy.units import AngularPosition, AngularSpeed, InertiaMoment, TimeInterval, Torque
from gearpy.utils import add_fixed_joint, add_gear_mating

motor = DCMotor("motor", InertiaMoment(1.0, "kgm^2"), AngularSpeed(1000.0, "rpm"), Torque(10.0, "Nm"))
pinion = SpurGear("pinion", 20, InertiaMoment(1e-9, "kgm^2"))
wheel = SpurGear("wheel", 60, InertiaMoment(10.0, "kgm^2"))
add_fixed_joint(master=motor, slave=pinion)
add_gear_mating(master=pinion, slave=wheel, efficiency=1.0)
wheel.external_torque = lambda angular_position, angular_speed, time: Torque(0.0, "Nm")
wheel.angular_position, wheel.angular_speed = AngularPosition(0.0, "rad"), AngularSpeed(0.0, "rad/s")
Solver(Powertrain(motor=motor)).run(time_discretization=TimeInterval(0.01, "sec"), simulation_time=TimeInterval(40.0, "sec"))
first = wheel.time_variables["angular acceleration"][0].to("rad/s^2").value
torque = wheel.time_variables["driving torque"][0].to("Nm").value
seen(f"torque at the wheel {torque:.3f} N m", abs(torque - 30.0) < 1e-6)
seen(f"acceleration        {first:.4f} rad/s2: 30/13 = {30 / 13:.4f}, 30/19 = {30 / 19:.4f}", abs(first - 30 / 13) < 1e-4)
speeds = [speed.to("rpm").value for speed in wheel.time_variables["angular speed"]]
seconds = 0.01 * next(row for row, speed in enumerate(speeds) if speed > 0.632 * 1000.0 / 3.0)
seen(f"63 % of the speed after {seconds:.1f} s, for 22.1 s", abs(seconds - 15.1) < 0.2)
PY
