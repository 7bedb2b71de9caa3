//! How much memory there is, asked before it is taken, and how much was taken at most.

use sprung::{Code, Error, Result};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use crate::console::bytes;

/// Refuses work that needs more memory than the machine has to give.
///
/// # Errors
/// [`Code::TooLarge`].
pub fn check(needed: u64, what: &str) -> Result<()> {
    // Where the system does not tell, nothing is refused.
    let Some(available) = available().filter(|available| needed > *available) else { return Ok(()) };
    let sentence =
        format!("{what} needs about {} of memory, and {} are available", bytes(needed), bytes(available));
    Err(Error::new(Code::TooLarge, sentence))
}

/// Memory that the machine has to give to this process now, bytes, where the system tells.
pub fn available() -> Option<u64> {
    let refresh = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let available = System::new_with_specifics(refresh).map_or(0, |system| system.available_memory());
    (available > 0).then(|| limit().map_or(available, |limit| limit.min(available)))
}

/// What this process may still take of its address space, bytes, where there is such a limit and the system tells
/// (`ulimit -v`, Linux).
fn limit() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(status("VmSize:")?))
}

/// The most memory this process has held so far, bytes, where the system tells (Linux).
pub fn peak() -> Option<u64> {
    status("VmHWM:")
}

/// A figure of `/proc/self/status`, bytes.
fn status(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
