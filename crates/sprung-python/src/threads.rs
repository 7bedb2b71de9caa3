//! Threads for the engine: one pool for each number of them, shared by all simulations of a process.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use sprung::{Code, Error, Result, Workers};

/// The most threads that are started.
const MOST: usize = 1024;

/// The pools of this process.
static POOLS: Mutex<Pools> = Mutex::new(Pools { forks: 0, of: BTreeMap::new() });

struct Pools {
    /// How often this process was forked off another that had pools already. The threads of a pool do not come along.
    forks: u64,
    of: BTreeMap<usize, Arc<dyn Workers>>,
}

fn pools() -> MutexGuard<'static, Pools> {
    POOLS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Threads that a simulation has been lent.
pub struct Lent {
    threads: usize,
    forks: u64,
}

/// So many threads, or one for each processor.
pub fn lend(threads: Option<i64>) -> Result<(Arc<dyn Workers>, Lent)> {
    let threads = threads.map_or_else(|| Ok(sprung_cli::processors()), usize::try_from);
    let Some(threads) = threads.ok().filter(|threads| (1..=MOST).contains(threads)) else {
        let sentence = format!("must be from 1 to {MOST}");
        return Err(Error::new(Code::OutOfRange, sentence).at_field("threads"));
    };
    let mut pools = pools();
    let workers = match pools.of.get(&threads) {
        Some(workers) => workers.clone(),
        None => {
            let workers = sprung_cli::workers(Some(threads))?;
            pools.of.insert(threads, workers.clone());
            workers
        }
    };
    Ok((workers, Lent { threads, forks: pools.forks }))
}

impl Lent {
    /// How many they are.
    pub fn count(&self) -> usize {
        self.threads
    }

    /// Other threads, if this process was forked since: those of its parent are not here.
    pub fn anew(&self) -> Result<Option<(Arc<dyn Workers>, Self)>> {
        if self.forks == pools().forks {
            return Ok(None);
        }
        lend(Some(self.threads as i64)).map(Some)
    }
}

/// Called in a process that was forked off another.
#[pyfunction]
pub fn after_fork() {
    let mut pools = pools();
    pools.forks += 1;
    // Never dropped: a pool that is dropped waits for its threads, and they are not here.
    std::mem::forget(std::mem::take(&mut pools.of));
}
