//! Exports read back, and what is left behind when they end early.

mod caches;
mod carried;
mod common;
#[cfg(target_os = "linux")]
mod full_disk;
mod geometry;
mod glb;
mod npz;
#[cfg(unix)]
mod places;
mod polygons;
mod sequences;
mod tables;
mod usd;
