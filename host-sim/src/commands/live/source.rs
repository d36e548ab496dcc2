//! Where bytes come from.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use kestirim_telemetry::VERSION_OF_FLEETS;
use serial2::SerialPort;
use socket2::{Domain, Protocol, Socket, Type};

use super::senders::Senders;
use crate::Error;
use crate::text::printable;

/// Whoever waits for bytes looks up this often, to see whether it is to stop.
const PATIENCE: Duration = Duration::from_millis(100);
/// What the kernel is asked to keep while this program is busy elsewhere; it gives what it is allowed to.
const KERNEL_BYTES: usize = 4 << 20;
/// No datagram is longer.
pub(super) const LONGEST: usize = 1 << 16;

/// A line that is listened to.
#[derive(Debug)]
pub(super) enum Source {
    /// Datagrams, in each of which there are frames or pieces of some; and how many of other senders were ignored.
    Udp(UdpSocket, Senders, Arc<AtomicU64>),
    /// A serial port.
    Serial(SerialPort, PathBuf),
}

impl Source {
    /// Listens to datagrams for this address; those of a second sender are counted in `ignored`.
    pub(super) fn udp(address: &str, ignored: Arc<AtomicU64>) -> Result<Self, Error> {
        let failed =
            |error: &io::Error| Error::Usage(format!("--udp {}: {error}", printable(address)));
        let mut addresses = address.to_socket_addrs().map_err(|error| failed(&error))?;
        let nobody = || io::Error::new(ErrorKind::NotFound, "nobody has this address");
        let resolved = addresses.next().ok_or_else(nobody).map_err(|error| failed(&error))?;
        let socket = bound(resolved).map_err(|error| failed(&error))?;
        Ok(Self::Udp(socket, Senders::default(), ignored))
    }

    /// Listens to a serial port.
    pub(super) fn serial(device: &Path, baud: u32) -> Result<Self, Error> {
        let opened = SerialPort::open(device, baud).and_then(|mut port| {
            port.set_read_timeout(PATIENCE)?;
            Ok(port)
        });
        opened
            .map(|port| Self::Serial(port, device.to_path_buf()))
            .map_err(|source| Error::Read { path: device.to_path_buf(), source })
    }

    /// At which address it can be sent to, if it is one of a network.
    pub(super) fn address(&self) -> Option<SocketAddr> {
        match self {
            Self::Udp(socket, ..) => socket.local_addr().ok(),
            Self::Serial(..) => None,
        }
    }

    /// Waits a little for bytes. None is the end of the line; no bytes are none for now.
    pub(super) fn read<'a>(&mut self, buffer: &'a mut [u8]) -> Result<Option<&'a [u8]>, Error> {
        let read = match self {
            // An empty datagram is no end.
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
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                ) =>
            {
                Ok(Some(&[]))
            }
            Err(source) => Err(Error::Read { path: self.name().into(), source }),
        }
    }

    /// What a person calls it.
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

/// Whether a datagram begins with a frame that says who sends it: many such senders share a port.
fn says_who_sends(datagram: &[u8]) -> bool {
    // A delimiter, the place of the first zero, which is behind the version, and the version.
    matches!(datagram, [0, zero, VERSION_OF_FLEETS, ..] if *zero >= 2)
}

fn bound(address: SocketAddr) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
    // Less than asked for is less room, and no reason not to listen.
    let _ = socket.set_recv_buffer_size(KERNEL_BYTES);
    socket.set_read_timeout(Some(PATIENCE))?;
    socket.bind(&address.into())?;
    Ok(socket.into())
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
