//! Transport over datagrams without a log: messages sent while nothing listens are lost, and after a kill nothing is
//! computed again.

use std::net::{SocketAddr, UdpSocket};
use std::time::Instant;

use super::transport::{Delivery, Estimate, Log, Transport};
use crate::Error;
use crate::commands::datagrams::{self, LONGEST, PATIENCE, is_silence};

/// The maximum number of messages processed together.
const BATCH: usize = 2000;

/// A port to which all devices send.
#[derive(Debug)]
pub(super) struct Udp {
    socket: UdpSocket,
    /// The address to which the estimates are sent.
    to: Option<SocketAddr>,
    position: u64,
    buffer: Vec<u8>,
}

impl Udp {
    /// Binds the port to this address.
    ///
    /// # Errors
    /// [`Error::Usage`] if the address is not available.
    pub(super) fn bind(address: &str, to: Option<SocketAddr>) -> Result<Self, Error> {
        let socket = datagrams::listen(address)?;
        Ok(Self { socket, to, position: 0, buffer: vec![0; LONGEST] })
    }

    /// The address to which datagrams are to be sent.
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
                Err(error) if is_silence(&error) => {}
                Err(source) => return Err(Error::Read { path: "UDP".into(), source }),
            }
        }
        Ok(deliveries)
    }

    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error> {
        if let Some(to) = self.to {
            for estimate in estimates {
                // A receiver that is not present at the moment misses the estimate.
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
