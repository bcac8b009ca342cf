//! Zero-copy streams for processes on this host: state, grains and membrane of every tick.
//!
//! The rows are written from the borrowed state straight into memory that readers map: nothing is
//! serialised, nothing is copied in between. Unlike the other sinks this one is called on the
//! tick's own thread, so it never waits: a reader that is slow, stopped or dead loses its oldest
//! sample, and whatever fails is counted and tried again at the next tick.
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

/// First part of the services' names.
pub const PREFIX: &str = "jamgrip";
/// Environment variable that replaces [`PREFIX`], for more than one run on a host.
pub const PREFIX_VARIABLE: &str = "JAMGRIP_STREAM_PREFIX";

/// Samples that a reader can be behind before it loses the oldest.
const BUFFER: usize = 4;
/// Readers of each service.
const SUBSCRIBERS_MAX: usize = 8;

/// Ports may be opened on one thread and used on another.
type Ipc = ipc_threadsafe::Service;

/// The services of one run, open for writing.
pub struct Stream {
    state: Publisher<Ipc, StateRow, ()>,
    grains: Publisher<Ipc, [GrainRow], RowsHeader>,
    membrane: Publisher<Ipc, [VertexRow], RowsHeader>,
    tick: Notifier<Ipc>,
    counters: SinkCounters,
    last_fault: Option<String>,
    _node: Node<Ipc>,
}

/// The doors of a reader: the same services, opened from the other side.
pub struct Services {
    node: Node<Ipc>,
    prefix: String,
}

/// Why the streams could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// The name is not one that iceoryx2 takes.
    #[error("stream name `{name}` is not usable ({reason}): set {PREFIX_VARIABLE} to a short word")]
    Name {
        /// The name.
        name: String,
        /// What iceoryx2 says.
        reason: ServiceNameError,
    },
    /// A service or port could not be made.
    #[error(
        "stream `{name}` could not be opened: {reason}; if another run streams under this name, \
         stop it or set {PREFIX_VARIABLE} to another word"
    )]
    Open {
        /// The name.
        name: String,
        /// What iceoryx2 says.
        reason: String,
    },
}

/// The first part of the services' names: the environment's choice, else [`PREFIX`].
pub fn prefix() -> String {
    std::env::var(PREFIX_VARIABLE)
        .ok()
        .filter(|it| !it.is_empty())
        .unwrap_or_else(|| PREFIX.to_owned())
}

impl Services {
    /// Joins the streams whose names begin with `prefix`.
    ///
    /// # Errors
    /// When iceoryx2 cannot make its files and shared memory.
    pub fn join(prefix: &str) -> Result<Self, StreamError> {
        set_log_level_from_env_or(LogLevel::Error);
        let node = NodeBuilder::new().create::<Ipc>().map_err(|it| refused(prefix, &it))?;
        Ok(Self { node, prefix: prefix.to_owned() })
    }

    /// The service of the state.
    ///
    /// # Errors
    /// When it exists with another layout, or cannot be made.
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
            .map_err(|it| refused(name.as_str(), &it))
    }

    /// The service of the grains.
    ///
    /// # Errors
    /// When it exists with another layout, or cannot be made.
    pub fn grains(&self) -> Result<ListService<GrainRow>, StreamError> {
        self.list("grains")
    }

    /// The service of the membrane's vertices.
    ///
    /// # Errors
    /// When it exists with another layout, or cannot be made.
    pub fn membrane(&self) -> Result<ListService<VertexRow>, StreamError> {
        self.list("membrane")
    }

    /// The event that wakes readers once a tick.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn tick(&self) -> Result<event::PortFactory<Ipc>, StreamError> {
        let name = self.name("tick")?;
        self.node
            .service_builder(&name)
            .event()
            .max_notifiers(1)
            .max_listeners(SUBSCRIBERS_MAX)
            .open_or_create()
            .map_err(|it| refused(name.as_str(), &it))
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
            .map_err(|it| refused(name.as_str(), &it))
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
    /// When another process already writes under this name, or iceoryx2 cannot make its files.
    pub fn open(prefix: &str, n_grains: usize, n_vertices: usize) -> Result<Self, StreamError> {
        let services = Services::join(prefix)?;
        let state = services
            .state()?
            .publisher_builder()
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|it| refused(&format!("{prefix}/state"), &it))?;
        let grains = list_publisher(&services.grains()?, prefix, n_grains)?;
        let membrane = list_publisher(&services.membrane()?, prefix, n_vertices)?;
        let tick = services
            .tick()?
            .notifier_builder()
            .create()
            .map_err(|it| refused(&format!("{prefix}/tick"), &it))?;
        let counters = SinkCounters { name: "stream", ..SinkCounters::default() };
        Ok(Self { state, grains, membrane, tick, counters, last_fault: None, _node: services.node })
    }

    /// Writes one tick and wakes the readers. Never waits; what fails is counted.
    pub fn write(&mut self, view: &View<'_>) {
        match self.send(view) {
            Ok(()) => self.counters.n_written += 1,
            Err(fault) => {
                self.counters.n_failed += 1;
                self.last_fault = Some(fault);
            }
        }
    }

    /// How many ticks were written, and how many failed. Readers count what they missed by the
    /// ticks they see.
    pub fn counters(&self) -> &SinkCounters {
        &self.counters
    }

    /// What went wrong last, for the log; asking clears it.
    pub fn take_fault(&mut self) -> Option<String> {
        self.last_fault.take()
    }

    fn send(&self, view: &View<'_>) -> Result<(), String> {
        // All three are tried, so that one failing service does not starve the others.
        let sent = [self.send_state(view), self.send_grains(view), self.send_membrane(view)];
        self.tick.notify().map_err(|it| format!("tick: {it}"))?;
        sent.into_iter().collect()
    }

    fn send_state(&self, view: &View<'_>) -> Result<(), String> {
        let fault = |it: &dyn std::fmt::Display| format!("state: {it}");
        let sample = self.state.loan_uninit().map_err(|it| fault(&it))?;
        sample.write_payload(StateRow::of(view)).send().map_err(|it| fault(&it))?;
        Ok(())
    }

    fn send_grains(&self, view: &View<'_>) -> Result<(), String> {
        let fault = |it: &dyn std::fmt::Display| format!("grains: {it}");
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
        let mut sample = self.grains.loan_slice_uninit(count).map_err(|it| fault(&it))?;
        *sample.user_header_mut() = header(view, count);
        sample.write_from_fn(|i| GrainRow::of(view, i)).send().map_err(|it| fault(&it))?;
        Ok(())
    }

    fn send_membrane(&self, view: &View<'_>) -> Result<(), String> {
        let fault = |it: &dyn std::fmt::Display| format!("membrane: {it}");
        let count = view.vertex_positions.len();
        let lists = [view.vertex_velocities.len(), view.vertex_contact_forces.len()];
        if lists != [count; 2] {
            return Err(format!("membrane: {count} positions, but lists of {lists:?}"));
        }
        let mut sample = self.membrane.loan_slice_uninit(count).map_err(|it| fault(&it))?;
        *sample.user_header_mut() = header(view, count);
        sample.write_from_fn(|i| VertexRow::of(view, i)).send().map_err(|it| fault(&it))?;
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
        .map_err(|it| refused(prefix, &it))
}

fn header(view: &View<'_>, count: usize) -> RowsHeader {
    RowsHeader { tick: view.snapshot.tick.0, time_ns: view.snapshot.time_ns, count: count as u64 }
}

fn refused(name: &str, reason: &dyn std::fmt::Display) -> StreamError {
    StreamError::Open { name: name.to_owned(), reason: reason.to_string() }
}
