//! Kernels for old and new processors: each is compiled for several kinds of vectors, and the widest that the
//! processor has are used.

/// A computation over arrays that is worth vector instructions.
///
/// It is compiled for each kind of vectors only if all of it is inlined: mark `run` and the functions that it calls
/// `#[inline(always)]`. Rust neither reorders sums nor fuses multiplications with additions, so all kinds give the
/// same bits.
pub trait Kernel {
    /// Result of the computation.
    type Output;

    /// Runs the computation.
    fn run(self) -> Self::Output;
}

/// A kind of vectors that the processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vectors(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The target that the program is compiled for: SSE2 on an x86-64, NEON on an `AArch64`, no vectors on a
    /// microcontroller.
    Compiled,
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx2,
    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    Avx512,
}

impl Vectors {
    /// The widest vectors: AVX-512 or AVX2 if feature `vectors` is on and the processor has them, otherwise those that
    /// the program is compiled for.
    #[inline]
    pub fn widest() -> Self {
        let [compiled, wider, widest] = Self::present();
        widest.or(wider).or(compiled).unwrap_or(Self(Kind::Compiled))
    }

    /// All kinds that the processor has, the narrowest first, for tests that compare them.
    #[inline]
    pub fn all() -> impl Iterator<Item = Self> {
        Self::present().into_iter().flatten()
    }

    #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
    #[inline]
    fn present() -> [Option<Self>; 3] {
        use std::arch::is_x86_feature_detected as has;
        // With AVX-512 enabled, the compiler also uses AVX2, FMA and F16C.
        let wider = has!("avx2") && has!("fma") && has!("f16c");
        let avx512 = wider && has!("avx512f") && has!("avx512dq") && has!("avx512vl");
        [
            Some(Self(Kind::Compiled)),
            has!("avx2").then_some(Self(Kind::Avx2)),
            avx512.then_some(Self(Kind::Avx512)),
        ]
    }

    #[cfg(not(all(feature = "vectors", target_arch = "x86_64")))]
    #[inline(always)]
    fn present() -> [Option<Self>; 3] {
        [Some(Self(Kind::Compiled)), None, None]
    }

    /// Runs a kernel on this kind of vectors.
    #[inline(always)]
    #[allow(unsafe_code)] // Calls functions whose instructions not every processor has.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Kind::Compiled => kernel.run(),
            // SAFETY: there is such a value only where `present` has found these instructions.
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Kind::Avx2 => unsafe { avx2(kernel) },
            // SAFETY: as above.
            #[cfg(all(feature = "vectors", target_arch = "x86_64"))]
            Kind::Avx512 => unsafe { avx512(kernel) },
        }
    }
}

#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
#[target_feature(enable = "avx2")]
fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
