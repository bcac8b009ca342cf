"""Starts the simulator with a scene, and RViz if it is wanted.

    ros2 launch jamgrip.launch.py scene:=launch_configs/pick_and_lift.yaml rviz:=true

The program is taken from `program`, else from the path. `namespace` and `use_topics` do what their
names say; more parameters of the scene come from `params_file`.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration

HERE = Path(__file__).resolve().parent
ARGUMENTS = {
    "program": ("jamgrip", "the simulator's binary"),
    "scene": (str(HERE.parent / "pick_and_lift.yaml"), "scene file"),
    "namespace": ("/", "namespace of the node"),
    "use_topics": ("true", "true: others command; false: the built-in controller does"),
    "params_file": ("", "file of ROS 2 parameters, keys of the scene"),
    "record": ("false", "true records a bag"),
    "rviz": ("false", "true shows RViz"),
}


def simulator(context):
    """The simulator's process, once the arguments are known."""
    value = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    command = [value["program"], "run", value["scene"]]
    if value["record"] == "false":
        command.append("--no-bag")
    controller = "topics" if value["use_topics"] == "true" else "builtin"
    command += ["--ros-args", "-p", f"controller:={controller}", "-r", f"__ns:={value['namespace']}"]
    if value["params_file"]:
        command += ["--params-file", value["params_file"]]
    return [ExecuteProcess(cmd=command, output="screen", on_exit=Shutdown())]


def generate_launch_description():
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    rviz = ExecuteProcess(
        cmd=["rviz2", "-d", str(HERE / "jamgrip.rviz"), "--ros-args", "-p", "use_sim_time:=true"],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    return LaunchDescription([*arguments, OpaqueFunction(function=simulator), rviz])
