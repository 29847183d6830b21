//! The names of the sequences.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// Which sequence to use. Matched once per render, outside every loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SequenceKind {
    /// [`Independent`](super::Independent).
    Independent,
    /// [`OwenSobol`](super::OwenSobol).
    #[default]
    Sobol,
}

impl SequenceKind {
    /// Every kind.
    pub const ALL: [Self; 2] = [Self::Independent, Self::Sobol];

    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "sobol",
        }
    }
}

impl fmt::Display for SequenceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// There is no sequence of that name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no sampler {name:?}; there are independent and sobol")]
pub struct UnknownSequence {
    /// The name given.
    pub name: String,
}

impl FromStr for SequenceKind {
    type Err = UnknownSequence;

    fn from_str(name: &str) -> Result<Self, UnknownSequence> {
        Self::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| UnknownSequence { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for kind in SequenceKind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        let error = "sobel".parse::<SequenceKind>().unwrap_err();
        for kind in SequenceKind::ALL {
            assert!(error.to_string().contains(kind.name()), "{error} does not offer {kind}");
        }
    }
}
