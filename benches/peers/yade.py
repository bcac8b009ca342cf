"""The packing of `jamgrip bench --peers` in YADE: yade -jN -n -x yade.py, with the numbers of the case in the
environment variable JAMGRIP_CASE as JSON."""

import json
import math
import os
import sys
import time

# yade's own names are in scope when it runs a script.
case = json.loads(os.environ["JAMGRIP_CASE"])
friction = math.atan(case["friction"])
stuff = O.materials.append(
    FrictMat(young=case["young"], poisson=case["poisson"], density=case["density"], frictionAngle=friction)
)
with open(case["data"]) as lines:
    for line in lines:
        x, y, z, radius, vx, vy, vz, wx, wy, wz = map(float, line.split())
        grain = sphere((x, y, z), radius, material=stuff)
        grain.state.vel, grain.state.angVel = (vx, vy, vz), (wx, wy, wz)
        O.bodies.append(grain)
n_grains = len(O.bodies)
for axis, length in enumerate((case["lx"], case["ly"], case["lz"])):
    O.bodies.append(wall(0, axis, sense=1, material=stuff))
    O.bodies.append(wall(length, axis, sense=-1, material=stuff))
along = case["g"] / math.hypot(case["gx"], case["gz"])
bounce = case["restitution"]
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=case["skin"] / 2),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=bounce, es=bounce)],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(damping=0, gravity=(along * case["gx"], 0, along * case["gz"])),
]
O.dt = case["dt"]


def n_contacts():
    return sum(1 for it in O.interactions if it.isReal and it.id1 < n_grains and it.id2 < n_grains)


O.run(case["warm"], True)
before = n_contacts()
start = time.perf_counter()
O.run(case["steps"], True)
wall_s = time.perf_counter() - start
moving = sum(0.5 * it.state.mass * it.state.vel.squaredNorm() for it in O.bodies if it.id < n_grains)
print("JAMGRIP loop", wall_s)
print("JAMGRIP contacts", before, n_contacts(), "kinetic_energy", moving)
sys.stdout.flush()
# YADE prompts for confirmation when it exits.
os._exit(0)
