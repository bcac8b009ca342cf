//! The interfaces of vacuum gripper drivers, tested with the whole program; and ticks that wait for
//! a controller.

use std::sync::Arc;

use jamgrip::{
    ros::node::{Body, Publisher, RosNode, Subscription},
    wire::{
        actions::{GetResultRequest, GetResultResponse, SendGoalRequest, SendGoalResponse},
        messages::{
            RosAction, RosMessage,
            action_msgs::{
                CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, srv::CancelGoal,
            },
            control_msgs::{
                GripperCommand, GripperCommandGoal, GripperCommandResult,
                ParallelGripperCommandGoal, ParallelGripperCommandResult, action,
            },
            geometry_msgs::WrenchStamped,
            jamgrip_msgs::VacuumState,
            rosgraph_msgs::Clock,
            sensor_msgs::JointState,
            simulation_interfaces::{
                EntityState, GetEntityStateRequest, GetEntityStateResponse, ResetSimulationRequest,
                ResetSimulationResponse, Result as SimResult, SetSimulationStateRequest,
                SetSimulationStateResponse, SimulationState, StepSimulationRequest,
                StepSimulationResponse, srv,
            },
            std_msgs::{Bool, Header},
            std_srvs::{
                SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse,
                srv::{SetBool, Trigger},
            },
            unique_identifier_msgs::UUID,
        },
        topics::{Qos, Topic, topics},
    },
};

use crate::{
    by_tick::scene,
    private_network::{discovery_range, inside},
    ros_program::{Client, Program, wait_until},
};

fn topic(name: &str) -> Topic {
    let found = topics(&scene()).into_iter().find(|it| it.name == name);
    let topic = found.unwrap_or_else(|| panic!("no topic `{name}`"));
    // All messages are needed here, unlike for a reader of setpoints.
    Topic { qos: Qos { depth: 1000, ..topic.qos }, ..topic }
}

/// Takes all waiting messages of a topic and returns the last.
fn last<M: RosMessage + 'static>(subscription: &Subscription<M>) -> Option<M> {
    let mut last = None;
    while let Ok(Some((message, _))) = subscription.take() {
        last = Some(message);
    }
    last
}

/// The clients of one action.
struct Action {
    send: Client,
    result: Client,
    cancel: Client,
}

impl Action {
    fn of<A: RosAction>(node: &RosNode, name: &str) -> Self {
        let action_name = |what: &str| format!("{name}/_action/{what}");
        Self {
            send: Client::typed(node, &action_name("send_goal"), A::TYPE.send_goal),
            result: Client::typed(node, &action_name("get_result"), A::TYPE.get_result),
            cancel: Client::of::<CancelGoal>(node, &action_name("cancel_goal")),
        }
    }

    fn send<G: serde::Serialize>(&mut self, id: u8, goal: G) -> bool {
        let goal_id = UUID { uuid: [id; 16] };
        let response: SendGoalResponse = self.send.call(&SendGoalRequest { goal_id, goal });
        response.accepted
    }

    fn result<R: serde::de::DeserializeOwned>(&mut self, id: u8) -> GetResultResponse<R> {
        self.result.call(&GetResultRequest { goal_id: UUID { uuid: [id; 16] } })
    }

    fn cancel(&mut self, id: u8) -> CancelGoalResponse {
        let goal_info = GoalInfo { goal_id: UUID { uuid: [id; 16] }, ..Default::default() };
        self.cancel.call(&CancelGoalRequest { goal_info })
    }
}

fn grip(position: f64, max_effort: f64) -> GripperCommandGoal {
    GripperCommandGoal { command: GripperCommand { position, max_effort } }
}

/// Strongest vacuum of the default scene's pump (Pa).
const STRONGEST: f64 = 95e3;

fn set_state(node: &RosNode, state: u8) {
    let mut client = Client::of::<srv::SetSimulationState>(node, "set_simulation_state");
    let state = SimulationState { state };
    let response: SetSimulationStateResponse = client.call(&SetSimulationStateRequest { state });
    assert_eq!(response.result.result, SimResult::RESULT_OK, "{}", response.result.error_message);
}

/// Oracle: the fields as defined by the actions and MoveIt, as fractions of the pump's strongest
/// vacuum. Tolerance: a goal counts as reached within 5 % of that.
#[test]
fn a_gripper_is_driven_by_its_actions() {
    inside("ros_gripper::a_gripper_is_driven_by_its_actions", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Program::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let ready = node.subscription::<Bool>(&topic("/jamgrip/ready")).unwrap();
        let vacuum = node.subscription::<VacuumState>(&topic("/jamgrip/vacuum_state")).unwrap();
        set_state(&node, SimulationState::STATE_PLAYING);
        wait_until("readiness", || last(&ready).is_some_and(|it| it.data));

        let mut gripper = Action::of::<action::GripperCommand>(&node, "gripper_cmd");
        for (id, invalid) in [(1, grip(1.5, 0.0)), (2, grip(f64::NAN, 0.0)), (3, grip(-0.1, 0.0))] {
            assert!(!gripper.send(id, invalid), "goal {id} is invalid");
        }
        assert!(gripper.send(4, grip(0.5, 0.0)));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(4);
        assert_eq!((ended.status, ended.result.reached_goal), (GoalStatus::STATUS_SUCCEEDED, true));
        assert!((ended.result.position - 0.5).abs() <= 0.05, "{:?}", ended.result);
        assert!((ended.result.effort / STRONGEST - 0.5).abs() <= 0.05, "{:?}", ended.result);
        assert!(!ended.result.stalled, "nothing is held: {:?}", ended.result);
        // An effort limits the vacuum.
        assert!(gripper.send(5, grip(1.0, 30e3)));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(5);
        assert!((ended.result.effort - 30e3).abs() <= 0.05 * STRONGEST, "{:?}", ended.result);

        let mut parallel =
            Action::of::<action::ParallelGripperCommand>(&node, "parallel_gripper_cmd");
        let command = JointState {
            name: vec!["vacuum".to_owned()],
            position: vec![0.25],
            ..Default::default()
        };
        assert!(parallel.send(6, ParallelGripperCommandGoal { command }));
        let ended: GetResultResponse<ParallelGripperCommandResult> = parallel.result(6);
        assert_eq!(ended.status, GoalStatus::STATUS_SUCCEEDED);
        assert!((ended.result.state.position[0] - 0.25).abs() <= 0.05, "{:?}", ended.result);
        let other = JointState { name: vec!["finger".to_owned()], ..Default::default() };
        assert!(!parallel.send(7, ParallelGripperCommandGoal { command: other }));

        let mut grip_cmd = Client::of::<SetBool>(&node, "grip_cmd");
        let response: SetBoolResponse = grip_cmd.call(&SetBoolRequest { data: true });
        assert!(response.success, "{}", response.message);
        let is_set = |it: VacuumState| (it.gauge_setpoint + STRONGEST).abs() < 1e-6;
        wait_until("full vacuum", || last(&vacuum).is_some_and(is_set));
    });
}

/// Oracle: the ROS 2 action protocol: a canceled goal ends as canceled, once, and a new goal aborts
/// the one before.
#[test]
fn goals_are_canceled_and_replaced() {
    inside("ros_gripper::goals_are_canceled_and_replaced", || {
        let folder = tempfile::tempdir().unwrap();
        // A slow pump, so that goals are still running.
        let _program = Program::start(folder.path(), &["chamber.lag=20 s"]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        set_state(&node, SimulationState::STATE_PLAYING);
        let mut gripper = Action::of::<action::GripperCommand>(&node, "gripper_cmd");
        assert!(gripper.send(1, grip(1.0, 0.0)));
        assert!(!gripper.send(1, grip(1.0, 0.0)), "an ID can be used only once");
        assert!(gripper.send(2, grip(0.9, 0.0)));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(1);
        assert_eq!(ended.status, GoalStatus::STATUS_ABORTED, "the first goal");
        let response = gripper.cancel(2);
        assert_eq!((response.return_code, response.goals_canceling.len()), (0, 1));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(2);
        assert_eq!(ended.status, GoalStatus::STATUS_CANCELED, "the second goal");
        assert_eq!(gripper.cancel(2).return_code, CancelGoalResponse::ERROR_GOAL_TERMINATED);
        assert_eq!(gripper.cancel(9).return_code, CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID);
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(9);
        assert_eq!(ended.status, GoalStatus::STATUS_UNKNOWN, "an unknown goal");
    });
}

/// Oracle: the weight of the whole gripper, measured before; zero after. Tolerance: at rest, the
/// reading changes by a thousandth of that from tick to tick.
#[test]
fn the_wrist_sensor_is_set_to_zero() {
    inside("ros_gripper::the_wrist_sensor_is_set_to_zero", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Program::start(folder.path(), &["outputs.state_rate=1000 Hz"]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let wrench = node.subscription::<WrenchStamped>(&topic("/jamgrip/flange/wrench")).unwrap();
        wait_until("the sensor", || 0 < node.n_writers("/jamgrip/flange/wrench"));
        set_state(&node, SimulationState::STATE_PAUSED);
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut zero = Client::of::<Trigger>(&node, "zero_ftsensor");
        let mut read = |until_ns: u32| {
            let response: StepSimulationResponse = step.call(&StepSimulationRequest { steps: 50 });
            assert_eq!(response.result.result, SimResult::RESULT_OK);
            let mut found = None;
            wait_until("the wrench of the last tick", || {
                found = last(&wrench).or(found.take());
                found.as_ref().is_some_and(|it| it.header.stamp.nanosec == until_ns)
            });
            found.unwrap().wrench.force.z
        };
        let before = read(50_000_000);
        assert!(before < -0.5, "the gripper weighs {before} N");
        let response: TriggerResponse = zero.call(&TriggerRequest::default());
        assert!(response.success, "{}", response.message);
        let after = read(100_000_000);
        assert!(after.abs() < 0.02 * before.abs(), "{after} N after zeroing {before} N");
    });
}

/// A controller in lockstep: it sends a command for each clock message, which allows one tick.
struct Controller {
    node: Arc<RosNode>,
    clock: Subscription<Clock>,
    commands: Publisher<Body>,
}

impl Controller {
    /// Waits for a clock message after `last_ns`, which must be the next tick.
    fn next_ns(&self, last_ns: i64) -> i64 {
        let mut received = Vec::new();
        wait_until("a tick", || {
            while let Ok(Some((message, _))) = self.clock.take() {
                let stamp = message.clock;
                let time_ns = i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec);
                if time_ns != last_ns {
                    received.push(time_ns);
                }
            }
            !received.is_empty()
        });
        assert_eq!(received, [last_ns + 1_000_000], "one command, one tick");
        received[0]
    }

    fn response(&self, time_ns: i64, vacuum: f64, height: f64) {
        let mut header = Header::default();
        header.stamp.sec = i32::try_from(time_ns / 1_000_000_000).unwrap();
        header.stamp.nanosec = u32::try_from(time_ns % 1_000_000_000).unwrap();
        let message = JointState {
            header,
            name: ["vacuum", "flange_z"].map(str::to_owned).to_vec(),
            position: vec![vacuum, height],
            ..Default::default()
        };
        self.commands.publish(Body::new(message.to_cdr())).unwrap();
    }

    /// The state of the object after a reset and `n` ticks of a motion that only depends on time.
    fn episode(&self, n: u32) -> EntityState {
        let mut reset = Client::of::<srv::ResetSimulation>(&self.node, "reset_simulation");
        let scope = ResetSimulationRequest::SCOPE_ALL;
        let response: ResetSimulationResponse = reset.call(&ResetSimulationRequest { scope });
        assert_eq!(
            response.result.result,
            SimResult::RESULT_OK,
            "{}",
            response.result.error_message
        );
        // The reset publishes the start, so that no older messages follow.
        wait_until("the clock of the reset", || {
            last(&self.clock).is_some_and(|it| (it.clock.sec, it.clock.nanosec) == (0, 0))
        });
        let mut time_ns = 0;
        for i in 0..n {
            let way = f64::from(i) / f64::from(n);
            self.response(time_ns, way, 0.101 - 0.02 * way);
            time_ns = self.next_ns(time_ns);
        }
        object_state(&self.node)
    }
}

/// The object's state.
fn object_state(node: &RosNode) -> EntityState {
    let mut client = Client::of::<srv::GetEntityState>(node, "get_entity_state");
    let entity = "cylinder".to_owned();
    let response: GetEntityStateResponse = client.call(&GetEntityStateRequest { entity });
    response.state
}

fn stamp_ns(header: &Header) -> i64 {
    i64::from(header.stamp.sec) * 1_000_000_000 + i64::from(header.stamp.nanosec)
}

/// Oracle: counting, and equal bits in two runs. A command takes effect in the next tick.
#[test]
fn a_controller_in_lockstep_misses_no_tick() {
    inside("ros_gripper::a_controller_in_lockstep_misses_no_tick", || {
        let folder = tempfile::tempdir().unwrap();
        let changes = ["topics.lockstep=wait_command", "outputs.pressure_rate=1000 Hz"];
        let _program = Program::start(folder.path(), &changes);
        let node = RosNode::join_as("controller", &discovery_range()).unwrap();
        let vacuum = node.subscription::<VacuumState>(&topic("/jamgrip/vacuum_state")).unwrap();
        let controller = Controller {
            clock: node.subscription::<Clock>(&topic("/clock")).unwrap(),
            commands: node.publisher(&topic("/jamgrip/joint_commands")).unwrap(),
            node: Arc::clone(&node),
        };
        wait_until("the node's reader", || 0 < node.n_readers("/jamgrip/joint_commands"));
        // While it waits for a first command, it publishes the start repeatedly.
        wait_until("the first clock", || last(&controller.clock).is_some());
        wait_until("the chamber", || 0 < node.n_writers("/jamgrip/vacuum_state"));
        set_state(&node, SimulationState::STATE_PLAYING);
        let n = std::env::var("JAMGRIP_LOCKSTEP_TICKS").map_or(200, |it| it.parse().unwrap());
        let first = controller.episode(n);
        assert_eq!(first, controller.episode(n), "two episodes of {n} ticks");
        // A command at the end of a tick takes effect by the end of the next one.
        let time_ns = i64::from(n) * 1_000_000;
        controller.response(time_ns, 0.75, 0.101);
        let now_ns = controller.next_ns(time_ns);
        let mut state = None;
        wait_until("the state of that tick", || {
            state = last(&vacuum).or(state.take());
            state.as_ref().is_some_and(|it| stamp_ns(&it.header) == now_ns)
        });
        let state = state.unwrap();
        assert!((state.gauge_setpoint + 0.75 * STRONGEST).abs() < 1e-6, "{}", state.gauge_setpoint);
    });
}

/// Oracle: the other clock. The simulation reaches its time and stops there, and publishes no clock
/// itself.
#[test]
fn time_follows_the_clock_of_another_simulator() {
    inside("ros_gripper::time_follows_the_clock_of_another_simulator", || {
        let folder = tempfile::tempdir().unwrap();
        let changes = ["topics.lockstep=external_clock", "outputs.state_rate=1000 Hz"];
        let _program = Program::start(folder.path(), &changes);
        let node = RosNode::join_as("other", &discovery_range()).unwrap();
        let joints = node.subscription::<JointState>(&topic("/jamgrip/joint_states")).unwrap();
        let clock = node.publisher(&topic("/clock")).unwrap();
        wait_until("the node's reader", || 0 < node.n_readers("/clock"));
        for milliseconds in [7_u32, 40, 41] {
            let mut message = Clock::default();
            // Half a tick more: a tick that would end later is not started.
            message.clock.nanosec = milliseconds * 1_000_000 + 500_000;
            let mut now = None;
            wait_until("that time", || {
                // Repeatedly, as clocks do: the first messages may come before the node is matched.
                clock.publish(Body::new(message.to_cdr())).unwrap();
                now = last(&joints).map(|it| it.header.stamp.nanosec).or(now);
                now.is_some_and(|it| milliseconds * 1_000_000 <= it)
            });
            // The program serves requests between ticks: further ticks would show by now.
            for _ in 0..10 {
                let response: EntityState = object_state(&node);
                assert_eq!(response.header.stamp.nanosec, milliseconds * 1_000_000);
            }
            let now = last(&joints).map_or(now.unwrap(), |it| it.header.stamp.nanosec);
            assert_eq!(now, milliseconds * 1_000_000, "time stops at the other clock");
        }
        assert_eq!(node.n_writers("/clock"), 0, "the simulation does not publish it");
    });
}
