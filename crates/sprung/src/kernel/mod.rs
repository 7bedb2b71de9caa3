//! The explicit step's inner loops.
