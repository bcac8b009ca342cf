"""Commands a complete pick-and-lift over ROS 2 topics, from an independent DDS implementation.

A small controller of its own, not the project's: it approaches until it touches the object, pushes,
evacuates, lifts, holds, puts back and releases. Meanwhile it reads force, poses, vacuum, membrane
and grains. Prints one JSON line with the results.

With `--lockstep` the simulation waits for its commands, so the run does not depend on the load of the
machine.
"""

import argparse
import json
import math
import time

import ros_types as t
from ros_node import Node, columns, wait_for

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("object", nargs="?", default="cylinder")
parser.add_argument("--lockstep", action="store_true")
arguments = parser.parse_args()
OBJECT, LOCKSTEP = arguments.object, arguments.lockstep

TRAVEL_M_S, PUSH_M_S = 0.10, 0.02
TOUCH_N, PUSH_MAX_N, PUSH_M = 0.1, 60.0, 0.028
GRIP_PA = -90e3
VENT_PA, SETTLE_S, HOLD_S, VENT_S = 5e3, 0.2, 1.2, 0.5
LIFT_M, RETREAT_M = 0.100, 0.040
PERIOD_S = 0.01
SILENCE_S = 60.0  # wall time

node = Node()
clock = node.subscribe("/clock", t.Clock, depth=1000)
wrench = node.subscribe("/jamgrip/wrench", t.WrenchStamped, depth=1000)
flange = node.subscribe("/jamgrip/flange/pose", t.PoseStamped, depth=1000)
target = node.subscribe(f"/jamgrip/object/{OBJECT}/pose", t.PoseStamped, depth=1000)
vacuum = node.subscribe("/jamgrip/vacuum_state", t.VacuumState, depth=1000)
grains = node.subscribe("/jamgrip/grains", t.PointCloud2, depth=1)
membrane = node.subscribe("/jamgrip/membrane", t.PointCloud2, depth=1)
vacuum_cmd = node.publish("/jamgrip/vacuum_cmd", t.Float64)
flange_cmd = node.publish("/jamgrip/flange/pose_cmd", t.PoseStamped)
joint_cmd = node.publish("/jamgrip/joint_commands", t.JointState)
wait_for(vacuum_cmd.get_matched_subscriptions, "the vacuum's subscriber", 300.0)
wait_for(flange_cmd.get_matched_subscriptions, "the flange's subscriber", 300.0)
if LOCKSTEP:
    wait_for(joint_cmd.get_matched_subscriptions, "the joints' subscriber", 300.0)


class Seen:
    """The newest message of every topic, and counters."""

    now = None
    stamps = {}
    force = None
    flange = None
    object = None
    gauge = None
    grain_heights = None
    vertex_heights = None
    n_clouds = 0
    n_membranes = 0
    hold_forces = []
    holding = False

    def look(self):
        for it in clock.take(N=1000):
            self.now = it.clock.seconds()
        for it in wrench.take(N=1000):
            assert it.header.frame_id == "gripper_flange", it.header.frame_id
            self.force = it.wrench.force
            self.stamps["force"] = it.header.stamp.seconds()
            if self.holding:
                self.hold_forces.append(self.force.z)
        for it in flange.take(N=1000):
            self.flange = it.pose
            self.stamps["flange"] = it.header.stamp.seconds()
        for it in target.take(N=1000):
            self.object = it.pose.position
            self.stamps["object"] = it.header.stamp.seconds()
        for it in vacuum.take(N=1000):
            self.gauge = it.gauge
            self.stamps["gauge"] = it.header.stamp.seconds()
        for it in grains.take(N=1):
            read = columns(it)
            self.grain_heights = read["z"]
            assert all(math.isfinite(it) for it in read["z"] + read["fn"]), "grains are finite"
            self.n_clouds += 1
        for it in membrane.take(N=1):
            read = columns(it)
            self.vertex_heights = read["z"]
            assert all(math.isfinite(it) for it in read["z"] + read["strain"]), "vertices are finite"
            self.n_membranes += 1

    def is_complete(self):
        parts = (self.now, self.force, self.flange, self.object, self.gauge)
        return all(it is not None for it in parts + (self.grain_heights, self.vertex_heights))

    def has_all_of(self, seconds):
        """True once all messages that a decision needs have arrived for this time."""
        return all(seconds - 1e-6 < it for it in [self.now, *self.stamps.values()])

    def push(self):
        return math.sqrt(self.force.x**2 + self.force.y**2 + self.force.z**2)


seen = Seen()
received_at = time.monotonic()
called_at = -1e9
while not seen.is_complete():
    assert time.monotonic() - received_at < 300.0, "the run did not begin"
    # The run waits for a first command; poses are known after its first tick.
    if 2.0 < time.monotonic() - called_at:
        if LOCKSTEP:
            joint_cmd.write(t.JointState())
        else:
            vacuum_cmd.write(t.Float64(0.0))
        called_at = time.monotonic()
    seen.look()
    time.sleep(0.001)

position = [seen.object.x, seen.object.y, seen.flange.position.z]
upright = seen.flange.orientation
pressure = 0.0
trace = []


def wait_for_news():
    """Waits for the next tick; in lockstep, for all messages of the last tick that a command allowed."""
    global received_at
    before = seen.now
    while seen.now == before or (LOCKSTEP and not seen.has_all_of(before + PERIOD_S)):
        assert time.monotonic() - received_at < SILENCE_S, "no clock message"
        time.sleep(0.0005)
        seen.look()
    received_at = time.monotonic()


def run_until(is_over, speed=0.0, goal=None):
    """Moves the setpoint to height `goal` at `speed` until it is reached or `is_over()`."""
    sent_at = seen.now
    while not is_over():
        step = PERIOD_S if LOCKSTEP else seen.now - sent_at
        if PERIOD_S <= step:
            sent_at = seen.now
            if goal is not None:
                left = goal - position[2]
                if abs(left) < 1e-9:
                    return False
                position[2] += math.copysign(min(abs(left), speed * step), left)
            pose = t.Pose(t.Point(*position), upright)
            # The stamp of the pose advances time, so the vacuum is sent first.
            vacuum_cmd.write(t.Float64(pressure))
            flange_cmd.write(t.PoseStamped(t.Header(t.Time(), "world"), pose))
        wait_for_news()
    return True


def after(seconds):
    """True once this much simulation time has passed since the call."""
    end = seen.now + seconds
    return lambda: end <= seen.now


def never():
    return False


def mean(samples):
    """Mean weighted by sin², so that a truncated oscillation does not count."""
    weights = [math.sin(math.pi * (i + 0.5) / len(samples)) ** 2 for i in range(len(samples))]
    return sum(w * it for w, it in zip(weights, samples)) / sum(weights)


def mark(name):
    trace.append([name, round(seen.now, 3), round(seen.object.z, 5), round(seen.push(), 3)])


run_until(after(0.1))
mark("approach")
felt = run_until(lambda: TOUCH_N <= seen.push(), TRAVEL_M_S, seen.object.z)
assert felt, "came down to the object's center and felt notarget"
mark("push")
peak_n = 0.0


def pushed_enough():
    global peak_n
    peak_n = max(peak_n, seen.push())
    return PUSH_MAX_N <= seen.push()


run_until(pushed_enough, PUSH_M_S, position[2] - PUSH_M)
run_until(after(SETTLE_S))
mark("evacuate")
pressure = GRIP_PA
gripped = run_until(lambda g=after(5.0): seen.gauge <= 0.95 * GRIP_PA or g())
reached_pa = seen.gauge
run_until(after(SETTLE_S))
rest_z, cloud_z = seen.object.z, sum(seen.grain_heights) / len(seen.grain_heights)
mark("lift")
run_until(never, TRAVEL_M_S, position[2] + LIFT_M)
run_until(after(SETTLE_S))
mark("hold")
hold_from, lowest, highest = seen.now, math.inf, -math.inf
end = after(HOLD_S)
seen.holding = True


def held():
    global lowest, highest
    lowest, highest = min(lowest, seen.object.z), max(highest, seen.object.z)
    return end()


run_until(held)
seen.holding = False
held_s = seen.now - hold_from
cloud_lifted = sum(seen.grain_heights) / len(seen.grain_heights) - cloud_z
mark("lower")
run_until(never, TRAVEL_M_S, position[2] - max(0.0, seen.object.z - rest_z) + 0.005)
run_until(lambda: False, PUSH_M_S, position[2] - 0.005)
pressure = VENT_PA
run_until(after(VENT_S))
mark("retreat")
pressure = 0.0
run_until(never, TRAVEL_M_S, position[2] + RETREAT_M)
run_until(after(SETTLE_S))
mark("end")

print(
    json.dumps(
        {
            "lifted_m": lowest - rest_z,
            "held_s": held_s,
            "peak_push_n": peak_n,
            "gauge_reached_pa": reached_pa,
            "hold_force_z_n": mean(seen.hold_forces),
            "hold_force_swing_n": max(seen.hold_forces) - min(seen.hold_forces),
            "n_hold_forces": len(seen.hold_forces),
            "cloud_lifted_m": cloud_lifted,
            "n_grains": len(seen.grain_heights),
            "n_vertices": len(seen.vertex_heights),
            "n_clouds": seen.n_clouds,
            "n_membranes": seen.n_membranes,
            "put_back_m": seen.object.z - rest_z,
            "let_go_n": seen.push(),
            "trace": trace,
        }
    ),
    flush=True,
)
