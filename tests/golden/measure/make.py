"""Reference values for `src/measure`: makes `voronoi.json` and `overlap.json` beside this file.

    python -m venv venv && venv/bin/pip install numpy==2.* pyvoro2==0.8.0 overlap==0.2.0
    venv/bin/python tests/golden/measure/make.py

pyvoro2 wraps voro++ (Rycroft 2009); overlap is the library of Strobl, Formella & Poschel (2016).
Written as JSON with 17 digits; the tests compare volumes with a relative tolerance.
"""

import json
import pathlib

import numpy as np
import overlap
import pyvoro2

HERE = pathlib.Path(__file__).parent


def scattered(rng, n, low, high, radii, period=None):
    """Random sequential addition of spheres that do not touch."""
    places = []
    for i in range(n):
        while True:
            margin = 0.0 if period is not None else radii[i]
            place = rng.uniform(low + margin, high - margin)
            separation = np.array(places).reshape(-1, 3) - place
            if period is not None:
                separation -= period * np.round(separation / period)
            if (np.linalg.norm(separation, axis=1) > radii[:i] + radii[i]).all():
                break
        places.append(place)
    return np.array(places)


def packing(name, points, radii, low, high, periodic=False):
    corners = tuple(zip(map(float, low), map(float, high)))
    if periodic:
        domain = pyvoro2.OrthorhombicCell(corners, periodic=(True, True, True))
    else:
        domain = pyvoro2.Box(corners)
    cells = pyvoro2.compute(points, domain=domain, mode="power", radii=radii, include_empty=True,
                            output="cells")
    volumes = [0.0] * len(points)
    neighbors = [[]] * len(points)
    for cell in cells:
        volumes[cell["id"]] = cell["volume"]
        neighbors[cell["id"]] = sorted(face["adjacent_cell"] for face in cell["faces"])
    return {"name": name, "periodic": periodic, "low": list(map(float, low)),
            "high": list(map(float, high)), "positions": points.tolist(), "radii": radii.tolist(),
            "volumes": volumes, "n_faces": [len(it) for it in neighbors]}


def packings():
    rng = np.random.default_rng(13)
    low, high = np.zeros(3), np.array([1.0, 1.2, 0.9])
    n = 120
    mono = np.full(n, 0.075)
    yield packing("equal spheres in a box", scattered(rng, n, low, high, mono), mono, low, high)
    poly = np.sort(rng.uniform(0.02, 0.1, n))[::-1].copy()
    yield packing("spheres of many sizes in a box", scattered(rng, n, low, high, poly), poly, low, high)
    places = scattered(rng, n, low, high, poly, period=high)
    yield packing("spheres of many sizes, periodic", places, poly, low, high, periodic=True)
    wide = np.array([8.0, 0.6, 0.5])
    few = rng.uniform(0.05, 0.2, 60)
    places = rng.uniform(low, wide, (60, 3))
    yield packing("spheres that overlap in a channel, some hidden", places, few, low, wide)


def overlaps():
    rng = np.random.default_rng(7)
    for _ in range(120):
        center = rng.uniform(-1.0, 1.0, 3)
        radius = rng.uniform(0.1, 1.5)
        low = rng.uniform(-1.2, 0.2, 3)
        high = low + rng.uniform(0.05, 1.5, 3)
        (x, y, z), (u, v, w) = low, high
        box = overlap.Hexahedron([(x, y, z), (u, y, z), (u, v, z), (x, v, z),
                                  (x, y, w), (u, y, w), (u, v, w), (x, v, w)])
        volume = overlap.overlap_volume(overlap.Sphere(tuple(center), radius), box)
        yield {"center": center.tolist(), "radius": radius, "low": low.tolist(), "high": high.tolist(),
               "volume": volume}


def write(name, rows):
    text = ",\n".join(json.dumps(row) for row in rows)
    (HERE / name).write_text("[\n" + text + "\n]\n")


write("voronoi.json", list(packings()))
write("overlap.json", list(overlaps()))
