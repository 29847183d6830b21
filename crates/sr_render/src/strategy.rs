//! Direction strategies as values: `0.5 cosine + 0.5 light`, `mis(bsdf, light)`.
//!
//! In: an expression, or parts composed in code. Out: a [`Strategy`], small plain data that the
//! integrator walks. The same grammar serves the command line and Python.
//!
//! ```text
//! strategy  = density | "mis(" density { "," density } [ "," "heuristic" "=" name ] ")"
//! density   = term { "+" term }
//! term      = [ number [ "*" ] ] ( "uniform" | "cosine" | "bsdf" | "light" )
//! ```

use std::fmt;
use std::str::FromStr;

use sr_sampling::Heuristic;
use sr_sampling::mixture::{MixtureError, check_weights};
use thiserror::Error;

/// A density over directions that needs nothing but the shading point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basic {
    /// Every direction of the hemisphere (of the sphere, if the surface transmits) equally likely.
    Uniform,
    /// Proportional to |cos θ|.
    Cosine,
    /// As the scattering model samples itself.
    Bsdf,
    /// Towards the lights.
    Light,
}

impl Basic {
    /// All of them, in the order of [`Density`]'s weights.
    pub const ALL: [Basic; 4] = [Basic::Uniform, Basic::Cosine, Basic::Bsdf, Basic::Light];

    /// Its name in expressions.
    pub fn name(self) -> &'static str {
        match self {
            Basic::Uniform => "uniform",
            Basic::Cosine => "cosine",
            Basic::Bsdf => "bsdf",
            Basic::Light => "light",
        }
    }
}

/// A mixture of the basic densities.
///
/// Invariant: weights are not negative and sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Density {
    weights: [f32; 4],
}

impl Density {
    /// A mixture from `(weight, density)` terms; terms of the same density add up.
    ///
    /// # Errors
    /// If the weights are not those of a mixture.
    pub fn new(terms: &[(f32, Basic)]) -> Result<Self, MixtureError> {
        check_weights(terms.iter().map(|&(weight, _)| weight))?;
        let mut weights = [0.0; 4];
        for &(weight, basic) in terms {
            weights[basic as usize] += weight;
        }
        let sum: f32 = weights.iter().sum();
        Ok(Self { weights: weights.map(|w| w / sum) })
    }

    /// One density alone.
    pub fn single(basic: Basic) -> Self {
        let mut weights = [0.0; 4];
        weights[basic as usize] = 1.0;
        Self { weights }
    }

    /// The weight of a component.
    #[inline]
    pub fn weight(&self, basic: Basic) -> f32 {
        self.weights[basic as usize]
    }

    /// Itself if it has a part of `bsdf`, otherwise half of it and half `bsdf`.
    pub fn with_bsdf(&self) -> Self {
        if self.weight(Basic::Bsdf) > 0.0 {
            return *self;
        }
        let mut weights = self.weights.map(|w| 0.5 * w);
        weights[Basic::Bsdf as usize] = 0.5;
        Self { weights }
    }

    /// Can it produce every direction that a surface may scatter to? Light sampling alone cannot.
    pub fn covers_surface(&self) -> bool {
        self.weight(Basic::Light) < 1.0
    }
}

/// How directions are chosen at each vertex of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Strategy {
    techniques: Vec<Density>,
    heuristic: Heuristic,
}

/// The most techniques that one `mis(…)` may combine.
pub const MAX_TECHNIQUES: usize = 4;

impl Strategy {
    /// One density, or several weighted by `heuristic`, one sample of each.
    ///
    /// # Errors
    /// If there is no technique or more than [`MAX_TECHNIQUES`].
    pub fn new(techniques: Vec<Density>, heuristic: Heuristic) -> Result<Self, StrategyError> {
        match techniques.len() {
            0 => Err(StrategyError::Empty),
            1..=MAX_TECHNIQUES => Ok(Self { techniques, heuristic }),
            count => Err(StrategyError::TooMany { count }),
        }
    }

    /// The techniques, one sample each.
    pub fn techniques(&self) -> &[Density] {
        &self.techniques
    }

    /// How their samples are weighted.
    pub fn heuristic(&self) -> Heuristic {
        self.heuristic
    }
}

impl Default for Strategy {
    /// `mis(bsdf, light)`.
    fn default() -> Self {
        Self {
            techniques: vec![Density::single(Basic::Bsdf), Density::single(Basic::Light)],
            heuristic: Heuristic::Power,
        }
    }
}

/// Why an expression is not a strategy.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StrategyError {
    /// Nothing there.
    #[error("a strategy needs at least one density: uniform, cosine, bsdf, light")]
    Empty,
    /// `mis` of too many.
    #[error("mis(…) combines at most {MAX_TECHNIQUES} densities, not {count}")]
    TooMany {
        /// How many were given.
        count: usize,
    },
    /// A word that is not in the grammar.
    #[error("unknown {what} `{found}` at column {column}; expected {expected}")]
    Unexpected {
        /// What was being read.
        what: &'static str,
        /// The text found.
        found: String,
        /// One-based column.
        column: usize,
        /// What would have been right.
        expected: &'static str,
    },
    /// Weights that do not form a mixture.
    #[error("{source}{}", normalised_hint(.terms))]
    Weights {
        /// The terms as written.
        terms: Vec<(f32, Basic)>,
        /// What is wrong with them.
        source: MixtureError,
    },
}

fn normalised_hint(terms: &[(f32, Basic)]) -> String {
    let sum: f32 = terms.iter().map(|t| t.0).sum();
    if !(sum > 0.0 && sum.is_finite() && terms.iter().all(|t| t.0 >= 0.0)) {
        return String::new();
    }
    let parts: Vec<String> = terms.iter().map(|(w, b)| format!("{} {}", w / sum, b.name())).collect();
    format!("; did you mean \"{}\"?", parts.join(" + "))
}

impl fmt::Display for Density {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let terms: Vec<String> = Basic::ALL
            .into_iter()
            .filter(|&b| self.weight(b) > 0.0)
            .map(|b| {
                if self.weight(b) == 1.0 {
                    b.name().into()
                } else {
                    format!("{} {}", self.weight(b), b.name())
                }
            })
            .collect();
        f.write_str(&terms.join(" + "))
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [only] = self.techniques.as_slice() {
            return only.fmt(f);
        }
        let parts: Vec<String> = self.techniques.iter().map(ToString::to_string).collect();
        write!(f, "mis({}", parts.join(", "))?;
        if self.heuristic != Heuristic::Power {
            write!(f, ", heuristic={}", self.heuristic)?;
        }
        f.write_str(")")
    }
}

impl FromStr for Strategy {
    type Err = StrategyError;
    fn from_str(text: &str) -> Result<Self, StrategyError> {
        let mut parser = Parser { tokens: tokenize(text), next: 0, end: text.chars().count() + 1 };
        let strategy = parser.strategy()?;
        match parser.peek() {
            None => Ok(strategy),
            Some(_) => Err(parser.unexpected("text after the strategy", "the end")),
        }
    }
}

/// A word, a number or a sign, with its one-based column.
type Token = (String, usize);

fn tokenize(text: &str) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut joins = false;
    for (i, c) in text.chars().enumerate() {
        let is_sign = "+*(),=".contains(c);
        if c.is_whitespace() || is_sign {
            joins = false;
            if is_sign {
                tokens.push((c.to_string(), i + 1));
            }
            continue;
        }
        match tokens.last_mut() {
            Some((word, _)) if joins => word.push(c),
            _ => tokens.push((c.to_string(), i + 1)),
        }
        joins = true;
    }
    tokens
}

struct Parser {
    tokens: Vec<Token>,
    next: usize,
    end: usize,
}

impl Parser {
    fn peek(&self) -> Option<&str> {
        self.tokens.get(self.next).map(|t| t.0.as_str())
    }

    fn take(&mut self, sign: &str) -> bool {
        let found = self.peek() == Some(sign);
        self.next += usize::from(found);
        found
    }

    fn unexpected(&self, what: &'static str, expected: &'static str) -> StrategyError {
        let (found, column) = self.tokens.get(self.next).cloned().unwrap_or_else(|| ("end".into(), self.end));
        StrategyError::Unexpected { what, found, column, expected }
    }

    fn strategy(&mut self) -> Result<Strategy, StrategyError> {
        if self.tokens.is_empty() {
            return Err(StrategyError::Empty);
        }
        if !self.take("mis") {
            return Strategy::new(vec![self.density()?], Heuristic::Power);
        }
        if !self.take("(") {
            return Err(self.unexpected("sign", "`(` after mis"));
        }
        let (mut techniques, mut heuristic) = (Vec::new(), Heuristic::Power);
        loop {
            if self.take("heuristic") {
                heuristic = self.heuristic()?;
            } else {
                techniques.push(self.density()?);
            }
            if self.take(")") {
                return Strategy::new(techniques, heuristic);
            }
            if !self.take(",") {
                return Err(self.unexpected("sign", "`,` or `)`"));
            }
        }
    }

    fn heuristic(&mut self) -> Result<Heuristic, StrategyError> {
        const NAMES: &str = "balance, power, cutoff or maximum";
        if !self.take("=") {
            return Err(self.unexpected("sign", "`=` after heuristic"));
        }
        let parsed = self.peek().and_then(|name| name.parse().ok());
        let heuristic = parsed.ok_or_else(|| self.unexpected("heuristic", NAMES))?;
        self.next += 1;
        Ok(heuristic)
    }

    fn density(&mut self) -> Result<Density, StrategyError> {
        let mut terms = vec![self.term()?];
        while self.take("+") {
            terms.push(self.term()?);
        }
        Density::new(&terms).map_err(|source| StrategyError::Weights { terms, source })
    }

    fn term(&mut self) -> Result<(f32, Basic), StrategyError> {
        let weight = self.peek().and_then(|word| word.parse::<f32>().ok());
        if weight.is_some() {
            self.next += 1;
            self.take("*");
        }
        let basic = Basic::ALL.into_iter().find(|b| Some(b.name()) == self.peek());
        let basic = basic.ok_or_else(|| self.unexpected("density", "uniform, cosine, bsdf or light"))?;
        self.next += 1;
        Ok((weight.unwrap_or(1.0), basic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_survive_a_round_trip() {
        for text in [
            "uniform",
            "light",
            "0.5 cosine + 0.5 light",
            "mis(bsdf, light)",
            "mis(0.25 uniform + 0.75 bsdf, light, heuristic=balance)",
        ] {
            assert_eq!(text.parse::<Strategy>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn stars_and_spaces_are_optional() {
        let plain: Strategy = "0.5 cosine + 0.5 light".parse().unwrap();
        assert_eq!("0.5*cosine+0.5*light".parse::<Strategy>().unwrap(), plain);
        assert_eq!("0.25 light + 0.5 cosine + 0.25 light".parse::<Strategy>().unwrap(), plain);
    }

    #[test]
    fn errors_name_the_place_and_the_remedy() {
        let message = |text: &str| text.parse::<Strategy>().unwrap_err().to_string();
        assert_eq!(
            message("0.5 cosine + 0.7 ligth"),
            "unknown density `ligth` at column 18; expected uniform, cosine, bsdf or light"
        );
        assert_eq!(
            message("1 cosine + 1 light"),
            "mixture weights sum to 2, not to 1; did you mean \"0.5 cosine + 0.5 light\"?"
        );
        assert!(message("mis(bsdf light)").contains("expected `,` or `)`"));
        assert!(message("mis(bsdf, light) + cosine").contains("expected the end"));
        assert!(message("mis(bsdf, light").contains("column 16"));
        assert!(message("-1 cosine + 2 light").contains("not negative"));
        assert!(message("nan cosine").contains("NaN"));
        assert!(message("").contains("at least one"));
    }
}
