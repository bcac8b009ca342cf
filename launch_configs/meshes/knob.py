"""Writes knob.obj: a lobed, bent knob, 45 mm high, which parallel fingers cannot grip well.

    python3 launch_configs/meshes/knob.py > launch_configs/meshes/knob.obj

Millimeters, z up, with its flat base around the origin.
"""

from math import cos, pi, sin, sqrt

HEIGHT = 45.0
RINGS, SECTORS = 22, 28


def radius(z, angle):
    """A base, a waist at half height, a head with a rounded rim; three lobes that twist with the height."""
    s = z / HEIGHT
    body = 17.0 - 1.5 * sin(pi * s) ** 2
    cap = sqrt(max(0.0, 1.0 - max(0.0, (s - 0.9) / 0.1) ** 2))
    lobes = 1.0 + 0.07 * cos(3.0 * angle + 2.0 * s)
    return body * cap * lobes


def axis(z):
    """Center of the cross-section at height z: the axis is bent."""
    s = z / HEIGHT
    return 1.5 * sin(pi * s), 1.0 * sin(2.0 * pi * s)


def main():
    print("# Made by knob.py beside this file. Millimetres, z up.")
    rings = []
    index = 1
    for k in range(RINGS):
        z = HEIGHT * sin(0.5 * pi * 0.985 * k / (RINGS - 1)) if k else 0.0
        x, y = axis(z)
        rings.append(index)
        for j in range(SECTORS):
            a = 2.0 * pi * j / SECTORS
            r = radius(z, a)
            print(f"v {x + r * cos(a):.4f} {y + r * sin(a):.4f} {z:.4f}")
            index += 1
    bottom, top = index, index + 1
    print("v 0.0000 0.0000 0.0000")
    x, y = axis(HEIGHT)
    print(f"v {x:.4f} {y:.4f} {HEIGHT:.4f}")
    for j in range(SECTORS):
        n = (j + 1) % SECTORS
        print(f"f {bottom} {rings[0] + n} {rings[0] + j}")
        for low, high in zip(rings, rings[1:]):
            print(f"f {low + j} {low + n} {high + n}")
            print(f"f {low + j} {high + n} {high + j}")
        print(f"f {rings[-1] + j} {rings[-1] + n} {top}")


main()
