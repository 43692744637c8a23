"""The scenes and studies of study_engines_test.py."""

WORLD = """
[arena]
type = "box"
size_px = [160, 120]
[[swarm]]
count = 40
model = { type = "basic", max_speed = 4 }
start = { type = "edge", direction = "180 deg" }
"""
FILM = """duration = "3.2 s"
[scale]
um_per_px = 1.2
[microscope]
cell_diameter = "2.5 um"
[controller]
type = "manual"
field = ["69 uT", "0 T"]
[[controller.segment]]
at = "0.6 s"
field = ["-69 uT", "0 T"]
[record]
as_seen = true
lossless = true
tracks = false
""" + WORLD
IDENTIFY = """boundary = "box"
look = "positions"
simulations = 150
reversal = "0.6 s"
direction = 0
duration = "2.4 s"
field_strength = "69 uT"
legacy = true
[[video]]
file = "film"
[[model]]
type = "basic"
free = { "swarm[0].model.max_speed" = [1, 12] }
[[model]]
type = "dipole"
speed_sd = "10 um/s"
free = { "swarm[0].model.speed" = ["10 um/s", "200 um/s"] }
"""
CALIBRATION = """study = "identify.toml"
models = ["basic"]
experiments = 20
seed = 5
[[misspecified]]
name = "the times are exact"
timing = "0 s"
experiments = 4
"""
STEER = """duration = "DURATION"
[controller]
type = "fuzzy"
[reference]
type = "hold"
setpoint_px = [80, 60]
""" + WORLD
CONTROLLERS = """scene = "steer.toml"
seeds = SEEDS
delays = [0, 2]
[[controller]]
type = "fuzzy"
[[controller]]
type = "proportional"
"""
