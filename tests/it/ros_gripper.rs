//! What drivers of vacuum grippers offer, asked of the whole program; and ticks that wait for a
//! controller.

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
    private_network::{inside, reach},
    ros_program::{Client, Running, wait_until},
};

fn topic(name: &str) -> Topic {
    let found = topics(&scene()).into_iter().find(|it| it.name == name);
    let topic = found.unwrap_or_else(|| panic!("no topic `{name}`"));
    // Everything is to be heard here, whatever a reader of set-points would do.
    Topic { qos: Qos { depth: 1000, ..topic.qos }, ..topic }
}

/// Takes all that came on a topic; the last.
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
        let hidden = |what: &str| format!("{name}/_action/{what}");
        Self {
            send: Client::typed(node, &hidden("send_goal"), A::TYPE.send_goal),
            result: Client::typed(node, &hidden("get_result"), A::TYPE.get_result),
            cancel: Client::of::<CancelGoal>(node, &hidden("cancel_goal")),
        }
    }

    fn send<G: serde::Serialize>(&mut self, id: u8, goal: G) -> bool {
        let goal_id = UUID { uuid: [id; 16] };
        let answer: SendGoalResponse = self.send.ask(&SendGoalRequest { goal_id, goal });
        answer.accepted
    }

    fn result<R: serde::de::DeserializeOwned>(&mut self, id: u8) -> GetResultResponse<R> {
        self.result.ask(&GetResultRequest { goal_id: UUID { uuid: [id; 16] } })
    }

    fn cancel(&mut self, id: u8) -> CancelGoalResponse {
        let goal_info = GoalInfo { goal_id: UUID { uuid: [id; 16] }, ..Default::default() };
        self.cancel.ask(&CancelGoalRequest { goal_info })
    }
}

fn grip(position: f64, max_effort: f64) -> GripperCommandGoal {
    GripperCommandGoal { command: GripperCommand { position, max_effort } }
}

/// The default scene's pump (Pa).
const STRONGEST: f64 = 95e3;

fn set_state(node: &RosNode, state: u8) {
    let mut client = Client::of::<srv::SetSimulationState>(node, "set_simulation_state");
    let state = SimulationState { state };
    let answer: SetSimulationStateResponse = client.ask(&SetSimulationStateRequest { state });
    assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
}

/// Oracle: the meaning that the actions' definitions and MoveIt give to their fields, in shares of
/// the pump's strongest vacuum. Tolerance: a goal counts as reached within 5 % of that.
#[test]
fn a_gripper_is_driven_by_its_actions() {
    inside("ros_gripper::a_gripper_is_driven_by_its_actions", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Running::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let ready = node.subscription::<Bool>(&topic("/jamgrip/ready")).unwrap();
        let vacuum = node.subscription::<VacuumState>(&topic("/jamgrip/vacuum_state")).unwrap();
        set_state(&node, SimulationState::STATE_PLAYING);
        wait_until("readiness", || last(&ready).is_some_and(|it| it.data));

        let mut gripper = Action::of::<action::GripperCommand>(&node, "gripper_cmd");
        for (id, senseless) in [(1, grip(1.5, 0.0)), (2, grip(f64::NAN, 0.0)), (3, grip(-0.1, 0.0))]
        {
            assert!(!gripper.send(id, senseless), "goal {id} makes no sense");
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
        let answer: SetBoolResponse = grip_cmd.ask(&SetBoolRequest { data: true });
        assert!(answer.success, "{}", answer.message);
        let is_set = |it: VacuumState| (it.gauge_setpoint + STRONGEST).abs() < 1e-6;
        wait_until("full vacuum", || last(&vacuum).is_some_and(is_set));
    });
}

/// Oracle: the action protocol of ROS 2: a cancelled goal ends as such, once, and a new goal aborts
/// the one before.
#[test]
fn goals_are_cancelled_and_replaced() {
    inside("ros_gripper::goals_are_cancelled_and_replaced", || {
        let folder = tempfile::tempdir().unwrap();
        // A pump that takes its time, so that goals are still on their way.
        let _program = Running::start(folder.path(), &["chamber.lag=20 s"]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        set_state(&node, SimulationState::STATE_PLAYING);
        let mut gripper = Action::of::<action::GripperCommand>(&node, "gripper_cmd");
        assert!(gripper.send(1, grip(1.0, 0.0)));
        assert!(!gripper.send(1, grip(1.0, 0.0)), "an id can be used once");
        assert!(gripper.send(2, grip(0.9, 0.0)));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(1);
        assert_eq!(ended.status, GoalStatus::STATUS_ABORTED, "the first goal");
        let answer = gripper.cancel(2);
        assert_eq!((answer.return_code, answer.goals_canceling.len()), (0, 1));
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(2);
        assert_eq!(ended.status, GoalStatus::STATUS_CANCELED, "the second goal");
        assert_eq!(gripper.cancel(2).return_code, CancelGoalResponse::ERROR_GOAL_TERMINATED);
        assert_eq!(gripper.cancel(9).return_code, CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID);
        let ended: GetResultResponse<GripperCommandResult> = gripper.result(9);
        assert_eq!(ended.status, GoalStatus::STATUS_UNKNOWN, "no such goal");
    });
}

/// Oracle: the weight of the whole gripper, read before; zero after. Tolerance: while nothing moves
/// the reading changes by a thousandth of that from tick to tick.
#[test]
fn the_wrist_sensor_is_set_to_zero() {
    inside("ros_gripper::the_wrist_sensor_is_set_to_zero", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Running::start(folder.path(), &["outputs.state_rate=1000 Hz"]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let wrench = node.subscription::<WrenchStamped>(&topic("/jamgrip/flange/wrench")).unwrap();
        wait_until("the sensor", || 0 < node.n_writers("/jamgrip/flange/wrench"));
        set_state(&node, SimulationState::STATE_PAUSED);
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut zero = Client::of::<Trigger>(&node, "zero_ftsensor");
        let mut read = |until_ns: u32| {
            let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 50 });
            assert_eq!(answer.result.result, SimResult::RESULT_OK);
            let mut found = None;
            wait_until("the wrench of the last tick", || {
                found = last(&wrench).or(found.take());
                found.as_ref().is_some_and(|it| it.header.stamp.nanosec == until_ns)
            });
            found.unwrap().wrench.force.z
        };
        let before = read(50_000_000);
        assert!(before < -0.5, "the gripper weighs {before} N");
        let answer: TriggerResponse = zero.ask(&TriggerRequest::default());
        assert!(answer.success, "{}", answer.message);
        let after = read(100_000_000);
        assert!(after.abs() < 0.02 * before.abs(), "{after} N after zeroing {before} N");
    });
}

/// A controller in lockstep: each command answers a clock and lets one tick pass.
struct Controller {
    node: Arc<RosNode>,
    clock: Subscription<Clock>,
    commands: Publisher<Body>,
}

impl Controller {
    /// Waits for a clock beyond `last_ns`, and hears nothing but the next tick.
    fn next_ns(&self, last_ns: i64) -> i64 {
        let mut heard = Vec::new();
        wait_until("a tick", || {
            while let Ok(Some((message, _))) = self.clock.take() {
                let stamp = message.clock;
                let time_ns = i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec);
                if time_ns != last_ns {
                    heard.push(time_ns);
                }
            }
            !heard.is_empty()
        });
        assert_eq!(heard, [last_ns + 1_000_000], "one command, one tick");
        heard[0]
    }

    fn answer(&self, time_ns: i64, share: f64, height: f64) {
        let mut header = Header::default();
        header.stamp.sec = i32::try_from(time_ns / 1_000_000_000).unwrap();
        header.stamp.nanosec = u32::try_from(time_ns % 1_000_000_000).unwrap();
        let message = JointState {
            header,
            name: ["vacuum", "flange_z"].map(str::to_owned).to_vec(),
            position: vec![share, height],
            ..Default::default()
        };
        self.commands.publish(Body::new(message.to_cdr())).unwrap();
    }

    /// The object's state after a reset and `n` ticks under a motion told by time alone.
    fn episode(&self, n: u32) -> EntityState {
        let mut reset = Client::of::<srv::ResetSimulation>(&self.node, "reset_simulation");
        let scope = ResetSimulationRequest::SCOPE_ALL;
        let answer: ResetSimulationResponse = reset.ask(&ResetSimulationRequest { scope });
        assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
        // The reset publishes the start, so that nothing older is still to come.
        wait_until("the clock of the reset", || {
            last(&self.clock).is_some_and(|it| (it.clock.sec, it.clock.nanosec) == (0, 0))
        });
        let mut time_ns = 0;
        for i in 0..n {
            let way = f64::from(i) / f64::from(n);
            self.answer(time_ns, way, 0.101 - 0.02 * way);
            time_ns = self.next_ns(time_ns);
        }
        look(&self.node)
    }
}

/// The object's state.
fn look(node: &RosNode) -> EntityState {
    let mut client = Client::of::<srv::GetEntityState>(node, "get_entity_state");
    let entity = "cylinder".to_owned();
    let answer: GetEntityStateResponse = client.ask(&GetEntityStateRequest { entity });
    answer.state
}

fn stamp_ns(header: &Header) -> i64 {
    i64::from(header.stamp.sec) * 1_000_000_000 + i64::from(header.stamp.nanosec)
}

/// Oracle: counting, and the same bits twice. A command acts in the very next tick.
#[test]
fn a_controller_in_lockstep_misses_no_tick() {
    inside("ros_gripper::a_controller_in_lockstep_misses_no_tick", || {
        let folder = tempfile::tempdir().unwrap();
        let changes = ["topics.lockstep=wait_command", "outputs.pressure_rate=1000 Hz"];
        let _program = Running::start(folder.path(), &changes);
        let node = RosNode::join_as("controller", &reach()).unwrap();
        let vacuum = node.subscription::<VacuumState>(&topic("/jamgrip/vacuum_state")).unwrap();
        let controller = Controller {
            clock: node.subscription::<Clock>(&topic("/clock")).unwrap(),
            commands: node.publisher(&topic("/jamgrip/joint_commands")).unwrap(),
            node: Arc::clone(&node),
        };
        wait_until("the node's ear", || 0 < node.n_readers("/jamgrip/joint_commands"));
        // While it waits for a first command it publishes the start again and again.
        wait_until("the first clock", || last(&controller.clock).is_some());
        wait_until("the chamber", || 0 < node.n_writers("/jamgrip/vacuum_state"));
        set_state(&node, SimulationState::STATE_PLAYING);
        let n = std::env::var("JAMGRIP_LOCKSTEP_TICKS").map_or(200, |it| it.parse().unwrap());
        let first = controller.episode(n);
        assert_eq!(first, controller.episode(n), "two episodes of {n} ticks");
        // What was commanded at the end of a tick is set at the end of the next one.
        let time_ns = i64::from(n) * 1_000_000;
        controller.answer(time_ns, 0.75, 0.101);
        let now_ns = controller.next_ns(time_ns);
        let mut seen = None;
        wait_until("the state of that tick", || {
            seen = last(&vacuum).or(seen.take());
            seen.as_ref().is_some_and(|it| stamp_ns(&it.header) == now_ns)
        });
        let seen = seen.unwrap();
        assert!((seen.gauge_setpoint + 0.75 * STRONGEST).abs() < 1e-6, "{}", seen.gauge_setpoint);
    });
}

/// Oracle: the other clock. Time comes to it and stands there, and nobody else publishes it.
#[test]
fn time_follows_the_clock_of_another_simulator() {
    inside("ros_gripper::time_follows_the_clock_of_another_simulator", || {
        let folder = tempfile::tempdir().unwrap();
        let changes = ["topics.lockstep=external_clock", "outputs.state_rate=1000 Hz"];
        let _program = Running::start(folder.path(), &changes);
        let node = RosNode::join_as("other", &reach()).unwrap();
        let joints = node.subscription::<JointState>(&topic("/jamgrip/joint_states")).unwrap();
        let clock = node.publisher(&topic("/clock")).unwrap();
        wait_until("the node's ear", || 0 < node.n_readers("/clock"));
        for milliseconds in [7_u32, 40, 41] {
            let mut message = Clock::default();
            // Half a tick beyond: a tick that would end later does not begin.
            message.clock.nanosec = milliseconds * 1_000_000 + 500_000;
            let mut now = None;
            wait_until("that time", || {
                // Again and again, as clocks do: the first ones may come before the node knows this one.
                clock.publish(Body::new(message.to_cdr())).unwrap();
                now = last(&joints).map(|it| it.header.stamp.nanosec).or(now);
                now.is_some_and(|it| milliseconds * 1_000_000 <= it)
            });
            // Between two ticks the program answers questions: had it gone on, it would show by now.
            for _ in 0..10 {
                let answer: EntityState = look(&node);
                assert_eq!(answer.header.stamp.nanosec, milliseconds * 1_000_000);
            }
            let now = last(&joints).map_or(now.unwrap(), |it| it.header.stamp.nanosec);
            assert_eq!(now, milliseconds * 1_000_000, "time stands at the other clock");
        }
        assert_eq!(node.n_writers("/clock"), 0, "nobody else publishes it");
    });
}
