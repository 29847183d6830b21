//! Hot code, compiled for the instruction sets that processors may have, and run with the best that this one has.

/// Proof that this processor has what a variant of [`Isa`] names: only [`Isa::available`] makes one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detected(());

/// An instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isa {
    /// AVX-512 with the parts F, VL, DQ and BW, and all of [`Isa::Avx2`].
    #[cfg(target_arch = "x86_64")]
    Avx512(Detected),
    /// AVX2, FMA, BMI1, BMI2 and LZCNT.
    #[cfg(target_arch = "x86_64")]
    Avx2(Detected),
    /// What every processor of the architecture has.
    Baseline,
}

/// What can be run with any instruction set. Nothing is fused or reassociated by compilers, so that results are the
/// same bits.
pub trait Work {
    /// What comes out.
    type Out;
    /// Must be `#[inline(always)]`, and all that it spends its time in must be inlined into it: only then is it
    /// compiled for the instruction set.
    fn run(self) -> Self::Out;
}

impl Isa {
    /// The best that this processor has.
    pub fn detect() -> Self {
        Self::available().next().unwrap_or(Self::Baseline)
    }

    /// Those that this processor has, best first.
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt");
        #[cfg(target_arch = "x86_64")]
        let avx512 = avx2
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw");
        let all = [
            #[cfg(target_arch = "x86_64")]
            avx512.then_some(Self::Avx512(Detected(()))),
            #[cfg(target_arch = "x86_64")]
            avx2.then_some(Self::Avx2(Detected(()))),
            Some(Self::Baseline),
        ];
        all.into_iter().flatten()
    }

    /// Runs `work`.
    pub fn run<W: Work>(self, work: W) -> W::Out {
        match self {
            // SAFETY: a `Detected` in this variant is the proof that the features are there.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(Detected(())) => unsafe { run_avx512(work) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(Detected(())) => unsafe { run_avx2(work) },
            Self::Baseline => work.run(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt")]
fn run_avx512<W: Work>(work: W) -> W::Out {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt")]
fn run_avx2<W: Work>(work: W) -> W::Out {
    work.run()
}
