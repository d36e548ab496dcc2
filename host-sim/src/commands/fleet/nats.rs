//! Transport over NATS `JetStream`: one stream of frames, and one of estimates.
//!
//! The order of the stream is kept under all circumstances: a consumer that the broker has forgotten, that skipped
//! messages in flight when the connection broke, or that belongs to another run, is created anew after the last message
//! that was processed.

use std::future::IntoFuture;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

use async_nats::jetstream::consumer::{AckPolicy, DeliverPolicy, PullConsumer, pull};
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::{self, Context, Message, stream};
use futures_util::StreamExt;
use futures_util::future::join_all;
use tokio::runtime::Runtime;
use tokio::time::timeout;

use super::silence::Silence;
use super::transport::{Delivery, Estimate, Log, Transport};
use crate::{Error, output};

/// How long messages are awaited before those that have arrived are processed.
const PATIENCE: Duration = Duration::from_millis(100);
/// The maximum number of messages processed together.
const BATCH: usize = 2000;
/// The maximum size of the messages processed together, in bytes, apart from one more message of the broker's maximum
/// size.
const BATCH_BYTES: usize = 1 << 24;
/// The time after which a broker that does not answer is asked again.
const SILENCE: Duration = Duration::from_secs(2);
const PAUSE: Duration = Duration::from_millis(200);
/// How long after a message the end of a request is awaited: a busy broker of version 2.9 may not send it.
const LATE: Duration = Duration::from_millis(500);
/// How long the broker remembers the ids of estimates: no restart may take longer.
const KNOWN: Duration = Duration::from_secs(600);

/// The names of streams, subjects and the consumer.
#[derive(Debug, Clone)]
pub(super) struct Names {
    /// The stream of frames, which is created if it does not exist, and the subjects of the frames followed here.
    pub(super) stream: String,
    pub(super) subject: String,
    /// The stream of estimates, which is created if it does not exist; a device's subject is this name followed by its
    /// number.
    pub(super) estimates: String,
    /// The name of the consumer, shared by all that read the same subjects.
    pub(super) consumer: String,
}

/// A connection to a broker.
#[derive(Debug)]
pub(super) struct Nats {
    runtime: Runtime,
    context: Context,
    names: Names,
    /// The number of bytes requested at once.
    most_bytes: usize,
    /// The creation time of the stream of frames.
    created: String,
    consumer: Option<PullConsumer>,
    /// The number of messages that this consumer has delivered.
    delivered: u64,
    /// The position of the last message delivered.
    position: u64,
    last: Option<Message>,
    lag: Option<u64>,
    /// Whether the stream was meanwhile deleted and created again.
    is_another: bool,
    silence: Silence,
    /// The signal, and the optional time, at which waiting ends.
    stop: (Arc<AtomicBool>, Option<Instant>),
}

impl Nats {
    /// Connects to the broker and creates the streams that do not exist.
    ///
    /// # Errors
    /// [`Error::Usage`] with the broker's message.
    pub(super) fn connect(
        url: &str,
        names: Names,
        stop: (Arc<AtomicBool>, Option<Instant>),
    ) -> Result<Self, Error> {
        let mut runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = runtime.worker_threads(1).enable_all().build();
        let runtime = runtime.map_err(|error| Error::Usage(format!("no threads: {error}")))?;
        let connected = runtime.block_on(async {
            let options = async_nats::ConnectOptions::new().name("host-sim fleet");
            let client = options.request_timeout(Some(SILENCE)).connect(url).await?;
            let most_bytes = BATCH_BYTES.saturating_add(client.server_info().max_payload);
            let mut context = jetstream::new(client);
            context.set_timeout(SILENCE);
            let (frames, estimates) = (names.stream.clone(), names.estimates.clone());
            let made = |name: String| stream::Config {
                subjects: vec![format!("{name}.>")],
                name,
                duplicate_window: KNOWN,
                ..stream::Config::default()
            };
            let frames = context.get_or_create_stream(made(frames)).await?;
            let created = frames.cached_info().created.to_string();
            let estimates = context.get_or_create_stream(made(estimates)).await?;
            knows_long_enough(&estimates.cached_info().config)?;
            Ok::<_, async_nats::Error>((context, created, most_bytes))
        });
        let failed = |error| Error::Usage(format!("--nats {url}: {error}"));
        let (context, created, most_bytes) = connected.map_err(failed)?;
        let (consumer, last, lag) = (None, None, None);
        let (delivered, position) = (0, 0);
        Ok(Self {
            runtime,
            context,
            names,
            most_bytes,
            created,
            consumer,
            delivered,
            position,
            last,
            lag,
            is_another: false,
            silence: Silence::begin(Instant::now()),
            stop,
        })
    }

    /// Creates a consumer that begins after the last message that was processed.
    async fn begin(&mut self) -> Result<(), async_nats::Error> {
        let Names { stream, subject, consumer: name, .. } = &self.names;
        let stream = self.context.get_stream(stream).await?;
        self.is_another = stream.cached_info().created.to_string() != self.created;
        if self.is_another {
            return Err("another stream".into());
        }
        // The consumer may not exist.
        let _ = stream.delete_consumer(name).await;
        let config = pull::Config {
            durable_name: Some(name.clone()),
            filter_subject: subject.clone(),
            deliver_policy: DeliverPolicy::ByStartSequence { start_sequence: self.position + 1 },
            ack_policy: AckPolicy::All,
            max_ack_pending: -1,
            ..pull::Config::default()
        };
        self.consumer = Some(stream.create_consumer(config).await?);
        self.delivered = 0;
        Ok(())
    }

    /// Fetches the messages that have arrived. After any irregularity the consumer is created anew.
    async fn fetch(&mut self) -> Result<Vec<Delivery>, async_nats::Error> {
        if self.consumer.is_none() {
            self.begin().await?;
        }
        let mut deliveries = Vec::new();
        let Some(consumer) = self.consumer.take() else { return Ok(deliveries) };
        let batch = consumer.batch().max_messages(BATCH).max_bytes(self.most_bytes);
        let mut messages = batch.expires(PATIENCE).messages().await?;
        loop {
            let wait = if deliveries.is_empty() { SILENCE } else { LATE };
            let message = match timeout(wait, messages.next()).await {
                Err(silent) if deliveries.is_empty() => return Err(silent.into()),
                Err(_) | Ok(None) => break,
                // The next message exceeds the number of bytes requested.
                Ok(Some(Err(error))) if error.to_string().contains("MaxBytes") => break,
                Ok(Some(message)) => message?,
            };
            let info = message.info()?;
            self.delivered += 1;
            if info.consumer_sequence != self.delivered {
                // Missing messages were in flight when the connection broke.
                return Ok(deliveries);
            }
            // Messages that were not acknowledged in time are delivered again.
            if info.stream_sequence > self.position {
                self.position = info.stream_sequence;
                self.lag = Some(info.pending);
                let (position, bytes) = (self.position, message.payload.to_vec());
                deliveries.push(Delivery { position, bytes });
                self.last = Some(message);
            }
        }
        self.consumer = Some(consumer);
        Ok(deliveries)
    }

    /// Offers estimates to the broker and returns those that it has not confirmed.
    async fn offer<'a>(
        context: &Context,
        subject: &str,
        all: &[&'a Estimate],
    ) -> Vec<&'a Estimate> {
        let (mut offered, mut left) = (Vec::new(), Vec::new());
        for (place, &estimate) in all.iter().enumerate() {
            let payload = estimate.frame.clone().into();
            let publish = PublishMessage::build().message_id(&estimate.id).payload(payload);
            let subject = format!("{subject}.{}", estimate.device);
            let Ok(confirmed) = context.send_publish(subject, publish).await else {
                // The broker would not accept the next ones either, each only after a timeout.
                left.extend(all.iter().skip(place));
                break;
            };
            offered.push((estimate, confirmed));
        }
        // All confirmations are awaited together, so that a silent broker costs a single timeout.
        let confirmed = offered.into_iter().map(|(estimate, confirmed)| async move {
            confirmed.into_future().await.is_err().then_some(estimate)
        });
        let unconfirmed = join_all(confirmed).await.into_iter().flatten();
        unconfirmed.chain(left).collect()
    }
}

/// Whether a stream that already existed remembers the ids of its messages long enough.
fn knows_long_enough(config: &stream::Config) -> Result<(), String> {
    let (name, found) = (&config.name, config.duplicate_window);
    if found >= KNOWN {
        return Ok(());
    }
    Err(format!(
        "stream {name} knows message ids for {} s (duplicate_window); expected at least {} s",
        found.as_secs_f64(),
        KNOWN.as_secs_f64()
    ))
}

impl Transport for Nats {
    fn log(&self) -> Log {
        let Names { stream, subject, .. } = &self.names;
        let name = format!("NATS, stream {stream}, subject {subject}");
        Log { name, created: Some(self.created.clone()) }
    }

    fn resume(&mut self, position: u64) -> Result<(), Error> {
        (self.position, self.consumer) = (position, None);
        Ok(())
    }

    fn receive(&mut self) -> Result<Vec<Delivery>, Error> {
        let runtime = self.runtime.handle().clone();
        let before = self.position;
        let (deliveries, why) = match runtime.block_on(self.fetch()) {
            Ok(deliveries) => (deliveries, None),
            Err(_) if self.is_another => {
                let stream = &self.names.stream;
                return Err(Error::Usage(format!(
                    "stream {stream} was deleted and made anew; expected to be begun again, then it is followed from its start"
                )));
            }
            Err(error) => {
                // The messages received from it are requested again.
                (self.position, self.consumer) = (before, None);
                sleep(PAUSE);
                (Vec::new(), Some(error.to_string()))
            }
        };
        if !deliveries.is_empty() {
            self.silence = Silence::begin(Instant::now());
        } else if let Some(told) = self.silence.goes_on(Instant::now(), why.as_deref()) {
            output::warn(&format!("warning: {}: {told}", self.log().name));
        }
        Ok(deliveries)
    }

    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error> {
        let mut left: Vec<_> = estimates.iter().collect();
        let (context, subject) = (&self.context, &self.names.estimates);
        loop {
            // An unconfirmed estimate may be stored behind later ones: its sequence number tells the order.
            left = self.runtime.block_on(Self::offer(context, subject, &left));
            if left.is_empty() {
                return Ok(());
            }
            let (stop, until) = &self.stop;
            let is_over = until.is_some_and(|until| Instant::now() >= until);
            if is_over || stop.load(Ordering::Relaxed) {
                return Err(Error::Usage("the broker does not take the estimates".to_owned()));
            }
            sleep(PAUSE);
        }
    }

    fn acknowledge(&mut self, position: u64) -> Result<(), Error> {
        if let Some(message) = self.last.take() {
            let is_it = message.info().is_ok_and(|info| info.stream_sequence == position);
            // A lost acknowledgement is covered by the next one; it only matters to people who look at the broker.
            let _ = is_it.then(|| self.runtime.block_on(message.ack()));
        }
        Ok(())
    }

    fn lag(&self) -> Option<u64> {
        self.lag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_that_forgets_ids_too_early_is_refused() {
        let config = |seconds| stream::Config {
            name: "estimates".to_owned(),
            duplicate_window: Duration::from_secs(seconds),
            ..stream::Config::default()
        };
        assert_eq!(knows_long_enough(&config(600)), Ok(()));
        let refused = knows_long_enough(&config(120)).unwrap_err();
        assert!(refused.contains("for 120 s") && refused.contains("600 s"), "{refused}");
    }
}
