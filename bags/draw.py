"""Draws a recording of a cylinder's pick-and-lift, cut at the plane y = 0.

    pip install mcap mcap-ros2-support matplotlib ruamel.yaml
    python3 bags/draw.py bags/pick_and_lift bags/pick_and_lift.png
"""

import glob
import io
import sys

import matplotlib
import numpy
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from ruamel.yaml import YAML

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend comes first)

folder, picture = sys.argv[1:3]
TOPICS = ["grains", "membrane", "membrane/mesh", "vacuum_state", "wrench", "flange/pose"]


def columns(cloud):
    kinds = {7: "<f4", 6: "<u4"}
    fields = {f.name: (kinds[f.datatype], f.offset) for f in cloud.fields}
    row = numpy.dtype(
        {
            "names": list(fields),
            "formats": [kind for kind, _ in fields.values()],
            "offsets": [offset for _, offset in fields.values()],
            "itemsize": cloud.point_step,
        }
    )
    return numpy.frombuffer(cloud.data, row)


def read():
    messages = {}
    with open(glob.glob(f"{folder}/*.mcap")[0], "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        scene = next(a for a in reader.iter_attachments() if a.name == "scene.yaml")
        names = [f"/jamgrip/{topic}" for topic in TOPICS]
        for _, channel, message, decoded in reader.iter_decoded_messages():
            name = channel.topic
            if name in names or name.endswith("/pose") and "/object/" in name:
                key = "object" if "/object/" in name else name.removeprefix("/jamgrip/")
                messages.setdefault(key, []).append((message.log_time / 1e9, decoded))
    return YAML().load(io.StringIO(scene.data.decode())), messages


def at(series, time):
    return min(series, key=lambda it: abs(it[0] - time))[1]


def cut(triangles, points):
    """Segments in which the triangles meet the plane y = 0."""
    segments = []
    for corners in points[triangles]:
        crossing = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            p, q = corners[a], corners[b]
            if (p[1] < 0.0) != (q[1] < 0.0):
                share = p[1] / (p[1] - q[1])
                crossing.append((p + share * (q - p))[[0, 2]])
        if len(crossing) == 2:
            segments.append(crossing)
    return segments


def draw(axes, time, scene, messages):
    shape = scene["object"]["shape"]["cylinder"]
    length = lambda text: 1e-3 * float(text.removesuffix("mm"))  # noqa: E731
    radius, height = length(shape["radius"]), length(shape["height"])
    center = at(messages["object"], time).pose.position
    corner = (center.x - radius, center.z - height / 2)
    axes.add_patch(plt.Rectangle(corner, 2 * radius, height, fc="#9aa5b1", ec="#52606d"))
    grains = columns(at(messages["grains"], time))
    for grain in grains[numpy.abs(grains["y"]) < grains["radius"]]:
        inside = float(numpy.sqrt(grain["radius"] ** 2 - grain["y"] ** 2))
        color = plt.cm.plasma(min(1.0, float(grain["fn"]) / 20.0))
        axes.add_patch(plt.Circle((grain["x"], grain["z"]), inside, fc=color, ec="none"))
    vertices = columns(at(messages["membrane"], time))
    points = numpy.stack([vertices["x"], vertices["y"], vertices["z"]], axis=1)
    mesh = messages["membrane/mesh"][0][1]
    triangles = numpy.array([t.vertex_indices for t in mesh.triangles])
    for segment in cut(triangles, points):
        axes.plot(*zip(*segment), color="black", lw=1.4)
    flange = at(messages["flange/pose"], time).pose.position
    axes.plot([-0.045, 0.045], [flange.z, flange.z], color="#323f4b", lw=4)
    axes.axhline(0.0, color="#7b8794", lw=3)
    gauge = at(messages["vacuum_state"], time).gauge / 1e3
    force = at(messages["wrench"], time).wrench.force.z
    axes.set_title(f"{time:.2f} s, {gauge:.0f} kPa, {force:.1f} N", fontsize=10)
    axes.set(aspect="equal", xlim=(-0.06, 0.06), ylim=(-0.005, 0.19))
    axes.axis("off")


scene, messages = read()
times = [time for time, _ in messages["grains"]]
gauges = [(time, state.gauge) for time, state in messages["vacuum_state"]]
heights = [(time, pose.pose.position.z) for time, pose in messages["object"]]
jammed = next(time for time, gauge in gauges if gauge < -80e3)
highest = max(height for _, height in heights)
held = [time for time, height in heights if height > highest - 1e-3]
wanted = [times[0], jammed - 0.25, jammed + 0.15, sum(held) / len(held), times[-1]]
figure, panels = plt.subplots(1, len(wanted), figsize=(13, 4.6))
for axes, time in zip(panels, wanted):
    draw(axes, min(times, key=lambda it: abs(it - time)), scene, messages)
figure.tight_layout()
figure.savefig(picture, dpi=110)
