//! Datagrams: no log, so what comes while nobody listens is lost, and what is killed is not made again.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use super::transport::{Delivery, Estimate, Log, Transport};
use crate::Error;

/// So long messages are waited for.
const PATIENCE: Duration = Duration::from_millis(100);
/// Messages that are followed together.
const BATCH: usize = 2000;
/// No datagram is longer.
const LONGEST: usize = 1 << 16;

/// A port to which all devices send.
#[derive(Debug)]
pub(super) struct Udp {
    socket: UdpSocket,
    /// Who is sent the estimates.
    to: Option<SocketAddr>,
    position: u64,
    buffer: Vec<u8>,
}

impl Udp {
    /// Listens to datagrams for this address.
    ///
    /// # Errors
    /// [`Error::Usage`] if it cannot be had.
    pub(super) fn bind(address: &str, to: Option<SocketAddr>) -> Result<Self, Error> {
        let socket = UdpSocket::bind(address).and_then(|socket| {
            socket.set_read_timeout(Some(PATIENCE))?;
            Ok(socket)
        });
        let socket = socket.map_err(|error| Error::Usage(format!("--udp {address}: {error}")))?;
        Ok(Self { socket, to, position: 0, buffer: vec![0; LONGEST] })
    }

    /// Where datagrams are to be sent.
    pub(super) fn address(&self) -> Option<SocketAddr> {
        self.socket.local_addr().ok()
    }
}

impl Transport for Udp {
    fn log(&self) -> Log {
        Log { name: "UDP".to_owned(), created: None }
    }

    fn resume(&mut self, position: u64) -> Result<(), Error> {
        self.position = position;
        Ok(())
    }

    fn receive(&mut self) -> Result<Vec<Delivery>, Error> {
        let (mut deliveries, begun) = (Vec::new(), Instant::now());
        while deliveries.len() < BATCH && begun.elapsed() < PATIENCE {
            match self.socket.recv(&mut self.buffer) {
                Ok(count) => {
                    self.position += 1;
                    let bytes = self.buffer.get(..count).unwrap_or_default().to_vec();
                    deliveries.push(Delivery { position: self.position, bytes });
                }
                Err(error)
                    if matches!(
                        error.kind(),
                        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                    ) => {}
                Err(source) => return Err(Error::Read { path: "UDP".into(), source }),
            }
        }
        Ok(deliveries)
    }

    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error> {
        if let Some(to) = self.to {
            for estimate in estimates {
                // Whoever is not there now gets none.
                let _ = self.socket.send_to(&estimate.frame, to);
            }
        }
        Ok(())
    }

    fn acknowledge(&mut self, _: u64) -> Result<(), Error> {
        Ok(())
    }

    fn lag(&self) -> Option<u64> {
        None
    }
}
