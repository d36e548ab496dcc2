/// Why the application cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The receiver's port failed.
    Receiver,
    /// The modem's port failed.
    Modem,
    /// The telemetry's port failed.
    Telemetry,
}
