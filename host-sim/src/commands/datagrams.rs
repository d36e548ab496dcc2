//! A UDP port.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Duration;

use socket2::{Domain, Protocol, Socket, Type};

use crate::Error;
use crate::text::printable;

/// The interval at which a thread that waits for bytes checks whether it is to stop.
pub(super) const PATIENCE: Duration = Duration::from_millis(100);
/// The requested size of the kernel's receive buffer in bytes, for times when this program is busy; the kernel may
/// grant less.
const KERNEL_BYTES: usize = 4 << 20;
/// The size of the receive buffer in bytes: no datagram is longer.
pub(super) const LONGEST: usize = 1 << 16;

/// Binds a UDP socket to this address, which the option `--udp` gives.
///
/// # Errors
/// [`Error::Usage`] if the address is not available.
pub(super) fn listen(address: &str) -> Result<UdpSocket, Error> {
    let failed = |error: &io::Error| Error::Usage(format!("--udp {}: {error}", printable(address)));
    let mut addresses = address.to_socket_addrs().map_err(|error| failed(&error))?;
    let nobody = || io::Error::new(ErrorKind::NotFound, "nobody has this address");
    let resolved = addresses.next().ok_or_else(nobody).map_err(|error| failed(&error))?;
    bound(resolved).map_err(|error| failed(&error))
}

fn bound(address: SocketAddr) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
    // A smaller buffer than requested is no reason not to listen.
    let _ = socket.set_recv_buffer_size(KERNEL_BYTES);
    socket.set_read_timeout(Some(PATIENCE))?;
    socket.bind(&address.into())?;
    Ok(socket.into())
}

/// Whether a read ended because no bytes have arrived yet.
pub(super) fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
