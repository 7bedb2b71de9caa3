//! Worker threads, handed in: the engine never starts one.

/// Threads that a front end lends to the engine.
///
/// However many there are, a run gives the same bits: work is split by blocks of the model, and the order of every
/// sum is the model's. With the feature `rayon`, a `rayon::ThreadPool` is one.
pub trait Workers: Send + Sync {
    /// How many threads there are; at least one.
    fn count(&self) -> usize;

    /// Calls `job(0)`, …, `job(count − 1)`, each on a thread of its own, and returns when all are done.
    ///
    /// Jobs wait for each other for a moment, never for long: where they cannot run at the same time all goes well, but
    /// slowly.
    fn run(&self, job: &(dyn Fn(usize) + Sync));
}

/// The calling thread alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inline;

impl Workers for Inline {
    fn count(&self) -> usize {
        1
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        job(0);
    }
}

#[cfg(feature = "rayon")]
impl Workers for rayon::ThreadPool {
    fn count(&self) -> usize {
        self.current_num_threads()
    }

    /// From within the pool, so that the caller sleeps before the others are woken: they do not have to look for a processor
    /// that is free while it still holds one.
    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        self.install(|| self.broadcast(|context| job(context.index())));
    }
}
