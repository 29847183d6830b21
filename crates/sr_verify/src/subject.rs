//! What is checked, and what a check says.

use std::fmt;

use sr_stats::TestReport;

use crate::picture::Picture;

/// What kind of block it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// How surfaces scatter light.
    Bsdf,
    /// Lights, seen from points.
    Light,
    /// Maps of uniforms that the renderer samples with, in single precision.
    Warp,
    /// Distributions of `sr.integrate`, in double precision.
    Distribution,
    /// Pixel filters.
    Filter,
    /// Weights of multiple importance sampling.
    Weights,
    /// Whole renders whose answer is known in closed form.
    Scene,
}

impl Group {
    const ALL: [Self; 7] =
        [Self::Bsdf, Self::Light, Self::Warp, Self::Distribution, Self::Filter, Self::Weights, Self::Scene];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bsdf => "bsdf",
            Self::Light => "light",
            Self::Warp => "warp",
            Self::Distribution => "distribution",
            Self::Filter => "filter",
            Self::Weights => "weights",
            Self::Scene => "scene",
        }
    }
}

/// What a check found.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// All is well.
    Holds,
    /// Something is wrong, whatever chance says.
    Fails(String),
    /// Chance decides: wrong if that is too unlikely.
    Chance(TestReport),
}

impl Verdict {
    /// Holds if there is nothing to complain about.
    pub(crate) fn of(complaint: Option<String>) -> Self {
        complaint.map_or(Self::Holds, Self::Fails)
    }
}

/// One thing that must hold.
pub struct Check {
    /// What: the head of a column.
    pub name: &'static str,
    /// Finds out, with numbers from a seed.
    pub run: Box<dyn Fn(u64) -> Verdict + Send + Sync>,
}

/// A block with certain parameters.
pub struct Subject {
    /// What kind of block it is.
    pub group: Group,
    /// The block.
    pub block: String,
    /// The block, its parameters, and from where it is seen.
    pub case: String,
    /// What must hold.
    pub checks: Vec<Check>,
    /// Where its samples go, and where its density says that they go; for directions only.
    pub picture: Option<Box<dyn Fn(u64) -> Picture + Send + Sync>>,
}

impl Subject {
    /// Without checks yet. The block's name is what the case's name begins with: the words before one with a digit or a
    /// capital, before a comma or a colon, or before "of", "on", "from", ….
    pub(crate) fn new(group: Group, case: impl Into<String>) -> Self {
        let case = case.into();
        Self { group, block: block_of(&case), case, checks: Vec::new(), picture: None }
    }

    /// Is it meant by a name: of its group, or else part of its case, in small or capital letters?
    pub fn is_named(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        if Group::ALL.iter().any(|group| group.name() == name) {
            return self.group.name() == name;
        }
        format!("{}/{}", self.group.name(), self.case).to_lowercase().contains(&name)
    }

    /// With another check.
    pub(crate) fn check(
        mut self,
        name: &'static str,
        run: impl Fn(u64) -> Verdict + Send + Sync + 'static,
    ) -> Self {
        self.checks.push(Check { name, run: Box::new(run) });
        self
    }

    /// With a picture.
    pub(crate) fn picture(mut self, draw: impl Fn(u64) -> Picture + Send + Sync + 'static) -> Self {
        self.picture = Some(Box::new(draw));
        self
    }
}

impl fmt::Debug for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let checks: Vec<&str> = self.checks.iter().map(|check| check.name).collect();
        write!(f, "{}/{} {checks:?}", self.group.name(), self.case)
    }
}

/// Words that end a block's name.
const ENDS: [&str; 11] = ["of", "on", "from", "about", "far", "with", "over", "in", "and", "at", "to"];

fn block_of(case: &str) -> String {
    let head = case.split([',', ':', '(']).next().unwrap_or(case);
    let starts_detail = |word: &str| {
        ENDS.contains(&word)
            || word.contains(|c: char| c.is_ascii_digit())
            || word.starts_with(char::is_uppercase)
    };
    let mut words = head.split_whitespace();
    let first = words.next().unwrap_or(head);
    let rest = words.take_while(|word| !starts_detail(word));
    std::iter::once(first).chain(rest).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_named_by_their_cases() {
        for (case, block) in [
            ("rough conductor Beckmann 0.1 0.1, wo.z = 0.5", "rough conductor"),
            ("diffuse", "diffuse"),
            ("cone of 0.1 about [0, 0, 1]", "cone"),
            ("piecewise constant 1D, few", "piecewise constant"),
            ("mixture on the line", "mixture"),
        ] {
            assert_eq!(block_of(case), block);
        }
    }
}
