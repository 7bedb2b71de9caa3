//! Which vector instructions the step is compiled for, and which of them this processor has.
//!
//! The step is one piece of plain code, compiled once for each level; the compiler makes vectors of it, as wide as the
//! level allows. None of its operations is contracted or estimated, so all levels give the same bits, and the level that
//! needs nothing of the processor is the safe twin of the others.

/// A set of vector instructions. Whichever is used, the bits are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// What every processor of the target has: SSE2 on x86-64, NEON on 64-bit ARM, simd128 on wasm if compiled for it.
    Baseline,
    /// AVX2, on x86-64.
    Avx2,
    /// AVX-512 (F, BW, DQ, VL), on x86-64.
    Avx512,
}

impl Level {
    /// The levels that this processor has, the narrowest first.
    pub fn available() -> Vec<Self> {
        [Self::Baseline, Self::Avx2, Self::Avx512].into_iter().filter(|level| level.is_available()).collect()
    }

    fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => std::arch::is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                    && std::arch::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// The widest level of this processor.
    pub fn best() -> Self {
        Self::available().pop().unwrap_or(Self::Baseline)
    }

    /// Its name, as messages have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline if cfg!(target_arch = "x86_64") => "SSE2",
            Self::Baseline if cfg!(target_arch = "aarch64") => "NEON",
            Self::Baseline if cfg!(target_feature = "simd128") => "simd128",
            Self::Baseline => "baseline",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        }
    }
}

/// What is compiled once for each level: all of it has to be inlined.
pub(super) trait Work {
    type Output;

    fn run(self) -> Self::Output;
}

/// A level that this processor is known to have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Checked(Level);

impl Checked {
    /// The level, or the widest below it that this processor has.
    pub fn new(level: Level) -> Self {
        let available = Level::available();
        Self(if available.contains(&level) { level } else { Level::best() })
    }

    /// Does some work in this level's instructions.
    #[allow(unsafe_code)]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self.0 {
            // SAFETY: a `Checked` holds only levels that this processor was found to have.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { avx512(work) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { avx2(work) },
            _ => work.run(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2<W: Work>(work: W) -> W::Output {
    align_stack();
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn avx512<W: Work>(work: W) -> W::Output {
    align_stack();
    work.run()
}

/// Has the calling function's part of the stack begin at a cache line.
///
/// The compiler keeps vectors there for which it has no register, and by itself aligns them to 16 bytes: most then lie across two
/// cache lines. Some lay across two pages, in threads whose stack happened to begin so, and made the step a fifth slower there.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn align_stack() {
    #[repr(align(64))]
    struct Line(#[expect(dead_code, reason = "only where it lies matters")] u8);
    // Of a constant the compiler would make a static.
    let mut line = Line(0);
    std::hint::black_box(&mut line);
}
