//! The sources of live bytes.

use std::net::{SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use kestirim_telemetry::VERSION_OF_FLEETS;
use serial2::SerialPort;

use super::senders::Senders;
use crate::Error;
use crate::commands::datagrams::{self, PATIENCE, is_silence};

/// A line that is listened to.
#[derive(Debug)]
pub(super) enum Source {
    /// Datagrams that hold frames or fragments of frames, and the number of ignored datagrams from other senders.
    Udp(UdpSocket, Senders, Arc<AtomicU64>),
    /// A serial port.
    Serial(SerialPort, PathBuf),
}

impl Source {
    /// Receives datagrams at this address; those of a second sender are counted in `ignored`.
    pub(super) fn udp(address: &str, ignored: Arc<AtomicU64>) -> Result<Self, Error> {
        Ok(Self::Udp(datagrams::listen(address)?, Senders::default(), ignored))
    }

    /// Receives from a serial port.
    pub(super) fn serial(device: &Path, baud: u32) -> Result<Self, Error> {
        let opened = SerialPort::open(device, baud).and_then(|mut port| {
            port.set_read_timeout(PATIENCE)?;
            Ok(port)
        });
        opened
            .map(|port| Self::Serial(port, device.to_path_buf()))
            .map_err(|source| Error::Read { path: device.to_path_buf(), source })
    }

    /// The network address of the source, if it has one.
    pub(super) fn address(&self) -> Option<SocketAddr> {
        match self {
            Self::Udp(socket, ..) => socket.local_addr().ok(),
            Self::Serial(..) => None,
        }
    }

    /// Waits briefly for bytes. `None` is the end of the line; an empty slice means that none have arrived yet.
    pub(super) fn read<'a>(&mut self, buffer: &'a mut [u8]) -> Result<Option<&'a [u8]>, Error> {
        let read = match self {
            // An empty datagram does not end the stream.
            Self::Udp(socket, senders, ignored) => socket.recv_from(buffer).map(|(count, from)| {
                let datagram = buffer.get(..count).unwrap_or_default();
                let taken = says_who_sends(datagram) || senders.takes(from, Instant::now());
                ignored.fetch_add(u64::from(!taken), Ordering::Relaxed);
                Some(if taken { count } else { 0 })
            }),
            Self::Serial(port, _) => port.read(buffer).map(|count| (count > 0).then_some(count)),
        };
        match read {
            Ok(count) => Ok(count.map(|count| &buffer[..count])),
            Err(error) if is_silence(&error) => Ok(Some(&[])),
            Err(source) => Err(Error::Read { path: self.name().into(), source }),
        }
    }

    /// The name of the source for people.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Udp(..) => match self.address() {
                Some(address) => format!("UDP {address}"),
                None => "UDP".to_owned(),
            },
            Self::Serial(_, device) => device.display().to_string(),
        }
    }
}

/// Whether a datagram begins with a frame that identifies its sender: many such senders may share a port.
fn says_who_sends(datagram: &[u8]) -> bool {
    // A delimiter, the offset of the first zero, which lies after the version, and the version.
    matches!(datagram, [0, zero, VERSION_OF_FLEETS, ..] if *zero >= 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn datagrams_arrive_and_silence_is_no_end() -> Result<(), Error> {
        let mut source = Source::udp("localhost:0", Arc::default())?;
        let address = source.address().unwrap();
        assert!(address.ip().is_loopback());
        let mut buffer = [0; 100];
        assert_eq!(source.read(&mut buffer)?, Some(&b""[..]));
        let sender = UdpSocket::bind((address.ip(), 0)).unwrap();
        sender.send_to(b"abc", address).unwrap();
        assert_eq!(source.read(&mut buffer)?, Some(&b"abc"[..]));
        Ok(())
    }

    #[test]
    fn what_cannot_be_listened_to_is_a_sentence() {
        for address in ["", "127.0.0.1", "127.0.0.1:99999", "192.0.2.1:5775", "\n:1"] {
            let refusal = Source::udp(address, Arc::default()).unwrap_err().to_string();
            assert!(refusal.starts_with("--udp ") && !refusal.contains('\n'), "{refusal}");
        }
        let refusal = Source::serial(Path::new("/no/such/device"), 115_200).unwrap_err();
        assert!(refusal.to_string().starts_with("/no/such/device: cannot be read"), "{refusal}");
    }
}
