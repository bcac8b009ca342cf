"""Calls services and an action with the service mapping of rmw_cyclonedds, on CycloneDDS itself.

Pauses the simulation, steps it by service and by action, grips, and reads a parameter; prints the
results as one JSON line.
"""

import json
import time
import types
from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, float64, int8, int64, sequence, uint8, uint32, uint64

import ros_types as t
from ros_node import Node, wait_for

from cyclonedds.core import Policy, Qos
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


def part(package, name, kind="srv"):
    """The name that ROS 2 gives a half of a service on DDS."""
    return f"{package}::{kind}::dds_::{name}_"


@dataclass
@final
class Result(IdlStruct, typename="simulation_interfaces::msg::dds_::Result_"):
    result: uint8 = 0
    error_message: str = ""


def half(name, package, **fields):
    """A request or response: rmw_cyclonedds puts a client and a number before the fields."""
    annotations = {"client": uint64, "number": int64, **{k: v for k, (v, _) in fields.items()}}
    body = {"__annotations__": annotations, "client": 0, "number": 0}
    body |= {k: default for k, (_, default) in fields.items()}
    kind = "action" if "SendGoal" in name or "GetResult" in name else "srv"
    made = types.new_class(name, (IdlStruct,), {"typename": part(package, name, kind)}, lambda it: it.update(body))
    return final(dataclass(made))


def result_field():
    return (Result, field(default_factory=Result))


SIMULATION = "simulation_interfaces"
GOAL = (array[uint8, 16], field(default_factory=lambda: [0] * 16))
TYPES = {
    "set_simulation_state": (
        half("SetSimulationState_Request", SIMULATION, state=(uint8, 0)),
        half("SetSimulationState_Response", SIMULATION, result=result_field()),
    ),
    "step_simulation": (
        half("StepSimulation_Request", SIMULATION, steps=(uint64, 0)),
        half("StepSimulation_Response", SIMULATION, result=result_field()),
    ),
    "grip_cmd": (
        half("SetBool_Request", "std_srvs", data=(bool, False)),
        half("SetBool_Response", "std_srvs", success=(bool, False), message=(str, "")),
    ),
    "simulate_steps/_action/send_goal": (
        half("SimulateSteps_SendGoal_Request", SIMULATION, goal_id=GOAL, steps=(uint64, 0)),
        half(
            "SimulateSteps_SendGoal_Response",
            SIMULATION,
            accepted=(bool, False),
            stamp=(t.Time, field(default_factory=t.Time)),
        ),
    ),
    "simulate_steps/_action/get_result": (
        half("SimulateSteps_GetResult_Request", SIMULATION, goal_id=GOAL),
        half("SimulateSteps_GetResult_Response", SIMULATION, status=(int8, 0), result=result_field()),
    ),
    "get_parameter_types": (
        half("GetParameterTypes_Request", "rcl_interfaces", names=(sequence[str], field(default_factory=list))),
        half("GetParameterTypes_Response", "rcl_interfaces", types=(sequence[uint8], field(default_factory=list))),
    ),
}


@dataclass
@final
class Feedback(IdlStruct, typename=part(SIMULATION, "SimulateSteps_FeedbackMessage", "action")):
    goal_id: array[uint8, 16]
    completed_steps: uint64 = 0
    remaining_steps: uint64 = 0


class Client:
    """Calls one service below the node."""

    QOS = Qos(
        Policy.Reliability.Reliable(duration(milliseconds=100)),
        Policy.Durability.Volatile,
        Policy.History.KeepLast(10),
    )

    def __init__(self, node, name):
        self.name = name
        self.request, response = TYPES[name]
        participant = node.participant
        request_topic = Topic(participant, f"rq/jamgrip/{name}Request", self.request)
        answer = Topic(participant, f"rr/jamgrip/{name}Reply", response)
        self.writer = DataWriter(participant, request_topic, qos=self.QOS)
        self.reader = DataReader(participant, answer, qos=self.QOS)
        wait_for(
            lambda: self.writer.get_matched_subscriptions()
            and self.reader.get_matched_publications(),
            f"a server of {name}",
        )
        self.number = 0

    def call(self, **fields):
        self.number += 1
        self.writer.write(self.request(client=0x1122334455667788, number=self.number, **fields))
        found = []

        def is_answered():
            for it in self.reader.take(N=10):
                if (it.client, it.number) == (0x1122334455667788, self.number):
                    found.append(it)
            return found

        wait_for(is_answered, f"an answer of {self.name}")
        return found[0]


node = Node()
clock = node.subscribe("/clock", t.Clock, depth=1000)
feedback = node.subscribe("/jamgrip/simulate_steps/_action/feedback", Feedback, depth=100)
paused = Client(node, "set_simulation_state").call(state=2)
time.sleep(0.3)
ticks = {it.clock.seconds() for it in clock.take(N=1000)}
before = max(ticks) if ticks else 0.0

stepped = Client(node, "step_simulation").call(steps=7)
goal = [7] * 16
accepted = Client(node, "simulate_steps/_action/send_goal").call(goal_id=goal, steps=5)
ended = Client(node, "simulate_steps/_action/get_result").call(goal_id=goal)
gripped = Client(node, "grip_cmd").call(data=True)
kinds = Client(node, "get_parameter_types").call(names=["chamber.lag", "nothing", "seed"])
time.sleep(0.3)
after = {it.clock.seconds() for it in clock.take(N=1000)}
steps_reported = [(it.completed_steps, it.remaining_steps) for it in feedback.take(N=100)]
print(
    json.dumps(
        {
            "paused": paused.result.result,
            "stepped": stepped.result.result,
            "accepted": accepted.accepted,
            "status": ended.status,
            "ended": ended.result.result,
            "gripped": gripped.success,
            "types": list(kinds.types),
            "n_ticks": len([it for it in after if it > before]),
            "feedback": steps_reported,
            "listed": node.nodes()["/jamgrip"],
        }
    ),
    flush=True,
)
