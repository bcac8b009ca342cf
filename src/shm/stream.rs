//! Zero-copy streams for processes on this host: state, grains and membrane after every tick.
//!
//! Rows are written from the borrowed state directly to memory that readers map; nothing is
//! serialized or copied. Unlike the other sinks, the stream is written on the thread of the run, so
//! it never blocks: a slow, stopped or dead reader loses its oldest sample. A failed write is
//! counted, and the next tick tries again.
//!
//! | service            | pattern           | payload                                 |
//! |--------------------|-------------------|-----------------------------------------|
//! | `jamgrip/state`    | publish-subscribe | [`StateRow`]                            |
//! | `jamgrip/grains`   | publish-subscribe | `[GrainRow]`, header [`RowsHeader`]     |
//! | `jamgrip/membrane` | publish-subscribe | `[VertexRow]`, header [`RowsHeader`]    |
//! | `jamgrip/tick`     | event             | wakes readers after the three are sent  |

use iceoryx2::{
    port::{notifier::Notifier, publisher::Publisher},
    prelude::{
        AllocationStrategy, BackpressureStrategy, LogLevel, Node, NodeBuilder, ServiceName,
        ZeroCopySend, ipc_threadsafe, set_log_level_from_env_or,
    },
    service::{
        port_factory::{event, publish_subscribe},
        service_name::ServiceNameError,
    },
};

use crate::io::sink::SinkCounters;
use crate::{
    shm::rows::{GrainRow, RowsHeader, StateRow, VertexRow},
    snapshot::view::View,
};

/// First part of the service names.
pub const PREFIX: &str = "jamgrip";
/// Environment variable that replaces [`PREFIX`], for more than one run on a host.
pub const PREFIX_VARIABLE: &str = "JAMGRIP_STREAM_PREFIX";

/// Samples that a reader can lag behind before it loses the oldest.
const BUFFER: usize = 4;
/// Largest number of readers of each service.
const SUBSCRIBERS_MAX: usize = 8;

/// The service type whose ports can be opened on one thread and used on another.
type Ipc = ipc_threadsafe::Service;

/// The services of a run, opened for writing.
pub struct Stream {
    state: Publisher<Ipc, StateRow, ()>,
    grains: Publisher<Ipc, [GrainRow], RowsHeader>,
    membrane: Publisher<Ipc, [VertexRow], RowsHeader>,
    tick: Notifier<Ipc>,
    counters: SinkCounters,
    last_error: Option<String>,
    _node: Node<Ipc>,
}

/// The services of a run, for opening readers.
pub struct Services {
    node: Node<Ipc>,
    prefix: String,
}

/// Why the streams could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// iceoryx2 rejects the name.
    #[error("stream name `{name}` is invalid ({reason}): set {PREFIX_VARIABLE} to a short word")]
    Name {
        /// The name.
        name: String,
        /// Reason given by iceoryx2.
        reason: ServiceNameError,
    },
    /// A service or port could not be created.
    #[error(
        "stream `{name}` could not be opened: {reason}; if another run streams under this name, \
         stop it or set {PREFIX_VARIABLE} to another word"
    )]
    Open {
        /// The name.
        name: String,
        /// Reason given by iceoryx2.
        reason: String,
    },
}

/// The first part of the service names: from the environment, else [`PREFIX`].
pub fn prefix() -> String {
    std::env::var(PREFIX_VARIABLE)
        .ok()
        .filter(|it| !it.is_empty())
        .unwrap_or_else(|| PREFIX.to_owned())
}

impl Services {
    /// Connects to the streams whose names begin with `prefix`.
    ///
    /// # Errors
    /// If iceoryx2 cannot create its files and shared memory.
    pub fn join(prefix: &str) -> Result<Self, StreamError> {
        set_log_level_from_env_or(LogLevel::Error);
        let node = NodeBuilder::new().create::<Ipc>().map_err(|it| open_error(prefix, &it))?;
        Ok(Self { node, prefix: prefix.to_owned() })
    }

    /// The service of the state.
    ///
    /// # Errors
    /// If it exists with another layout, or cannot be created.
    pub fn state(&self) -> Result<publish_subscribe::PortFactory<Ipc, StateRow, ()>, StreamError> {
        let name = self.name("state")?;
        self.node
            .service_builder(&name)
            .publish_subscribe::<StateRow>()
            .history_size(1)
            .subscriber_max_buffer_size(BUFFER)
            .enable_safe_overflow(true)
            .max_publishers(1)
            .max_subscribers(SUBSCRIBERS_MAX)
            .open_or_create()
            .map_err(|it| open_error(name.as_str(), &it))
    }

    /// The service of the grains.
    ///
    /// # Errors
    /// If it exists with another layout, or cannot be created.
    pub fn grains(&self) -> Result<ListService<GrainRow>, StreamError> {
        self.list("grains")
    }

    /// The service of the membrane's vertices.
    ///
    /// # Errors
    /// If it exists with another layout, or cannot be created.
    pub fn membrane(&self) -> Result<ListService<VertexRow>, StreamError> {
        self.list("membrane")
    }

    /// The event that wakes readers after every tick.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn tick(&self) -> Result<event::PortFactory<Ipc>, StreamError> {
        let name = self.name("tick")?;
        self.node
            .service_builder(&name)
            .event()
            .max_notifiers(1)
            .max_listeners(SUBSCRIBERS_MAX)
            .open_or_create()
            .map_err(|it| open_error(name.as_str(), &it))
    }

    fn list<Row>(&self, what: &str) -> Result<ListService<Row>, StreamError>
    where
        Row: ZeroCopySend + std::fmt::Debug + 'static,
    {
        let name = self.name(what)?;
        self.node
            .service_builder(&name)
            .publish_subscribe::<[Row]>()
            .user_header::<RowsHeader>()
            .history_size(1)
            .subscriber_max_buffer_size(BUFFER)
            .enable_safe_overflow(true)
            .max_publishers(1)
            .max_subscribers(SUBSCRIBERS_MAX)
            .open_or_create()
            .map_err(|it| open_error(name.as_str(), &it))
    }

    fn name(&self, what: &str) -> Result<ServiceName, StreamError> {
        let name = format!("{}/{what}", self.prefix);
        ServiceName::new(&name).map_err(|reason| StreamError::Name { name, reason })
    }
}

/// A service whose payload is a list of rows.
pub type ListService<Row> = publish_subscribe::PortFactory<Ipc, [Row], RowsHeader>;

impl Stream {
    /// Opens the services whose names begin with `prefix`, for lists of the given lengths.
    ///
    /// # Errors
    /// If another process already writes under this name, or iceoryx2 cannot create its files.
    pub fn open(prefix: &str, n_grains: usize, n_vertices: usize) -> Result<Self, StreamError> {
        let services = Services::join(prefix)?;
        let state = services
            .state()?
            .publisher_builder()
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|it| open_error(&format!("{prefix}/state"), &it))?;
        let grains = list_publisher(&services.grains()?, prefix, n_grains)?;
        let membrane = list_publisher(&services.membrane()?, prefix, n_vertices)?;
        let tick = services
            .tick()?
            .notifier_builder()
            .create()
            .map_err(|it| open_error(&format!("{prefix}/tick"), &it))?;
        let counters = SinkCounters { name: "stream", ..SinkCounters::default() };
        Ok(Self { state, grains, membrane, tick, counters, last_error: None, _node: services.node })
    }

    /// Writes one tick and wakes the readers. Never blocks; failures are counted.
    pub fn write(&mut self, view: &View<'_>) {
        match self.send(view) {
            Ok(()) => self.counters.n_written += 1,
            Err(error) => {
                self.counters.n_failed += 1;
                self.last_error = Some(error);
            }
        }
    }

    /// Numbers of written and failed ticks. Readers detect missed ticks by the tick numbers.
    pub fn counters(&self) -> &SinkCounters {
        &self.counters
    }

    /// Takes the last error, if any since the last call.
    pub fn take_error(&mut self) -> Option<String> {
        self.last_error.take()
    }

    fn send(&self, view: &View<'_>) -> Result<(), String> {
        // All three are tried, so that a failing service does not affect the others.
        let results = [self.send_state(view), self.send_grains(view), self.send_membrane(view)];
        self.tick.notify().map_err(|it| format!("tick: {it}"))?;
        results.into_iter().collect()
    }

    fn send_state(&self, view: &View<'_>) -> Result<(), String> {
        let error = |it: &dyn std::fmt::Display| format!("state: {it}");
        let sample = self.state.loan_uninit().map_err(|it| error(&it))?;
        sample.write_payload(StateRow::of(view)).send().map_err(|it| error(&it))?;
        Ok(())
    }

    fn send_grains(&self, view: &View<'_>) -> Result<(), String> {
        let error = |it: &dyn std::fmt::Display| format!("grains: {it}");
        let count = view.grain_positions.len();
        let lists = [
            view.grain_velocities.len(),
            view.grain_spins.len(),
            view.grain_radii.len(),
            view.grain_normal_forces.len(),
        ];
        if lists != [count; 4] {
            return Err(format!("grains: {count} positions, but lists of {lists:?}"));
        }
        let mut sample = self.grains.loan_slice_uninit(count).map_err(|it| error(&it))?;
        *sample.user_header_mut() = header(view, count);
        sample.write_from_fn(|i| GrainRow::of(view, i)).send().map_err(|it| error(&it))?;
        Ok(())
    }

    fn send_membrane(&self, view: &View<'_>) -> Result<(), String> {
        let error = |it: &dyn std::fmt::Display| format!("membrane: {it}");
        let count = view.vertex_positions.len();
        let lists = [view.vertex_velocities.len(), view.vertex_contact_forces.len()];
        if lists != [count; 2] {
            return Err(format!("membrane: {count} positions, but lists of {lists:?}"));
        }
        let mut sample = self.membrane.loan_slice_uninit(count).map_err(|it| error(&it))?;
        *sample.user_header_mut() = header(view, count);
        sample.write_from_fn(|i| VertexRow::of(view, i)).send().map_err(|it| error(&it))?;
        Ok(())
    }
}

fn list_publisher<Row>(
    service: &ListService<Row>,
    prefix: &str,
    count: usize,
) -> Result<Publisher<Ipc, [Row], RowsHeader>, StreamError>
where
    Row: ZeroCopySend + std::fmt::Debug + 'static,
{
    service
        .publisher_builder()
        .initial_max_slice_len(count.max(1))
        .allocation_strategy(AllocationStrategy::PowerOfTwo)
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .create()
        .map_err(|it| open_error(prefix, &it))
}

fn header(view: &View<'_>, count: usize) -> RowsHeader {
    RowsHeader { tick: view.snapshot.tick.0, time_ns: view.snapshot.time_ns, count: count as u64 }
}

fn open_error(name: &str, reason: &dyn std::fmt::Display) -> StreamError {
    StreamError::Open { name: name.to_owned(), reason: reason.to_string() }
}
