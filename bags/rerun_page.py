"""Takes a screenshot of a recording in rerun's viewer, without a display.

    rerun_page.py BAG.mcap PICTURE.png

Needs PyPI's `rerun-sdk` (0.41.0 was used) and a Vulkan driver; Mesa's lavapipe or SwiftShader will do. No option
and no conversion is needed to open the file: `rerun BAG.mcap`. This script only arranges the views.
"""

import os
import signal
import subprocess
import sys
import time

import rerun as rr
import rerun.blueprint as rrb
from rerun.experimental import ViewerClient

VIEWER = ["rerun", "--headless", "--window-size", "1400x800", "--renderer", "vulkan"]
# Times that a software renderer needs to start, and to draw the loaded data [s].
BEGINNING, DRAWING = 5, 25


def main(bag, picture):
    clouds = ["/jamgrip/grains", "/jamgrip/membrane", "/tf", "/tf_static"]
    views = rrb.Horizontal(
        rrb.Spatial3DView(name="grains and membrane", origin="/", contents=clouds),
        rrb.TimeSeriesView(name="pressure", origin="/jamgrip/pressure"),
        column_shares=[3, 2],
    )
    closed = rrb.SelectionPanel(state="hidden"), rrb.TimePanel(state="collapsed")
    blueprint = rrb.Blueprint(views, rrb.BlueprintPanel(state="expanded"), *closed)
    # The program is started by a script: both end together.
    viewer = subprocess.Popen(VIEWER, start_new_session=True)
    try:
        time.sleep(BEGINNING)
        rr.init("jamgrip")
        rr.connect_grpc(default_blueprint=blueprint)
        rr.send_blueprint(blueprint)
        rr.log_file_from_path(bag)
        time.sleep(DRAWING)
        ViewerClient().save_screenshot(picture)
        time.sleep(BEGINNING)
    finally:
        os.killpg(viewer.pid, signal.SIGTERM)


main(*sys.argv[1:])
