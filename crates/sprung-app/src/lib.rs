//! The sprung window.
