"""Subscribes to clock, wrench and clouds, and publishes commands, as a user's process would do.

Prints `ready` once its readers are matched, then `received N` for every tick of 1 ms, and one JSON line
when the clock has reached the number of seconds given as argument.
"""

import json
import sys
import time

import ros_types as t
from ros_node import Node, columns, wait_for

until_s = float(sys.argv[1])
node = Node()
clock = node.subscribe("/clock", t.Clock, depth=1000)
wrench = node.subscribe("/jamgrip/wrench", t.WrenchStamped, depth=1000)
grains = node.subscribe("/jamgrip/grains", t.PointCloud2, depth=100)
membrane = node.subscribe("/jamgrip/membrane", t.PointCloud2, depth=100)
status = node.subscribe("/jamgrip/object_detection_status", t.ObjectDetectionStatus, 1, latched=True)
vacuum_cmd = node.publish("/jamgrip/vacuum_cmd", t.Float64)
flange_cmd = node.publish("/jamgrip/flange/pose_cmd", t.PoseStamped)

readers = [clock, wrench, grains, membrane, status]
wait_for(lambda: all(it.get_matched_publications() for it in readers), "publishers")
wait_for(lambda: vacuum_cmd.get_matched_subscriptions(), "the vacuum's subscriber")
wait_for(lambda: flange_cmd.get_matched_subscriptions(), "the flange's subscriber")
nodes = node.nodes()
print("ready", flush=True)

ticks, forces, clouds, membranes, statuses = [], [], 0, 0, []
errors = []
n_published = 0
deadline = time.monotonic() + 120
while (not ticks or ticks[-1] < until_s) and time.monotonic() < deadline:
    for it in clock.take(N=1000):
        ticks.append(it.clock.seconds())
        print("received", round(1000 * ticks[-1]), flush=True)
    for it in wrench.take(N=1000):
        forces.append((it.header.stamp.seconds(), it.wrench.force.z, it.header.frame_id))
    for it in grains.take(N=10):
        clouds += 1
        if clouds == 1:
            read = columns(it)
            if read["id"] != list(range(it.width)):
                errors.append("the IDs of the grains are not 0, 1, 2, …")
    for it in membrane.take(N=10):
        membranes += 1
    statuses += [it.status for it in status.take(N=10)]
    if n_published < 100:
        vacuum_cmd.write(t.Float64(-100.0 * n_published))
        pose = t.Pose(t.Point(0.0, 0.0, 0.001 * n_published), t.Quaternion(0.0, 0.0, 0.0, 1.0))
        stamp = t.Time(n_published, 5)
        flange_cmd.write(t.PoseStamped(t.Header(stamp, "world"), pose))
        n_published += 1
    time.sleep(0.0002)

steps = [round((b - a) * 1e9) for a, b in zip(ticks, ticks[1:])]
print(
    json.dumps(
        {
            "nodes": nodes,
            "n_ticks": len(ticks),
            "n_ticks_missed": sum(it // 1_000_000 - 1 for it in steps),
            "is_clock_steady": all(0 < it for it in steps),
            "n_forces": len(forces),
            "are_forces_right": all(abs(z - round(s * 1000)) < 1e-9 for s, z, _ in forces),
            "wrench_frame": forces[0][2] if forces else "",
            "n_clouds": clouds,
            "n_membranes": membranes,
            "status": statuses[-1] if statuses else None,
            "n_published": n_published,
            "errors": errors,
        }
    ),
    flush=True,
)
