//! A port for datagrams.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Duration;

use socket2::{Domain, Protocol, Socket, Type};

use crate::Error;
use crate::text::printable;

/// Whoever waits for bytes looks up this often, to see whether it is to stop.
pub(super) const PATIENCE: Duration = Duration::from_millis(100);
/// What the kernel is asked to keep while this program is busy elsewhere; it gives what it is allowed to.
const KERNEL_BYTES: usize = 4 << 20;
/// No datagram is longer.
pub(super) const LONGEST: usize = 1 << 16;

/// Listens to datagrams for this address, of the option `--udp`.
///
/// # Errors
/// [`Error::Usage`] if it cannot be had.
pub(super) fn listen(address: &str) -> Result<UdpSocket, Error> {
    let failed = |error: &io::Error| Error::Usage(format!("--udp {}: {error}", printable(address)));
    let mut addresses = address.to_socket_addrs().map_err(|error| failed(&error))?;
    let nobody = || io::Error::new(ErrorKind::NotFound, "nobody has this address");
    let resolved = addresses.next().ok_or_else(nobody).map_err(|error| failed(&error))?;
    bound(resolved).map_err(|error| failed(&error))
}

fn bound(address: SocketAddr) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
    // Less than asked for is less room, and no reason not to listen.
    let _ = socket.set_recv_buffer_size(KERNEL_BYTES);
    socket.set_read_timeout(Some(PATIENCE))?;
    socket.bind(&address.into())?;
    Ok(socket.into())
}

/// Whether waiting ended without bytes: none for now.
pub(super) fn is_silence(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
